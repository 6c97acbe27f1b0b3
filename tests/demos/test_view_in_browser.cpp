// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pages as a browser shows them: a probe is appended to a page, and writes its results into the page's document.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

std::string withProbe(const CommandFolder& folder, const std::string& page) {
  std::string text = folder.read(page);
  const std::string probe = "<script>" + folder.read(TETSKIN_PROBE) + "</script>\n";  // an absolute path
  return text.insert(text.rfind("</body>"), probe);
}

/// The results of the probe. Pages are drawn without a graphics card; one that does not end is stopped.
nlohmann::json seenIn(const CommandFolder& folder, const std::string& page, const std::string& windowSize) {
  const std::string probed = folder.write("probed.html", withProbe(folder, page));
  const CommandResult result = folder.run(
      "timeout", {"100", TETSKIN_CHROMIUM, "--headless", "--no-sandbox", "--user-data-dir=" + folder.path("profile"),
                  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=" + windowSize, "--dump-dom",
                  "--enable-logging=stderr", "--v=0", "file://" + probed});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find("CONSOLE"), std::string::npos) << result.err;
  const std::string begin = "<pre id=\"report\">";
  const std::size_t at = result.out.find(begin), end = result.out.find("</pre>", at);
  EXPECT_NE(at, std::string::npos) << result.err;
  if (at == std::string::npos) return {};
  return nlohmann::json::parse(result.out.substr(at + begin.size(), end - at - begin.size()));
}

/// Largest distance between what the page shows and a frame, relative to the frame's largest side.
double distance(const nlohmann::json& shown, const std::vector<std::array<double, 3>>& frame) {
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

/// The tolerance for equality; the two kinds of surface differ by more than that.
constexpr double kSame = 1e-3;

TEST(ViewInBrowser, PlaysWhatTheFramesHaveWithEitherSkin) {
  const CommandFolder folder;
  for (const std::string kind : {"linear", "quadratic"}) {
    const CommandResult result =
        folder.run(TETSKIN_DROP, {"--triangles", "3000", "--tets", "300", "--frames", "101", "--every", "100",
                                  "--interpolation", kind, "--out", kind, "--contact", "cage"});
    ASSERT_EQ(result.status, 0) << result.err;
  }
  const nlohmann::json seen = seenIn(folder, "linear/view.html", "640,480");
  ASSERT_TRUE(seen.is_object());
  EXPECT_GT(seen["colours"], 50);
  EXPECT_GT(seen["difference"], 0.005);
  EXPECT_GT(seen["cage"], 0.002);
  EXPECT_TRUE(seen["fits"]);
  EXPECT_TRUE(seen["clear"]) << "the header or the footer hides a body";
  EXPECT_TRUE(seen["outside"]) << "the camera is under the floor, or in an obstacle";
  for (const std::string kind : {"linear", "quadratic"}) {
    for (const std::string frame : {"0", "100"}) {
      const auto expected =
          test::objPositions(folder.read(kind + (frame == "0" ? "/frame_0000.obj" : "/frame_0100.obj")));
      ASSERT_FALSE(expected.empty());
      EXPECT_LT(distance(seen[kind + "_" + frame], expected), kSame) << kind << " " << frame;
    }
  }
  EXPECT_GT(distance(seen["linear_100"], test::objPositions(folder.read("quadratic/frame_0100.obj"))), kSame);
}

TEST(ViewInBrowser, PlaysBothSkinsSideBySideOnAPhone) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_TWIST, {"--triangles", "2000", "--tets", "100", "--frames", "101",
                                                          "--every", "100", "--out", "o", "--view", "view.html"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json seen = seenIn(folder, "view.html", "390,800");
  ASSERT_TRUE(seen.is_object());
  EXPECT_GT(seen["colours"], 50);
  EXPECT_GT(seen["difference"], 0.005);
  EXPECT_TRUE(seen["fits"]);
  EXPECT_TRUE(seen["clear"]) << "the header or the footer hides a body";
  const auto expected = test::objPositions(folder.read("o/frame_0100.obj"));
  EXPECT_LT(distance(seen["linear_100"], expected), kSame);
  EXPECT_LT(distance(seen["quadratic_100"], expected), kSame) << "each body has its own skin, whatever the switch";
}

}  // namespace
}  // namespace tetskin
