// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pages as a browser shows them: a probe is appended to a page, and writes its results into the page's document.

#include "browser.h"

namespace tetskin::test {
namespace {

std::string withProbe(const CommandFolder& folder, const std::string& page) {
  std::string text = folder.read(page);
  const std::string probe = "<script>" + folder.read(TETSKIN_PROBE) + "</script>\n";  // an absolute path
  return text.insert(text.rfind("</body>"), probe);
}

/// The results of the probe.
nlohmann::json seenIn(const CommandFolder& folder, const std::string& page, const std::string& windowSize) {
  folder.write("probed.html", withProbe(folder, page));
  return test::reportOf(folder, "probed.html", windowSize);
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

/// A coarse cage, whose skin the switch chooses, beside a reference, whose skin is quadratic.
TEST(ViewInBrowser, PlaysEachBodyWithItsOwnSkinOnAPhone) {
  const CommandFolder folder;
  const std::string small =
      " --triangles 3000 --tets 100,200 --reference-tets 600 --frames 100 --substeps 4 --reference-substeps 8 --cages "
      "same --no-reduction --interpolation linear --scenes twist --show-tets 200 --quiet --out o --view view.html";
  const CommandResult result = folder.run("sh", {"-c", TETSKIN_ERROR_VS_TIME + small});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json seen = seenIn(folder, "view.html", "390,800");
  ASSERT_TRUE(seen.is_object());
  EXPECT_GT(seen["colours"], 50);
  EXPECT_GT(seen["difference"], 0.005);
  EXPECT_TRUE(seen["fits"]);
  EXPECT_TRUE(seen["clear"]) << "the header or the footer hides a body";
  const auto linear = seen["linear_100"].get<std::vector<double>>();
  const auto quadratic = seen["quadratic_100"].get<std::vector<double>>();
  ASSERT_EQ(linear.size(), quadratic.size());
  const auto middle = static_cast<std::ptrdiff_t>(linear.size() / 2);
  EXPECT_FALSE(std::equal(linear.begin(), linear.begin() + middle, quadratic.begin()));
  EXPECT_TRUE(std::equal(linear.begin() + middle, linear.end(), quadratic.begin() + middle))
      << "the reference has its own skin, whatever the switch";
}

TEST(ViewInBrowser, ShadesSmoothlyAcrossSeamsOfAnyMesh) {
  const CommandFolder folder;
  // More corners of triangles than 16 bits can count, of fewer vertices.
  const CommandResult result = folder.run(TETSKIN_DROP, {"--triangles", "24000", "--tets", "300", "--frames", "101",
                                                         "--every", "100", "--out", "o", "--contact", "cage"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json seen = seenIn(folder, "o/view.html", "640,480");
  ASSERT_TRUE(seen.is_object());
  const nlohmann::json& serpent = seen["shading"][0];
  EXPECT_GT(serpent["flat"], 30000);
  EXPECT_GT(serpent["smooth"], 0.999);
  EXPECT_LT(serpent["agreement"], 0.9) << "it is shaded flat";
}

TEST(ViewInBrowser, KeepsCreasesAndShowsASoftShadowOnAGrid) {
  const CommandFolder folder;
  folder.write("box.obj",
               "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n"
               "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
  const CommandResult result = folder.run(TETSKIN_DROP, {"--mesh", folder.path("box.obj"), "--tets", "100", "--frames",
                                                         "101", "--every", "100", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json seen = seenIn(folder, "o/view.html", "640,480");
  ASSERT_TRUE(seen.is_object());
  EXPECT_GT(seen["shading"][0]["agreement"], 0.999);
  EXPECT_NEAR(seen["grid"]["all"], 10, 1) << "in a body's size";
  EXPECT_NEAR(seen["grid"]["clear"], 2, 1) << "in a body's size";
  EXPECT_GT(seen["high"]["dark"], 30);
  EXPECT_GT(seen["high"]["size"], 0.01);
  // Of a shadow with sharp edges, 0.03 of the pixels are neither light nor dark, wherever the box is.
  EXPECT_GT(seen["high"]["half"], 0.1) << "the shadow is sharp";
  EXPECT_LT(seen["low"]["half"], 0.85 * seen["high"]["half"].get<double>()) << "the shadow is as soft where it lies";
}

}  // namespace
}  // namespace tetskin::test
