// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "command.h"
#include "report/advice.h"
#include "report/cage_kind.h"
#include "report/coloured_mesh.h"
#include "report/result_store.h"
#include "scenes/table.h"

namespace tetskin {
namespace {

using report::Row;
using test::CommandFolder;
using test::CommandResult;
using test::expectRefused;

Row rowWith(const std::string& interpolation, double edge, double ms, double error) {
  Row row;
  row.scene = "sag";
  row.material = "same";
  row.interpolation = interpolation;
  row.tets = 1.0 / (edge * edge * edge);
  row.edge = edge;
  row.totalMs = ms;
  row.errorTotalRms = error;
  row.errorEmbeddingRms = edge * edge;
  return row;
}

TEST(Advice, TheFrontHoldsWhatNothingBeatsInTimeAndError) {
  std::vector<Row> rows = {rowWith("reference", 0.01, 500, 0),  rowWith("linear", 0.1, 1, 0.1),
                           rowWith("linear", 0.05, 5, 0.02),    rowWith("quadratic", 0.05, 6, 0.03),
                           rowWith("quadratic", 0.02, 9, 0.01), rowWith("bullet", 0.1, 0.1, 0.001)};
  rows.push_back(rows[1]);
  rows.back().totalMs = 0.5;
  rows.back().finite = 0.0;  // exploded: no choice
  report::markPareto(rows);
  std::vector<bool> front;
  for (const Row& row : rows) front.push_back(row.pareto);
  EXPECT_EQ(front, std::vector<bool>({false, true, true, false, true, false, false}));
}

TEST(Advice, FindsOrderAndTheReferencesOwnError) {
  // Errors against a truth fall as 3 edge^2; the reference is such a cage, too.
  std::vector<Row> rows = {rowWith("reference", 0.01, 500, 0)};
  for (const double edge : {0.08, 0.04, 0.02}) {
    rows.push_back(rowWith("quadratic", edge, 1, 3.0 * (edge * edge - 0.01 * 0.01)));
  }
  EXPECT_NEAR(report::referenceError(rows), 3e-4, 1e-9);
  const auto steps = report::observedOrders(rows, "quadratic", "same");
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_NEAR(steps[0].embedding, 2.0, 1e-9);
  EXPECT_NEAR(report::overallOrder(rows, "quadratic", "same").embedding, 2.0, 1e-9);
  EXPECT_TRUE(report::observedOrders(rows, "linear", "same").empty());
  rows.resize(2);
  EXPECT_EQ(report::referenceError(rows), 0.0);
}

TEST(ReportRow, ComesBackFromJson) {
  Row row = rowWith("linear", 0.1, 2.5, 1.0 / 3.0);
  row.errorByFrame = {0.1, 1e-7};
  row.pareto = true;
  EXPECT_EQ(toJson(report::rowFrom(toJson(row))), toJson(row));
}

TEST(ResultStore, KeepsWhatWasFinishedAndNothingElse) {
  const CommandFolder folder;
  const report::ResultStore store(folder.path("rows"));
  const nlohmann::ordered_json settings = {{"tets", 300}}, others = {{"tets", 301}};
  EXPECT_FALSE(store.rows(settings));
  store.keep(settings, {rowWith("linear", 0.1, 1, 1)});
  ASSERT_TRUE(store.rows(settings));
  EXPECT_EQ(store.rows(settings)->size(), 1u);
  EXPECT_FALSE(store.rows(others));

  const report::Trajectory trajectory = {{Eigen::Vector3f(1, 2, 3)}, {Eigen::Vector3f(4, 5, 6)}};
  store.keep(settings, trajectory);
  EXPECT_EQ(store.trajectory(settings), trajectory);
  for (const auto& file : std::filesystem::directory_iterator(folder.path("rows"))) {
    std::ofstream(file.path(), std::ios::app) << "x";  // damaged
  }
  EXPECT_FALSE(store.rows(settings));
  EXPECT_FALSE(store.trajectory(settings));
}

TEST(ColouredMesh, IsPlyWithAColourAVertex) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string ply = report::colouredPly(mesh, mesh.positions, {0.0f, 1.0f, 9.0f}, 1.0);
  EXPECT_NE(ply.find("element vertex 3\n"), std::string::npos);
  EXPECT_NE(ply.find("0 0 0 68 1 84\n1 0 0 253 231 37\n0 1 0 253 231 37\n3 0 1 2\n"), std::string::npos) << ply;
  EXPECT_EQ(report::mostOf({}), 0.0);
  EXPECT_EQ(report::mostOf({3.0f}), 3.0);
}

class ErrorVsTime : public testing::Test {
 protected:
  /// Where no Python has matplotlib: plots take seconds.
  CommandResult run(const std::vector<std::string>& arguments) const { return runWith("raise ImportError", arguments); }
  /// With a matplotlib of the test's own in place of the real one.
  CommandResult runWith(const std::string& matplotlib, std::vector<std::string> arguments,
                        const std::string& program = TETSKIN_ERROR_VS_TIME) const {
    std::filesystem::create_directories(folder.path("python"));
    folder.write("python/matplotlib.py", matplotlib);
    arguments.insert(arguments.begin(), {"PYTHONPATH=" + folder.path("python"), program});
    return folder.run("env", arguments);
  }
  /// The small scene of the tests below, with Bullet's explicit forces.
  std::vector<std::string> small(const std::string& scene, const std::vector<std::string>& more = {},
                                 const std::string& out = "out") const {
    std::vector<std::string> all = {
        "--quick",     "--quiet", "--scene",  scene, "--tets", "300,900", "--reference-tets", "2700",
        "--triangles", "2000",    "--frames", "6",   "--out",  out,       "--force",          "bullet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  CommandFolder folder;
};

const nlohmann::json& sceneOf(const nlohmann::json& json, const std::string& name) {
  return *std::find_if(json.at("scenes").begin(), json.at("scenes").end(),
                       [&](const auto& scene) { return scene.at("scene") == name; });
}

/// The rows of one kind, coarsest first.
std::vector<nlohmann::json> rowsOf(const nlohmann::json& scene, const std::string& interpolation,
                                   const std::string& material = "same") {
  std::vector<nlohmann::json> rows;
  for (const auto& row : scene.at("rows")) {
    if (row.at("interpolation") == interpolation && row.at("material") == material) rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.at("tets") < b.at("tets"); });
  return rows;
}

double number(const nlohmann::json& row, const char* key) {
  return row.at(key).get<double>();
}

double overall(const nlohmann::json& scene, const std::string& interpolation, const char* of) {
  for (const auto& order : scene.at("orders")) {
    if (order.at("interpolation") == interpolation && order.at("material") == "same") {
      return order.at("overall").at(of).get<double>();
    }
  }
  return 0.0;
}

/// The figures, from one quick run of everything.
TEST_F(ErrorVsTime, QuickReportHoldsWhatItShould) {
  const CommandResult result = run({"--quick", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("1000/1000"), std::string::npos) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  ASSERT_EQ(json.at("scenes").size(), 4u);

  const auto& exact = sceneOf(json, "exact");
  EXPECT_GT(overall(exact, "linear", "embedding"), 1.8);
  EXPECT_GT(overall(exact, "quadratic", "embedding"), 2.7);
  for (const auto& row : exact.at("rows")) {
    EXPECT_EQ(row.at("error_simulation_rms"), 0.0);
    EXPECT_EQ(row.at("error_total_rms"), row.at("error_embedding_rms"));
  }

  for (const char* name : {"sag", "twist", "drop"}) {
    const auto& scene = sceneOf(json, name);
    EXPECT_GT(number(scene, "reference_error"), 0.0);
    EXPECT_EQ(rowsOf(scene, "reference").size(), 2u);
    for (const auto& row : rowsOf(scene, "quadratic")) {
      // The two references are of one body: their motions differ by far less than coarse cages do.
      EXPECT_NEAR(number(row, "error_against_bullet_rms"), number(row, "error_total_rms"),
                  0.3 * number(row, "error_total_rms") + 1e-3)
          << name;
      EXPECT_GT(number(row, "speedup_against_bullet"), 4.0 * number(row, "speedup")) << name;
    }
    EXPECT_EQ(rowsOf(scene, "bullet").size(), 3u);
    EXPECT_EQ(rowsOf(scene, "linear", "calibrated").size(), 3u);
    for (const char* interpolation : {"linear", "quadratic"}) {
      const auto rows = rowsOf(scene, interpolation);
      ASSERT_EQ(rows.size(), 3u);
      for (std::size_t k = 1; k < rows.size(); ++k) {
        for (const char* error : {"error_total_rms", "error_embedding_rms", "error_simulation_rms"}) {
          EXPECT_LT(number(rows[k], error), number(rows[k - 1], error)) << name << " " << interpolation << " " << error;
        }
      }
    }
    for (const auto& row : scene.at("rows")) {
      EXPECT_EQ(row.at("finite"), 1.0);
      EXPECT_EQ(row.at("frames"), 24.0);
      EXPECT_GT(number(row, "simulation_ms"), 0.0);
      EXPECT_GT(number(row, "memory_bytes"), 0.0);
    }
  }
  // In the drop, contacts move single nodes: no smooth motion, and nothing for quadratic skinning to gain. Nor is there
  // in cages that fuse parts which the reference does not.
  for (const char* name : {"sag", "twist"}) {
    const auto linear = rowsOf(sceneOf(json, name), "linear", "calibrated");
    const auto quadratic = rowsOf(sceneOf(json, name), "quadratic", "calibrated");
    ASSERT_EQ(quadratic.size(), linear.size());
    for (std::size_t k = 0; k < linear.size(); ++k) {
      EXPECT_LT(number(quadratic[k], "error_embedding_rms"), number(linear[k], "error_embedding_rms")) << name << k;
    }
  }
}

TEST_F(ErrorVsTime, TellsApartWhatSplittingFillAndCalibrationDo) {
  const CommandResult result = run({"--quick", "--scene", "sag", "--tets", "1000", "--cages", "all", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_LT(number(json.at("reference"), "stiffness_factor"), 1.0);
  EXPECT_NE(result.out.find(", calibrated (stiffness times 0."), std::string::npos) << result.out;
  const auto& scene = json.at("scenes").at(0);
  const auto row = [&](const char* kind) {
    const auto rows = rowsOf(scene, "linear", kind);
    EXPECT_FALSE(rows.empty()) << kind;
    return rows.at(0);
  };
  for (const report::CageKind kind : report::kCageKinds) {
    const auto one = row(nameOf(kind));
    EXPECT_EQ(number(one, "finite"), 1.0) << nameOf(kind);
    EXPECT_EQ(number(one, "copies") > 0.0, isSplit(kind)) << nameOf(kind);
    EXPECT_EQ(number(one, "stiffness_factor") < 1.0, isCalibrated(kind)) << nameOf(kind);
    EXPECT_EQ(number(one, "calibration_left") > 0.0, isCalibrated(kind)) << nameOf(kind);
    EXPECT_EQ(number(one, "calibrate_ms") > 0.0, isCalibrated(kind)) << nameOf(kind);
    EXPECT_GT(number(one, "error_total_rms"), number(one, "error_embedding_rms")) << nameOf(kind);
    const bool both = kind == report::CageKind::Same || kind == report::CageKind::Calibrated;
    EXPECT_EQ(rowsOf(scene, "quadratic", nameOf(kind)).empty(), !both) << nameOf(kind);
  }
  EXPECT_LT(number(row("same_calibrated"), "error_total_rms"), 0.6 * number(row("same"), "error_total_rms"));
  EXPECT_LT(number(row("calibrated"), "error_total_rms"), 0.6 * number(row("same_calibrated"), "error_total_rms"));
}

/// Of cages that fuse the prongs, no softening makes prongs.
TEST_F(ErrorVsTime, SplitCagesHaveTheProngsThatOthersFuse) {
  const CommandResult result =
      run({"--quick", "--quiet", "--model", "slotted_beam", "--scene", "sag", "--tets", "3000", "--cages",
           "calibrated,same_calibrated", "--interpolation", "linear", "--frames", "36", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(json.at("reference").at("from"), "formula");
  const auto fused = rowsOf(json.at("scenes").at(0), "linear", "same_calibrated");
  const auto split = rowsOf(json.at("scenes").at(0), "linear", "calibrated");
  ASSERT_EQ(fused.size(), 1u);
  ASSERT_EQ(split.size(), 1u);
  EXPECT_LT(number(split[0], "error_total_rms"), 0.7 * number(fused[0], "error_total_rms"));
  EXPECT_LT(number(split[0], "error_embedding_rms"), 0.3 * number(fused[0], "error_embedding_rms"));
}

TEST_F(ErrorVsTime, KeepsWhatItMeasuredOfEachKindOfCages) {
  const auto rows = [&](const std::string& cages) {
    EXPECT_EQ(run(small("sag", {"--cages", cages, "--interpolation", "linear"})).status, 0);
    const auto json = folder.json("out/error_vs_time.json");
    std::vector<nlohmann::json> all;
    for (const auto& row : json.at("scenes").at(0).at("rows")) {
      if (row.at("interpolation") == "linear") all.push_back(row);
    }
    return all;
  };
  const auto same = rows("same"), filled = rows("filled"), again = rows("same");
  ASSERT_EQ(same.size(), 2u);
  ASSERT_EQ(filled.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(same[k].at("material"), "same");
    EXPECT_EQ(filled[k].at("material"), "filled");
    EXPECT_NE(same[k].at("error_total_rms"), filled[k].at("error_total_rms"));
    EXPECT_EQ(same[k].at("simulation_ms"), again[k].at("simulation_ms"));  // to the bit: not measured again
  }
}

TEST_F(ErrorVsTime, WritesTheSameRowsAsCsvJsonAndColouredMesh) {
  ASSERT_EQ(run(small("sag")).status, 0);
  std::istringstream csv(folder.read("out/error_vs_time.csv"));
  std::string header, line;
  std::getline(csv, header);
  for (const char* column :
       {"error_total_rms", "error_total_max", "error_embedding_rms", "error_simulation_rms", "normal_error_mean_deg",
        "simulation_ms", "skin_us", "total_ms", "attach_ms", "speedup", "memory_bytes"}) {
    EXPECT_NE((header + ",").find(std::string(",") + column + ","), std::string::npos) << column;
  }
  std::size_t lines = 0;
  while (std::getline(csv, line)) {
    ++lines;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ',')) << line;
  }
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(lines, json.at("scenes").at(0).at("rows").size());
  const std::string ply = folder.read("out/error_sag_explicit.ply");
  EXPECT_EQ(ply.rfind("ply\n", 0), 0u);
  EXPECT_NE(ply.find("element vertex " + std::to_string(json.at("vertices").get<int>())), std::string::npos);
}

TEST_F(ErrorVsTime, SaysWhatItNeedsForTablesAndPlots) {
  std::vector<std::string> arguments = small("exact", {"--target-error", "0.5"});
  arguments.erase(arguments.begin() + 1);  // --quiet
  const CommandResult result = run(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 2) << result.out;
  for (const char* word :
       {"python3-matplotlib", "python3 " TETSKIN_PLOTS "/error_vs_time.py out/error_vs_time.json out",
        "--target-error 0.5"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
  }
  EXPECT_FALSE(folder.exists("out/error_vs_time.md"));
  const CommandResult quiet = run(small("exact"));
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out, "");
}

#ifdef TETSKIN_PYTHON
TEST_F(ErrorVsTime, APlotProgramThatFailsIsAWarning) {
  const CommandResult result = runWith("", small("exact"));
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("tables or plots are missing"), std::string::npos) << result.err;
}

TEST_F(ErrorVsTime, HasTablesAndPlotsMade) {
  std::vector<std::string> arguments = small("sag,exact", {"--target-error", "0.5"});
  arguments.erase(arguments.begin() + 1);  // --quiet
  const CommandResult result = folder.run(TETSKIN_ERROR_VS_TIME, arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string tables = folder.read("out/error_vs_time.md");
  EXPECT_NE(result.out.find(tables), std::string::npos) << result.out;
  for (const char* words : {"# Error against run time: serpent", "## sag, explicit", "## exact", "| reference |",
                            "The reference itself is wrong by about", "- quadratic: ", "calibrated**",
                            "theory's orders are 2 (linear) and 3 (quadratic)", "Cheapest below an error of 0.5: "}) {
    EXPECT_NE(tables.find(words), std::string::npos) << words << tables;
  }
  for (const char* name : {"sag_explicit", "sag_explicit_frames", "exact"}) {
    for (const char* ending : {".png", ".svg"}) {
      EXPECT_TRUE(folder.exists("out/" + std::string(name) + ending)) << name << ending;
    }
  }
  // By hand: without the surface, elsewhere, and with an error that nothing reaches.
  const CommandResult drawn =
      folder.run(TETSKIN_PYTHON, {TETSKIN_PLOTS "/error_vs_time.py", "out/error_vs_time.json", "plots", "--no-surface",
                                  "--quiet", "--target-error", "1e-9"});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(drawn.out, "");
  EXPECT_TRUE(folder.exists("plots/exact.png"));
  EXPECT_NE(folder.read("plots/error_vs_time.md").find("No setting stays below an error of 1e-09."), std::string::npos);
}
#endif

TEST_F(ErrorVsTime, TwoRunsGiveTheSameErrors) {
  ASSERT_EQ(run(small("drop", {}, "first")).status, 0);
  ASSERT_EQ(run(small("drop", {}, "second")).status, 0);
  const auto first = folder.json("first/error_vs_time.json"), second = folder.json("second/error_vs_time.json");
  const auto &a = first.at("scenes").at(0).at("rows"), &b = second.at("scenes").at(0).at("rows");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (const char* error : {"error_total_rms", "error_embedding_rms", "error_simulation_rms"}) {
      EXPECT_NEAR(number(a[k], error), number(b[k], error), 1e-6);
    }
  }
}

TEST_F(ErrorVsTime, GoesOnWhereItStopped) {
  ASSERT_EQ(run(small("sag")).status, 0);
  const auto before = folder.json("out/error_vs_time.json");
  // As if it had been stopped before its last cage.
  std::filesystem::path last;
  for (const auto& file : std::filesystem::directory_iterator(folder.path("out/rows"))) {
    if (file.path().extension() != ".json") continue;
    if (last.empty() || file.last_write_time() > std::filesystem::last_write_time(last)) last = file.path();
  }
  std::filesystem::remove(last);
  ASSERT_EQ(run(small("sag")).status, 0);
  const auto after = folder.json("out/error_vs_time.json");
  const auto &a = before.at("scenes").at(0).at("rows"), &b = after.at("scenes").at(0).at("rows");
  ASSERT_EQ(a.size(), b.size());
  std::size_t sameTimes = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(number(a[k], "error_total_rms"), number(b[k], "error_total_rms"), 1e-9);
    sameTimes += a[k].at("simulation_ms") == b[k].at("simulation_ms");  // to the bit: not measured again
  }
  EXPECT_GE(sameTimes, a.size() - 2);
  EXPECT_LT(sameTimes, a.size());
}

TEST_F(ErrorVsTime, MeasuresAnewWhatAnotherBuildHasLeft) {
  // A program of other bytes that does the same.
  std::filesystem::copy(TETSKIN_ERROR_VS_TIME, folder.path("changed"));
  std::ofstream(folder.path("changed"), std::ios::app | std::ios::binary) << "another build";
  const auto times = [&](const std::string& program) {
    EXPECT_EQ(runWith("raise ImportError", small("sag"), program).status, 0);
    std::vector<double> all;
    const auto json = folder.json("out/error_vs_time.json");
    for (const auto& row : json.at("scenes").at(0).at("rows")) all.push_back(number(row, "simulation_ms"));
    return all;
  };
  const auto first = times(TETSKIN_ERROR_VS_TIME);
  EXPECT_EQ(times(TETSKIN_ERROR_VS_TIME), first);
  const auto changed = times(folder.path("changed"));
  ASSERT_EQ(changed.size(), first.size());
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_NE(changed[k], first[k]) << k;
  EXPECT_EQ(times(TETSKIN_ERROR_VS_TIME), first) << "each build keeps its own";
}

TEST_F(ErrorVsTime, TakesAnySceneOfTheTable) {
  ASSERT_EQ(run(small("float", {"--no-calibration", "--interpolation", "linear"})).status, 0);
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(json.at("scenes").at(0).at("scene"), "float");
  for (const auto& row : json.at("scenes").at(0).at("rows")) EXPECT_LT(number(row, "error_simulation_rms"), 1e-6);
}

TEST_F(ErrorVsTime, ComparesWithBothReferencesUnlessBulletsForcesAreAsked) {
  std::vector<std::string> arguments = small("sag", {"--no-calibration"});
  ASSERT_EQ(run(arguments).status, 0);
  const auto bullets = folder.json("out/error_vs_time.json");
  EXPECT_EQ(bullets.at("scenes").at(0).at("integrator"), "explicit");
  EXPECT_EQ(rowsOf(bullets.at("scenes").at(0), "reference").size(), 1u);
  for (const auto& row : bullets.at("scenes").at(0).at("rows")) EXPECT_EQ(number(row, "speedup_against_bullet"), 0.0);

  *std::find(arguments.begin(), arguments.end(), "bullet") = "tetskin";
  ASSERT_EQ(run(arguments).status, 0);
  const auto ours = folder.json("out/error_vs_time.json");
  EXPECT_EQ(ours.at("scenes").at(0).at("integrator"), "tetskin");
  const auto references = rowsOf(ours.at("scenes").at(0), "reference");
  ASSERT_EQ(references.size(), 2u);
  EXPECT_EQ(ours.at("scenes").at(0).at("rows").at(0).at("integrator"), "tetskin");
  EXPECT_EQ(ours.at("scenes").at(0).at("rows").at(1).at("integrator"), "explicit");
  expectRefused(run({"--implicit", "--quick"}), "--force bullet");
  expectRefused(run({"--force", "havok"}), "--force");
}

TEST_F(ErrorVsTime, ImplicitRowsStandBesideTheOthers) {
  ASSERT_EQ(run(small("sag", {"--implicit", "--interpolation", "quadratic", "--no-calibration"})).status, 0);
  const auto json = folder.json("out/error_vs_time.json");
  ASSERT_EQ(json.at("scenes").size(), 2u);
  EXPECT_EQ(json.at("scenes").at(1).at("integrator"), "implicit");
  for (const auto& row : json.at("scenes").at(1).at("rows")) {
    EXPECT_TRUE(row.at("interpolation") == "quadratic" || row.at("interpolation") == "reference");
    EXPECT_EQ(row.at("material"), "same");
  }
}

TEST_F(ErrorVsTime, TakesAMeshOfTheUsersInItsOwnUnit) {
  folder.write("box.obj",
               "v 0 0 0\nv 400 0 0\nv 400 900 0\nv 0 900 0\nv 0 0 300\nv 400 0 300\nv 400 900 300\nv 0 900 300\n"
               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const CommandResult result = run({"--quick", "--quiet", "--scene", "exact", "--mesh", "box.obj", "--tets", "300",
                                    "--reference-tets", "900", "--frames", "6", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(json.at("model"), "box.obj");
  EXPECT_NEAR(number(json.at("scenes").at(0).at("rows").at(0), "box_diagonal_which_is_the_unit_of_errors_and_edge"),
              std::sqrt(400.0 * 400 + 900 * 900 + 300 * 300), 1e-6);
}

/// A cage for a built-in model, as a user makes one.
void buildReference(const CommandFolder& folder, const std::string& model, const std::string& tets,
                    const std::string& file) {
  const CommandResult result =
      folder.run(TETSKIN_CAGE, {"--model", model, "--triangles", "4000", "--tets", tets, "--quiet", "-o", file});
  ASSERT_EQ(result.status, 0) << result.err;
}

TEST_F(ErrorVsTime, TakesTheTetsThatABuiltInModelComesWith) {
  const std::vector<std::string> arguments = {"--model",          "slotted_beam", "--triangles", "2000",
                                              "--scene",          "sag",          "--tets",      "300",
                                              "--no-calibration", "--frames",     "3",           "--interpolation",
                                              "linear",           "--force",      "bullet"};
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
  EXPECT_EQ(number(rowsOf(json.at("scenes").at(0), "reference").at(0), "tets"), number(json.at("reference"), "tets"));
  // Fused cages do not approach it: none is built to estimate its error.
  EXPECT_EQ(json.at("scenes").at(0).at("reference_error"), 0.0);
  EXPECT_EQ(json.at("scenes").at(0).at("rows").size(), 2u);

  const CommandResult few = with("1000");
  ASSERT_EQ(few.status, 0) << few.err;
  EXPECT_NE(few.out.find("a built cage of about 1000 tets"), std::string::npos) << few.out;
  EXPECT_EQ(folder.json("out/error_vs_time.json").at("reference").at("from"), "built");
}

TEST_F(ErrorVsTime, TakesAReferenceFromAFile) {
  const std::vector<std::string> arguments = {"--model",
                                              "bar",
                                              "--triangles",
                                              "4000",
                                              "--scene",
                                              "sag",
                                              "--tets",
                                              "300",
                                              "--no-calibration",
                                              "--force",
                                              "bullet",
                                              "--frames",
                                              "3",
                                              "--interpolation",
                                              "linear",
                                              "--reference",
                                              "r.vtk",
                                              "--out",
                                              "out"};
  std::vector<double> errors;
  for (const char* tets : {"1500", "2500"}) {  // the same name, another reference: nothing stored may be taken
    buildReference(folder, "bar", tets, "r.vtk");
    const CommandResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("tets of r.vtk"), std::string::npos) << result.out;
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

TEST_F(ErrorVsTime, RefusesAReferenceThatItCannotTake) {
  buildReference(folder, "bar", "1500", "bar.vtk");
  expectRefused(run({"--reference", "nowhere.vtk"}), "nowhere.vtk");
  expectRefused(run({"--reference", "bar.vtk", "--reference-tets", "9000"}), "--reference-tets");
  expectRefused(run({"--reference", "bar.vtk", "--full"}), "--full");
  expectRefused(run({"--model", "bar", "--reference", "bar.vtk", "--tets", "3000"}), "fewer tets");
  expectRefused(run({"--triangles", "4000", "--reference", "bar.vtk", "--tets", "300"}), "bar.vtk");
  folder.write("broken.vtk", "no tets");
  expectRefused(run({"--reference", "broken.vtk"}), "broken.vtk");
}

TEST_F(ErrorVsTime, RefusesBadInput) {
  expectRefused(run({"--mesh", "nowhere.obj"}), "nowhere.obj");
  for (const scenes::SceneEntry& entry : scenes::sceneTable()) expectRefused(run({"--scene", "fly"}), entry.name);
  expectRefused(run({"--tets", "0"}), "--tets");
  expectRefused(run({"--tets", "3000", "--reference-tets", "3000"}), "reference");
  expectRefused(run({"--target-error", "-1"}), "--target-error");
  expectRefused(run({"--full", "--quick"}), "--full");
  for (const report::CageKind kind : report::kCageKinds) {
    expectRefused(run({"--cages", "same,solid"}), nameOf(kind));
  }
  expectRefused(run({"--cages", "calibrated", "--no-calibration"}), "--no-calibration");
  folder.write("file", "");
  expectRefused(run({"--quick", "--out", "file"}), "file");
}

}  // namespace
}  // namespace tetskin
