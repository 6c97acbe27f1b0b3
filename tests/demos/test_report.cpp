// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include "report/advice.h"
#include "report/coloured_mesh.h"

namespace tetskin {
namespace {

using report::Row;

Row rowWith(const std::string& interpolation, double edge, double ms, double error) {
  Row row;
  row.scene = "sag";
  row.material = "same";
  row.interpolation = interpolation;
  row.tets = 1.0 / (edge * edge * edge);
  row.edge = edge;
  row.substeps = 4;
  row.totalMs = ms;
  row.errorTotalRms = row.errorSpaceRms = error;
  row.errorEmbeddingRms = edge * edge;
  return row;
}

TEST(Advice, TheFrontHoldsWhatNothingBeatsInTimeAndError) {
  std::vector<Row> rows = {rowWith("reference", 0.01, 500, 0), rowWith("linear", 0.1, 1, 0.1),
                           rowWith("linear", 0.05, 5, 0.02), rowWith("quadratic", 0.05, 6, 0.03),
                           rowWith("quadratic", 0.02, 9, 0.01)};
  rows.push_back(rows[1]);
  rows.back().totalMs = 0.5;
  rows.back().finite = 0.0;  // exploded, so it is not a choice
  report::markPareto(rows);
  std::vector<bool> front;
  for (const Row& row : rows) front.push_back(row.pareto);
  EXPECT_EQ(front, std::vector<bool>({false, true, true, false, true, false}));
}

Row reducedWith(double modes, double ms, double error) {
  Row row = rowWith("linear", 0.1, ms, error);
  row.material = "reduced";
  row.modes = modes;
  return row;
}

TEST(Advice, SaysWhetherAReducedBodyGainsOverCagesThatCostNoMore) {
  std::vector<Row> rows = {rowWith("reference", 0.01, 500, 0), rowWith("linear", 0.1, 1, 0.1),
                           rowWith("linear", 0.05, 5, 0.02)};
  EXPECT_EQ(report::reductionAdvice(rows), "");
  rows.push_back(reducedWith(20, 6, 0.03));  // a cage is better and faster than this
  EXPECT_EQ(report::reductionAdvice(rows).find(
                "Use an embedding: a cage of 8000 tets in 4 substeps has an error of 2.00e-02 at 5 ms"),
            0u);
  rows.push_back(reducedWith(5, 1.5, 0.04));  // the cage that takes as long is worse
  EXPECT_EQ(report::reductionAdvice(rows).find("Use a reduced body: 5 modes"), 0u) << report::reductionAdvice(rows);
  rows.push_back(reducedWith(1, 0.1, 0.5));  // nothing else is as fast
  EXPECT_NE(report::reductionAdvice(rows).find("no cage is as fast"), std::string::npos);
}

TEST(Advice, SaysUpToWhichDeformationLinearModesServe) {
  std::vector<Row> rows = {rowWith("linear", 0.1, 1, 0.1)};
  EXPECT_EQ(report::reductionLimit(rows).modes, 0.0);
  rows.push_back(reducedWith(5, 1, 0.1));
  rows.push_back(reducedWith(20, 1, 0.1));
  rows[2].amplitudeByFrame = {0.001, 0.01, 0.02, 0.04, 0.03};
  rows[2].errorByFrame = {0.0005, 0.0005, 0.0019, 0.02, 0.01};
  EXPECT_EQ(report::reductionLimit(rows).modes, 20.0);
  EXPECT_EQ(report::reductionLimit(rows).amplitude, 0.02);
}

TEST(Advice, FindsTheReferencesOwnErrorFromCoarserOnes) {
  // Errors relative to the exact solution fall as C edge^p; the reference is also such a cage.
  const auto level = [](double edge, double p) {
    return report::CoarserLevel{edge, 3.0 * (std::pow(edge, p) - std::pow(0.01, p))};
  };
  for (const double p : {1.0, 2.0, 3.0})
    EXPECT_NEAR(report::ownError(0.01, {level(0.015, p), level(0.02, p)}), 3.0 * std::pow(0.01, p), 1e-9) << p;
  EXPECT_GT(report::ownError(0.01, {level(0.02, 2)}), 3e-4)
      << "one level does not tell the order: the worst is assumed";
  EXPECT_EQ(report::ownError(0.01, {}), 0.0);
}

TEST(Advice, MarksErrorsThatTheReferenceDoesNotResolve) {
  std::vector<Row> rows = {rowWith("reference", 0.01, 500, 0), rowWith("linear", 0.1, 1, 0.0031),
                           rowWith("linear", 0.05, 2, 0.0029)};
  report::markResolved(rows);
  for (const Row& row : rows) EXPECT_EQ(row.resolved, 1.0) << "its error is not known";
  rows[0].errorSpaceRms = 0.001;
  EXPECT_EQ(report::referenceError(rows), 0.001);
  report::markResolved(rows);
  EXPECT_EQ(rows[0].resolved, 1.0);
  EXPECT_EQ(rows[1].resolved, 1.0);
  EXPECT_EQ(rows[2].resolved, 0.0);
}

/// A cage in some substeps, with an error in time that falls as 2 step^2 against the truth, seen from 64 substeps.
Row rowInTime(const std::string& interpolation, double edge, double substeps) {
  Row row = rowWith(interpolation, edge, substeps / (edge * edge * edge), 3.0 * edge * edge);
  row.substeps = substeps;
  row.errorTimeRms = 2.0 * (1.0 / (substeps * substeps) - 1.0 / (64.0 * 64.0));
  row.errorTotalRms += row.errorTimeRms;
  return row;
}

TEST(Advice, TheFrontChoosesSubsteps) {
  // Errors of 0.03 and 0.0075 in space; in time 0.5, 0.12 and 0.03.
  std::vector<Row> rows;
  for (const double edge : {0.1, 0.05}) {
    for (const double substeps : {2.0, 4.0, 8.0}) rows.push_back(rowInTime("linear", edge, substeps));
  }
  report::markPareto(rows);
  std::vector<bool> front;
  for (const Row& row : rows) front.push_back(row.pareto);
  // Eight substeps of the coarse cage take half as long as two of the fine one.
  EXPECT_EQ(front, std::vector<bool>({true, true, true, false, false, true}));
}

TEST(Advice, FindsTheReferencesOwnErrorInTime) {
  std::vector<Row> rows = {rowInTime("reference", 0.01, 4), rowInTime("reference", 0.01, 64)};
  rows[1].errorTimeRms = 0.0;
  EXPECT_EQ(report::referenceTimeError(rows), 0.0) << "no cage shows the order";
  for (const double substeps : {8.0, 2.0, 4.0}) rows.push_back(rowInTime("linear", 0.05, substeps));
  rows.push_back(rowInTime("quadratic", 0.05, 4));
  rows.push_back(rowInTime("linear", 0.1, 4));
  rows.push_back(rowInTime("linear", 0.05, 1));
  rows.back().modes = 5;
  EXPECT_NEAR(report::referenceTimeError(rows), 2.0 / (64.0 * 64.0), 1e-9);
  rows[1].integrator = "explicit";  // another reference, not the same in more substeps
  EXPECT_EQ(report::referenceTimeError(rows), 0.0);
}

TEST(ColouredMesh, IsPlyWithAColourAVertex) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string ply = report::colouredPly(mesh, mesh.positions, {0.0f, 1.0f, 9.0f}, 1.0);
  EXPECT_NE(ply.find("element vertex 3\n"), std::string::npos);
  EXPECT_NE(ply.find("0 0 0 68 1 84\n1 0 0 253 231 37\n0 1 0 253 231 37\n3 0 1 2\n"), std::string::npos) << ply;
  EXPECT_EQ(report::maxOf({}), 0.0);
  EXPECT_EQ(report::maxOf({3.0f}), 3.0);
}

}  // namespace
}  // namespace tetskin
