// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>

#include <cmath>
#include <numeric>

#include "error_vs_time_run.h"
#include "report/cage_kind.h"
#include "report/quadratic_cage.h"
#include "scenes/caged_mesh.h"
#include "scenes/hoop_and_star.h"

namespace tetskin {
namespace {

using test::CommandResult;
using test::expectRefused;
using test::number;
using test::rowsOf;

class ReportOrders : public test::ErrorVsTimeRun {
 protected:
  nlohmann::json sceneWith(std::vector<std::string> arguments) const {
    const std::vector<std::string> all = {"--quiet", "--out", "out", "--triangles", "2000"};
    arguments.insert(arguments.end(), all.begin(), all.end());
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return folder.json("out/error_vs_time.json").at("scenes").at(0);
  }
};

TEST_F(ReportOrders, QuadraticTetsBendAsTheBeamDoesAndLinearOnesLess) {
  const auto scene = sceneWith({"--orders", "uncalibrated,quadratic", "--model", "beam", "--formula", "--tets", "1280",
                                "--reference-tets", "10240", "--frames", "20", "--reference-substeps", "16"});
  EXPECT_EQ(scene.at("scene"), "cantilever");
  const auto linear = rowsOf(scene, "quadratic", "uncalibrated"), quadratic = rowsOf(scene, "quadratic", "quadratic");
  ASSERT_EQ(linear.size(), 1u);
  ASSERT_EQ(quadratic.size(), 1u);
  EXPECT_EQ(quadratic[0].at("tets"), 1280.0);
  for (const char* error : {"error_of_motion", "error_at_rest", "frequency_error"}) {
    EXPECT_GT(number(quadratic[0], error), 0.0) << error;
    EXPECT_LT(number(quadratic[0], error), 0.5 * number(linear[0], error)) << error;
  }
  EXPECT_LT(number(linear[0], "sag_excess"), -0.05) << "too stiff";
  EXPECT_NEAR(number(quadratic[0], "sag_excess"), 0.0, 0.02);
  EXPECT_LE(number(linear[0], "error_total_rms"),
            number(linear[0], "error_space_rms") + number(linear[0], "error_time_rms") + 1e-9);
  // Which linear cage costs as much is measured, and on a busy machine there may be none; the other advice is wrong.
  const auto advice = scene.at("order_advice").get<std::string>();
  EXPECT_TRUE(advice.empty() || advice.rfind("Use quadratic tets: ", 0) == 0) << advice;
  const auto own = rowsOf(scene, "reference").back();
  for (const char* error : {"error_of_motion", "error_at_rest", "frequency_error"}) {
    EXPECT_GT(number(own, error), 0.0) << error;
    EXPECT_LT(3.0 * number(own, error), number(linear[0], error)) << error;
  }
  EXPECT_EQ(number(scene, "reference_error"), number(own, "error_space_rms"));
  EXPECT_EQ(number(linear[0], "resolved"), 1.0);
}

/// An independent check of the reference, which is of quadratic tets: linear ones converge to it, with order 2.
TEST_F(ReportOrders, LinearTetsApproachTheReference) {
  const auto scene = sceneWith({"--orders", "uncalibrated", "--model", "beam", "--formula", "--tets", "1280,10240",
                                "--reference-tets", "20000", "--frames", "2", "--reference-substeps", "4"});
  const auto rows = rowsOf(scene, "quadratic", "uncalibrated");
  ASSERT_EQ(rows.size(), 2u);
  const double coarse = number(rows[0], "sag_excess"), fine = number(rows[1], "sag_excess");
  EXPECT_NEAR(coarse / fine, 4.0, 1.0) << "half the edges";
  const double limit = (4.0 * fine - coarse) / 3.0;
  EXPECT_LT(std::abs(limit), 0.25 * std::abs(fine));
  EXPECT_LT(std::abs(limit), 0.01);
}

TEST_F(ReportOrders, CagesOfAMeshAreOfQuadraticTetsAsTheReferenceIs) {
  const auto scene = sceneWith({"--orders", "all", "--model", "star", "--tets", "600", "--reference-tets", "6000",
                                "--frames", "6", "--reference-substeps", "8"});
  EXPECT_EQ(scene.at("scene"), "sag");
  for (const report::CageKind kind : report::kOrders) {
    const auto rows = rowsOf(scene, "quadratic", nameOf(kind));
    ASSERT_EQ(rows.size(), 1u) << nameOf(kind);
    EXPECT_EQ(number(rows[0], "finite"), 1.0);
    EXPECT_EQ(number(rows[0], "substeps"), 4.0);
    EXPECT_EQ(isQuadratic(kind), std::fmod(number(rows[0], "tets"), 8.0) == 0.0) << nameOf(kind);
    EXPECT_GT(number(rows[0], "error_at_rest"), 0.0) << nameOf(kind);
  }
}

TEST_F(ReportOrders, RefusesWhatCannotBeCompared) {
  expectRefused(run({"--orders", "cubic"}), "quadratic_calibrated");
  expectRefused(run({"--orders", "all", "--scenes", "drop"}), "sag or cantilever");
  expectRefused(run({"--orders", "all", "--solvers", "all"}), "--solvers");
  expectRefused(run({"--orders", "all", "--modes", "5"}), "--modes");
  expectRefused(run({"--orders", "all", "--formula"}), "slotted_beam");
  expectRefused(run({"--formula", "--model", "beam"}), "--orders");
}

Eigen::Vector3d centreOf(const Cage& cage) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < cage.masses.size(); ++n) sum += cage.masses[n] * cage.mesh.nodes[n];
  return sum / std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
}

TEST(QuadraticCage, KnowsOfItsMeshWhatTheCageKnows) {
  const TriangleMesh mesh = scenes::makeStar(4000);
  CageOptions options;
  options.targetTets = 200;
  options.fit = false;
  const Cage coarse = scenes::builtCage(mesh, options), cage = report::quadraticCage(coarse, mesh);
  ASSERT_TRUE(validate(cage).ok()) << validate(cage).message;
  EXPECT_EQ(quadraticTets(cage).value().size(), coarse.mesh.tetCount());
  const double mass = std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  EXPECT_NEAR(mass, std::accumulate(coarse.masses.begin(), coarse.masses.end(), 0.0), 1e-3 * mass);
  EXPECT_LT(centreOf(cage).head<1>().norm(), 0.01) << "the star is its own mirror image";
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
}  // namespace tetskin
