// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The GLB of a run as three.js loads and plays it, against the OBJ frames.

#include "browser.h"
#include "view/view_data.h"

namespace tetskin::test {
namespace {

std::string pageOf(const CommandFolder& folder, const std::string& glb) {
  std::string page = "<!DOCTYPE html><html><body>\n";
  for (const char* script : {TETSKIN_THREE, TETSKIN_GLTF_LOADER}) {  // absolute paths
    page += "<script>" + folder.read(script) + "</script>\n";
  }
  page += "<script>const GLB = '" + view::base64(folder.read(glb)) + "';</script>\n";
  return page + "<script>" + folder.read(TETSKIN_GLB_PROBE) + "</script>\n</body></html>\n";
}

TEST(GlbInBrowser, PlaysWhatTheFramesHave) {
  const CommandFolder folder;
  for (const std::string kind : {"linear", "quadratic"}) {
    const CommandResult result =
        folder.run(TETSKIN_DROP, {"--triangles", "3000", "--tets", "300", "--frames", "101", "--every", "100",
                                  "--interpolation", kind, "--out", kind, "--contact", "cage", "--no-view"});
    ASSERT_EQ(result.status, 0) << result.err;
    folder.write("page.html", pageOf(folder, kind + "/animation.glb"));
    const nlohmann::json seen = test::reportOf(folder, "page.html", "640,480", true);
    ASSERT_TRUE(seen.is_object() && !seen.contains("error")) << seen;
    EXPECT_EQ(seen["meshes"], 5) << "one per material";
    EXPECT_EQ(seen["colours"], 5);
    EXPECT_EQ(seen["normals"], kind == "quadratic");
    EXPECT_TRUE(seen["texcoords"]);
    EXPECT_TRUE(seen["obstacles"]);
    EXPECT_GT(seen["drawn"], 0.05);
    for (const std::string frame : {"0", "100"}) {
      const auto expected =
          test::objPositions(folder.read(kind + (frame == "0" ? "/frame_0000.obj" : "/frame_0100.obj")));
      ASSERT_FALSE(expected.empty());
      EXPECT_LT(test::distance(seen["frame_" + frame], expected), 1e-4) << kind << " " << frame;
    }
  }
}

}  // namespace
}  // namespace tetskin::test
