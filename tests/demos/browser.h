// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pages as a browser shows them: their scripts leave what they have seen in the page's document.
#pragma once

#include <gtest/gtest.h>

#include "command.h"

namespace tetskin::test {

/// What a page has left in its element `report`. It is drawn without a graphics card, and stopped if it does not end.
inline nlohmann::json reportOf(const CommandFolder& folder, const std::string& page, const std::string& windowSize) {
  const CommandResult result = folder.run(
      "timeout", {"100", TETSKIN_CHROMIUM, "--headless", "--no-sandbox", "--user-data-dir=" + folder.path("profile"),
                  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=" + windowSize, "--dump-dom",
                  "--enable-logging=stderr", "--v=0", "file://" + folder.path(page)});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find("CONSOLE"), std::string::npos) << result.err;
  const std::string begin = "<pre id=\"report\">";
  const std::size_t at = result.out.find(begin), end = result.out.find("</pre>", at);
  EXPECT_NE(at, std::string::npos) << result.err;
  if (at == std::string::npos) return {};
  return nlohmann::json::parse(result.out.substr(at + begin.size(), end - at - begin.size()));
}

}  // namespace tetskin::test
