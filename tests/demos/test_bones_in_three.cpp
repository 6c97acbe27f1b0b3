// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The recipe for three.js, run in a browser.

#include "browser.h"
#include "moved_model.h"

namespace tetskin::test {
namespace {

template <class Values>
nlohmann::json flat(const Values& values) {
  nlohmann::json numbers = nlohmann::json::array();
  for (const auto& value : values) {
    for (const auto number : value) numbers.push_back(number);
  }
  return numbers;
}

nlohmann::json jsonOf(MovedModel& moved, const BoneKind& kind) {
  std::vector<float> bones(16 * moved.palette.boneCount());
  EXPECT_EQ(moved.palette.update(viewOf(std::as_const(moved.nodes)), {bones.data(), moved.palette.boneCount()}),
            StatusCode::Ok);
  return {{"positions", flat(moved.restPositions)},
          {"normals", flat(moved.normals)},
          {"bones", flat(moved.skinned.bones)},
          {"weights", flat(moved.skinned.weights)},
          {"palette", bones},
          {"gradients", kind.gradients}};
}

std::vector<Eigen::Vector3f> pointsOf(const nlohmann::json& json) {
  const auto numbers = json.get<std::vector<float>>();
  std::vector<Eigen::Vector3f> points;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += 3) points.emplace_back(&numbers[k]);
  return points;
}

TEST(BonesInThree, AreDrawnWhereTheSkinHasThem) {
  const CommandFolder folder;
  std::vector<MovedModel> models;
  nlohmann::json data = nlohmann::json::array();
  for (const BoneKind& kind : test::kBoneKinds) {
    models.emplace_back(kind, BoneLayout::Columns, 3000);
    data.push_back(jsonOf(models.back(), kind));
  }
  std::string page = "<!DOCTYPE html><html><body>\n";
  const auto addScript = [&](const std::string& text) { page += "<script>" + text + "</script>\n"; };
  addScript(folder.read(TETSKIN_THREE));
  addScript(folder.read(TETSKIN_RECIPES "/bones_three.js"));
  addScript("const MODELS = " + data.dump() + ";");
  addScript(folder.read(TETSKIN_BONES_PROBE));
  folder.write("bones.html", page + "</body></html>\n");
  const nlohmann::json report = test::reportOf(folder, "bones.html", "300,200");
  ASSERT_EQ(report.size(), models.size());
  for (std::size_t k = 0; k < models.size(); ++k) {
    const MovedModel& moved = models[k];
    const std::vector<Eigen::Vector3f> positions = pointsOf(report[k]["positions"]);
    const std::vector<Eigen::Vector3f> normals = pointsOf(report[k]["normals"]);
    ASSERT_EQ(positions.size(), moved.model.mesh.vertexCount());
    ASSERT_EQ(normals.size(), positions.size());
    SCOPED_TRACE(test::kBoneKinds[k].name);
    EXPECT_LT(moved.farthest(positions), 1e-5);
    if (test::kBoneKinds[k].turnsNormals()) {
      EXPECT_LT(moved.meanDegrees(normals), test::kBoneKinds[k].meanDegrees);
    } else {
      EXPECT_GT(moved.meanDegrees(normals), 30.0) << "there is something to turn";
    }
  }
}

}  // namespace
}  // namespace tetskin::test
