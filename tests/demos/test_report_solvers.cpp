// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <limits>
#include <set>

#include "error_vs_time_run.h"
#include "measure/xpbd.h"
#include "report/solver.h"
#include "report/xpbd_fit.h"

namespace tetskin::test {
namespace {

class ReportSolvers : public ErrorVsTimeRun {
 protected:
  static std::vector<std::string> solvers(const std::string& names, const std::vector<std::string>& more = {}) {
    std::vector<std::string> all = test::words(
        "--quick --quiet --tets 600 --reference-tets 2700 --triangles 2000 --frames 12 --out out --solvers " + names);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::vector<nlohmann::json> rowsOfSolver(const std::string& name) const {
    std::vector<nlohmann::json> rows;
    const auto json = folder.json("out/error_vs_time.json");
    for (const auto& row : json.at("scenes").at(0).at("rows")) {
      if (row.at("integrator") == name && row.at("interpolation") != "reference") rows.push_back(row);
    }
    return rows;
  }
};

TEST_F(ReportSolvers, AllHaveRowsOfTheSameCageInTheirSubsteps) {
  const CommandResult result = run(solvers("all", {"--substeps", "2,4"}));
  ASSERT_EQ(result.status, 0) << result.err;
  std::set<double> tets, spaces;
  for (const report::Solver solver : report::kSolvers) {
    const auto rows = rowsOfSolver(nameOf(solver));
    ASSERT_EQ(rows.size(), 2u) << nameOf(solver);
    for (const auto& row : rows) {
      EXPECT_EQ(row.at("material"), "calibrated");
      EXPECT_EQ(row.at("interpolation"), "linear");
      EXPECT_GT(number(row, "simulation_ms"), 0.0) << row;
      EXPECT_EQ(number(row, "xpbd_stiffness") > 0.0, isXpbd(solver)) << row;
      tets.insert(number(row, "tets"));
      spaces.insert(number(row, "error_space_rms"));
      if (number(row, "finite") == 0.0) continue;
      // Of three motions, the first and the last are no farther apart than by way of the second.
      EXPECT_LE(number(row, "error_total_rms"), number(row, "error_space_rms") + number(row, "error_time_rms") + 1e-9);
      EXPECT_GT(number(row, "error_of_motion"), number(row, "error_total_rms")) << "it moves by less than its size";
    }
  }
  EXPECT_EQ(tets.size(), 1u);
  EXPECT_EQ(spaces.size(), 1u) << "all are compared with the same motions";
  for (const auto& row : rowsOfSolver("tetskin")) EXPECT_LT(number(row, "error_of_motion"), 0.2) << row;
}

TEST_F(ReportSolvers, XpbdApproachesTheSagWithMoreSubstepsAndIsNeverWorseWithFittedConstants) {
  const CommandResult result = run(solvers("xpbd,xpbd_unfitted", {"--xpbd-substeps", "2,10,40", "--frames", "24"}));
  ASSERT_EQ(result.status, 0) << result.err;
  const auto fitted = rowsOfSolver("xpbd"), unfitted = rowsOfSolver("xpbd_unfitted");
  ASSERT_EQ(fitted.size(), 3u);
  ASSERT_EQ(unfitted.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(number(fitted[k], "finite"), 1.0) << fitted[k];
    EXPECT_LT(number(fitted[k], "error_of_motion"), number(unfitted[k], "error_of_motion"));
  }
  EXPECT_LT(number(unfitted[1], "error_time_rms"), 0.6 * number(unfitted[0], "error_time_rms"));
  EXPECT_LT(number(unfitted[2], "error_time_rms"), number(unfitted[1], "error_time_rms"));
  EXPECT_LT(number(fitted[1], "error_of_motion"), 0.1) << fitted[1];
}

TEST_F(ReportSolvers, ReferencesAreThoseThatTheSolversNeed) {
  ASSERT_EQ(run(solvers("tetskin")).status, 0);
  const auto references = [&] {
    return test::rowsOf(folder.json("out/error_vs_time.json").at("scenes").at(0), "reference");
  };
  EXPECT_EQ(references().size(), 2u) << "tetskin's, in the usual substeps and in its own";
  ASSERT_EQ(run(solvers("bullet_linear", {"--bullet-substeps", "4"})).status, 0);
  EXPECT_EQ(references().size(), 3u);
  ASSERT_EQ(rowsOfSolver("bullet_linear").size(), 1u);
  EXPECT_GT(number(rowsOfSolver("bullet_linear")[0], "error_against_bullet_rms"), 0.0);
}

TEST(XpbdFit, FindsTheLeastErrorBetweenTheGridsPoints) {
  const auto found = report::bestConstants({0.01, 0.0}, [](const report::XpbdConstants& c) {
    if (c.stiffness > 100.0) return std::numeric_limits<double>::infinity();  // explodes
    return std::abs(std::log2(c.stiffness) - 3.6) + (c.volume == 0.0 ? 0.1 : 0.2) + c.damping;
  });
  EXPECT_NEAR(std::log2(found.stiffness), 3.6, 0.125);
  EXPECT_EQ(found.volume, 0.0);
  EXPECT_EQ(found.damping, 0.0);
}

/// A unit cube's corner: a tet with three nodes pinned, and a mass that hangs at the fourth.
measure::XpbdBody hangingTet(double compliance, double damping) {
  measure::XpbdBody body;
  body.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  body.inverseMasses = {0.0, 0.0, 0.0, 1.0};
  body.edges = {{0, 3, compliance}};
  body.damping = damping;
  return body;
}

TEST(Xpbd, ASpringStretchesByItsComplianceTimesTheWeight) {
  measure::Xpbd xpbd(hangingTet(0.01, 0.05));
  for (int frame = 0; frame < 600; ++frame) xpbd.step(1.0f / 60.0f, 10);
  const auto nodes = xpbd.nodes();
  EXPECT_NEAR(static_cast<double>(nodes[3].y()), -1.0 - 0.01 * 9.81, 1e-3);
  EXPECT_EQ(nodes[1], Eigen::Vector3f(1, 0, 0)) << "a pinned node stays";
}

TEST(Xpbd, DampingShortensTheSwing) {
  const auto lowest = [](double damping) {
    measure::Xpbd xpbd(hangingTet(0.01, damping));
    float low = 0.0f;
    for (int frame = 0; frame < 60; ++frame) {
      xpbd.step(1.0f / 60.0f, 50);
      low = std::min(low, xpbd.nodes()[3].y());
    }
    return static_cast<double>(low);
  };
  // Without damping it swings to twice the static stretch, except for the damping of the steps.
  EXPECT_NEAR(lowest(0.0), -1.0 - 2 * 0.0981, 0.01);
  EXPECT_NEAR(lowest(0.2), -1.0 - 0.0981, 0.005) << "critically damped";
}

TEST(Xpbd, RigidVolumesKeepTheVolume) {
  measure::XpbdBody body = hangingTet(0.1, 0.0);
  body.volumes = {{{0, 1, 2, 3}, 0.0}};
  measure::Xpbd xpbd(body);
  for (int frame = 0; frame < 60; ++frame) xpbd.step(1.0f / 60.0f, 10);
  EXPECT_NEAR(static_cast<double>(xpbd.nodes()[3].y()), -1.0, 1e-3) << "the volume is a third of its height";
}

}  // namespace
}  // namespace tetskin::test
