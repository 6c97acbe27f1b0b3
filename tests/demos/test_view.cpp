// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <filesystem>

#include "command.h"
#include "scenes/input_error.h"
#include "scenes/view_page.h"

namespace tetskin::scenes {
namespace {

using namespace view;
using test::CommandFolder;
using test::CommandResult;

std::vector<Eigen::Vector3d> shifted(std::vector<Eigen::Vector3d> points, double along) {
  for (Eigen::Vector3d& p : points) p.y() += along;
  return points;
}

/// A page of a serpent that rises by `step` per frame.
ViewPage risingPage(const ModelOptions& options, int frames, double step, const std::string& title = "title") {
  const Model model = loadModel(options);
  const Embedding embedding = embed(model.cage, model.mesh).value();
  ViewPage page = newPage(title, {"a fact"}, Interpolation::Linear);
  page.addBody({page.addModel(model.cage, model.mesh, embedding), "", ""});
  for (int k = 0; k < frames; ++k) page.keep({{shifted(model.cage.mesh.nodes, step * k)}, {}});
  return page;
}

ModelOptions smallSerpent() {
  ModelOptions options;
  options.tets = 100;
  options.triangles = 3000;
  return options;
}

TEST(ViewData, IsBase64OfLittleEndianNumbers) {
  // The values are those of RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(packed(std::vector<std::uint32_t>{1, 0x0203}), (Json{{"u16", base64(std::string("\1\0\3\2", 4))}}));
  EXPECT_EQ(packed(std::vector<std::uint32_t>{0x10000}), (Json{{"u32", base64(std::string("\0\0\1\0", 4))}}));
  EXPECT_EQ(packed(std::vector<float>{1.0f}), (Json{{"f32", base64(std::string("\0\0\x80\x3F", 4))}}));
}

TEST(ViewFrames, KeepsAllWhileTheyFitThenEverySecondAndSoOn) {
  constexpr std::size_t kNodes = 100, kRoom = 64;  // each moment takes 600 bytes
  ViewFrames frames(kRoom * 6 * kNodes);
  const auto at = [](double x) { return ViewMoment{{std::vector<Eigen::Vector3d>(kNodes, {x, 0, 0})}, {}}; };
  for (std::size_t k = 0; k < kRoom; ++k) frames.keep(at(static_cast<double>(k)));
  EXPECT_EQ(frames.size(), kRoom);
  EXPECT_EQ(frames.stride(), 1);
  for (std::size_t k = kRoom; k < 1000; ++k) frames.keep(at(static_cast<double>(k)));
  EXPECT_EQ(frames.stride(), 16);
  EXPECT_EQ(frames.size(), 63u);
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(frames.nodes(k, 0)[0], static_cast<float>(16 * k));
}

TEST(ViewFrames, HoldsWhatIsFarFromTheOriginInFloat) {
  ViewFrames frames;
  const Eigen::Vector3d far(1e9, 0, 0);
  frames.keep({{{far, far + Eigen::Vector3d(1.5, 0, 0)}}, {Eigen::Affine3d(Eigen::Translation3d(far))}});
  EXPECT_EQ(frames.nodes(0, 0)[3] - frames.nodes(0, 0)[0], 1.5f);
  EXPECT_EQ(frames.prop(0, 0)(0, 3), frames.nodes(0, 0)[0]);
}

TEST(ViewPage, IsOneFileWithAllThatItNeeds) {
  const std::string page = risingPage(smallSerpent(), 3, 0.1, "</script><b>").html(viewFiles());
  for (const char* part :
       {"three.js authors", "OrbitControls", "class Skin", "class Stage", "\"moments\":3", "a fact"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  for (const char* part : {"<script src", "@DATA@", "@THREE@", "</script><b>"}) {
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  }
}

TEST(ViewPage, Of240FramesOfThirtyThousandVerticesIsBelow12Megabytes) {
  ModelOptions options;
  options.tets = 3000;
  options.triangles = 60000;
  const ViewPage page = risingPage(options, 240, 0.01);
  EXPECT_EQ(page.frames().stride(), 1);
  const std::size_t bytes = page.html(viewFiles()).size();
  EXPECT_LT(bytes, 12'000'000u);
  EXPECT_GT(bytes, 1'000'000u);
}

TEST(ViewPage, GrowsByTheNodesOfAFrameAndNoFurtherThanItsRoom) {
  const auto bytes = [](int frames) { return risingPage(smallSerpent(), frames, 0.01).html(viewFiles()).size(); };
  const auto nodes = static_cast<double>(loadModel(smallSerpent()).cage.mesh.nodeCount());
  EXPECT_NEAR(static_cast<double>(bytes(120) - bytes(20)), 100 * 6 * nodes * 4 / 3, 50);
}

TEST(ViewPage, IsMadeWhereItIsAskedFor) {
  OutputOptions options;
  EXPECT_EQ(viewPath(options), "");
  options.view = "view.html";
  EXPECT_EQ(viewPath(options), "view.html");
  options.noView = true;
  EXPECT_THROW(viewPath(options), InputError) << "it is asked for, and refused";
}

TEST(View, IsWrittenByDropUnlessItIsLeftOut) {
  const CommandFolder folder;
  const auto drop = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--tets", "100", "--triangles", "3000", "--frames", "5", "--out", "o"});
    return folder.run(TETSKIN_DROP, more);
  };
  ASSERT_EQ(drop({"--no-view"}).status, 0);
  EXPECT_FALSE(folder.exists("o/view.html"));
  const CommandResult result = drop({"--every", "4"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("in a browser (o/view.html, "), std::string::npos) << result.out;
  EXPECT_NE(folder.read("o/view.html").find("\"moments\":5"), std::string::npos) << "whatever --every leaves out";
  ASSERT_EQ(drop({"--view", "elsewhere.html", "--quiet"}).status, 0);
  EXPECT_TRUE(folder.exists("elsewhere.html"));
}

TEST(View, IsWrittenByTheOthersWhereAskedFor) {
  const CommandFolder folder;
  const auto run = [&](const char* demo, std::vector<std::string> more) {
    more.insert(more.end(), {"--triangles", "3000", "--frames", "3", "--out", "o"});
    EXPECT_EQ(folder.run(demo, more).status, 0) << demo;
    EXPECT_FALSE(folder.exists("o/view.html"));
    more.insert(more.end(), {"--view", "view.html"});
    EXPECT_EQ(folder.run(demo, more).status, 0) << demo;
    return folder.read("view.html");
  };
  const std::string pile = run(TETSKIN_PILE, {"--tets", "60", "--bodies", "4"});
  EXPECT_NE(pile.find("4 soft bodies"), std::string::npos);
  const std::string drag = run(TETSKIN_DRAG, {"--tets", "100"});
  EXPECT_NE(drag.find("\"places\":"), std::string::npos) << "of its hat, ring and pointer";
}

TEST(View, ShowsACoarseCageBesideTheReference) {
  const CommandFolder folder;
  const std::vector<std::string> quick = {
      "--triangles", "3000",  "--tets",  "100,200", "--reference-tets", "600",
      "--frames",    "4",     "--cages", "same",    "--no-reduction",   "--show-tets",
      "200",         "--out", "o",       "--view",  "view.html"};
  std::vector<std::string> arguments = quick;
  arguments.insert(arguments.end(), {"--scenes", "exact,sag"});
  const CommandResult result = folder.run(TETSKIN_ERROR_VS_TIME, arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = folder.read("view.html");
  EXPECT_NE(page.find("serpent: sag"), std::string::npos);
  EXPECT_NE(page.find("\"label\":\"reference, "), std::string::npos);
  EXPECT_NE(page.find("\"moments\":5"), std::string::npos);

  arguments = quick;
  arguments.insert(arguments.end(), {"--scenes", "exact"});
  test::expectRefused(folder.run(TETSKIN_ERROR_VS_TIME, arguments), "--view");
}

}  // namespace
}  // namespace tetskin::scenes
