// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pages as a browser shows them: their scripts leave their observations in the page's document.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "command.h"

namespace tetskin::test {

/// What a page has left in its element `report`. It is drawn without a graphics card, and stopped if it does not end.
/// waits  for what the page does after it was loaded
inline nlohmann::json reportOf(const CommandFolder& folder, const std::string& page, const std::string& windowSize,
                               bool waits = false) {
  std::vector<std::string> arguments = {"100",
                                        TETSKIN_CHROMIUM,
                                        "--headless",
                                        "--no-sandbox",
                                        "--user-data-dir=" + folder.path("profile"),
                                        "--use-angle=swiftshader",
                                        "--enable-unsafe-swiftshader",
                                        "--window-size=" + windowSize,
                                        "--dump-dom",
                                        "--enable-logging=stderr",
                                        "--v=0"};
  if (waits) arguments.emplace_back("--virtual-time-budget=60000");
  arguments.push_back("file://" + folder.path(page));
  const CommandResult result = folder.run("timeout", arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find("CONSOLE"), std::string::npos) << result.err;
  const std::string begin = "<pre id=\"report\">";
  const std::size_t at = result.out.find(begin), end = result.out.find("</pre>", at);
  EXPECT_NE(at, std::string::npos) << result.err;
  if (at == std::string::npos) return {};
  return nlohmann::json::parse(result.out.substr(at + begin.size(), end - at - begin.size()));
}

/// Largest distance between what the page shows and a frame, relative to the frame's largest side.
inline double distance(const nlohmann::json& shown, const std::vector<std::array<double, 3>>& frame) {
  const auto numbers = shown.get<std::vector<double>>();
  EXPECT_EQ(numbers.size(), 3 * frame.size());
  Eigen::AlignedBox3d box;
  double farthest = 0.0;
  for (std::size_t v = 0; v < frame.size() && 3 * v + 2 < numbers.size(); ++v) {
    const Eigen::Vector3d expected(frame[v].data());
    box.extend(expected);
    farthest = std::max(farthest, (Eigen::Vector3d(&numbers[3 * v]) - expected).norm());
  }
  return farthest / box.sizes().maxCoeff();
}

}  // namespace tetskin::test
