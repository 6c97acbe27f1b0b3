// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/embedding.h>

#include <numeric>

#include "error_vs_time_run.h"
#include "report/quadratic_cage.h"
#include "scenes/bar.h"
#include "scenes/caged_mesh.h"

namespace tetskin::test {
namespace {

class ReportReferences : public ErrorVsTimeRun {};

/// Creates a cage for a built-in model, as a user would.
void buildReference(const CommandFolder& folder, const std::string& model, const std::string& tets,
                    const std::string& file) {
  const CommandResult result =
      folder.run(TETSKIN_CAGE, {"--model", model, "--triangles", "4000", "--tets", tets, "--quiet", "-o", file});
  ASSERT_EQ(result.status, 0) << result.err;
}

TEST_F(ReportReferences, TakesTheTetsThatABuiltInModelComesWith) {
  std::vector<std::string> arguments = words(
      "--model slotted_beam --triangles 2000 --scenes sag --tets 300 --no-calibration --frames 3 --interpolation "
      "linear "
      "--no-reduction --substeps 4 --reference-substeps 4");
  const auto with = [&](const std::string& tets) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--reference-tets", tets, "--out", "out"});
    return run(all);
  };
  const CommandResult result = with("2000");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("tets by formula"), std::string::npos) << result.out;
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(json.at("model"), "slotted_beam");
  EXPECT_EQ(json.at("reference").at("from"), "formula");
  EXPECT_GE(json.at("reference").at("tets"), 2000);
  // Bullet's forces know no quadratic tets.
  const auto references = rowsOf(json.at("scenes").at(0), "reference");
  ASSERT_EQ(references.size(), 2u);
  for (const auto& row : references) {
    const bool bullets = row.at("integrator") == "explicit";
    EXPECT_NEAR(number(row, "tets") / number(json.at("reference"), "tets"), bullets ? 1.1 : 1.0, 0.1) << row;
  }
  EXPECT_GT(number(json.at("scenes").at(0), "reference_error"), 0.0);
  EXPECT_EQ(json.at("scenes").at(0).at("rows").size(), 3u);

  for (std::string& one : arguments) one = one == "slotted_beam" ? "hand" : one;
  const CommandResult few = with("1000");
  ASSERT_EQ(few.status, 0) << few.err;
  EXPECT_NE(few.out.find("a built cage of about 1000 tets"), std::string::npos) << few.out;
  EXPECT_EQ(folder.json("out/error_vs_time.json").at("reference").at("from"), "built");
}

TEST_F(ReportReferences, TakesAReferenceFromAFile) {
  const std::vector<std::string> arguments = words(
      "--model bar --triangles 4000 --scenes sag --tets 300 --no-calibration --no-reduction --substeps 4 "
      "--reference-substeps 4 --frames 3 --interpolation linear --reference r.vtk --out out");
  std::vector<double> errors;
  for (const char* tets : {"1500", "2500"}) {
    buildReference(folder, "bar", tets, "r.vtk");
    const CommandResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("tets from r.vtk"), std::string::npos) << result.out;
    const auto json = folder.json("out/error_vs_time.json");
    EXPECT_EQ(json.at("reference").at("from"), "r.vtk");
    EXPECT_NEAR(number(json.at("reference"), "tets"), std::stod(tets), 0.1 * std::stod(tets));
    const auto& scene = json.at("scenes").at(0);
    EXPECT_EQ(number(rowsOf(scene, "reference").at(0), "tets"), number(json.at("reference"), "tets"));
    errors.push_back(number(rowsOf(scene, "linear").at(0), "error_total_rms"));
  }
  EXPECT_GT(errors[0], 0.0);
  EXPECT_NE(errors[0], errors[1]);
}

Eigen::Vector3d centreOf(const Cage& cage) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < cage.masses.size(); ++n) sum += cage.masses[n] * cage.mesh.nodes[n];
  return sum / std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
}

TEST(QuadraticCage, KnowsOfItsMeshWhatTheCageKnows) {
  const TriangleMesh mesh = scenes::makeBar(4000);
  CageOptions options;
  options.targetTets = 200;
  options.fit = false;
  const Cage coarse = scenes::builtCage(mesh, options), cage = report::quadraticCage(coarse, mesh);
  ASSERT_TRUE(validate(cage).ok()) << validate(cage).message;
  EXPECT_EQ(quadraticTets(cage).value().size(), coarse.mesh.tetCount());
  const double mass = std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  EXPECT_NEAR(mass, std::accumulate(coarse.masses.begin(), coarse.masses.end(), 0.0), 1e-3 * mass);
  EXPECT_LT(centreOf(cage).head<1>().norm(), 0.01) << "the bar is its own mirror image";
  double filled = 0.0, whole = 0.0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const Tet& tet = cage.mesh.tets[t];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = cage.mesh.nodes[tet[k + 1]] - cage.mesh.nodes[tet[0]];
    filled += cage.volumeFraction[t] * edges.determinant() / 6.0;
    whole += edges.determinant() / 6.0;
  }
  EXPECT_NEAR(filled, mass, 0.02 * mass);
  EXPECT_GT(whole, 1.2 * filled);
  EmbedReport report;
  ASSERT_TRUE(embed(cage.mesh, viewOf(mesh.positions), {}, &report).ok());
  EXPECT_EQ(report.outside, 0u);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_EQ(cage.vertexTets[v] / 8, coarse.vertexTets[v]);
    const Tet& tet = cage.mesh.tets[cage.vertexTets[v]];
    Eigen::Matrix4d corners;
    for (int k = 0; k < 4; ++k) corners.col(k) << cage.mesh.nodes[tet[k]], 1.0;
    ASSERT_GE((corners.inverse() * mesh.positions[v].homogeneous()).minCoeff(), -1e-9);
  }
}

}  // namespace
}  // namespace tetskin::test
