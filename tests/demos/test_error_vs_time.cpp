// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <fstream>
#include <sstream>

#include "error_vs_time_run.h"
#include "report/cage_kind.h"
#include "scenes/table.h"

namespace tetskin::test {
namespace {

class ErrorVsTime : public ErrorVsTimeRun {};

/// The figures that the report promises, from one quick run of everything.
TEST_F(ErrorVsTime, QuickReportHoldsWhatItShould) {
  const CommandResult result = run({"--quick", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("1000/1000"), std::string::npos) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  ASSERT_EQ(json.at("scenes").size(), 4u);

  const auto& exact = sceneOf(json, "exact");
  EXPECT_GT(orderOf(rowsOf(exact, "linear"), "error_embedding_rms"), 1.8);
  EXPECT_GT(orderOf(rowsOf(exact, "quadratic"), "error_embedding_rms"), 2.7);
  for (const auto& row : exact.at("rows")) {
    EXPECT_EQ(row.at("error_simulation_rms"), 0.0);
    EXPECT_EQ(row.at("error_total_rms"), row.at("error_embedding_rms"));
  }

  for (const char* name : {"sag", "twist", "drop"}) {
    const auto& scene = sceneOf(json, name);
    EXPECT_GT(number(scene, "reference_error"), 0.0);
    EXPECT_GT(number(scene, "reference_time_error"), 0.0);
    EXPECT_EQ(rowsOf(scene, "reference").size(), 3u);
    for (const auto& row : rowsOf(scene, "quadratic")) {
      // Both references simulate the same body: their motions differ by far less than those of coarse cages do.
      EXPECT_NEAR(number(row, "error_against_bullet_rms"), number(row, "error_total_rms"),
                  0.3 * number(row, "error_total_rms") + number(scene, "reference_error"))
          << name;
      EXPECT_GT(number(row, "speedup_against_bullet"), 4.0 * number(row, "speedup")) << name;
    }
    EXPECT_EQ(usualRowsOf(scene, "linear", "calibrated").size(), 3u);
    EXPECT_EQ(rowsOf(scene, "linear", "calibrated").size(), 9u);
    const auto reduced = rowsOf(scene, "linear", "reduced");
    ASSERT_EQ(reduced.size(), std::string(name) == "twist" ? 0u : 4u) << name;
    for (const auto& row : reduced) {
      EXPECT_GE(number(row, "modes"), 1.0);
      EXPECT_GT(number(row, "modes_ms"), 0.0);
      EXPECT_LT(number(row, "error_total_rms"), 0.1) << name;
    }
    EXPECT_EQ(scene.at("reduction_advice").get<std::string>().empty(), reduced.empty());
    for (const char* interpolation : {"linear", "quadratic"}) {
      const auto rows = rowsOf(scene, interpolation);
      ASSERT_EQ(rows.size(), 3u);
      for (std::size_t k = 1; k < rows.size(); ++k) {
        for (const char* error : {"error_total_rms", "error_embedding_rms", "error_simulation_rms"}) {
          // What the small reference does not resolve need not fall.
          if (error != std::string("error_embedding_rms") && number(rows[k], "resolved") == 0.0) continue;
          EXPECT_LT(number(rows[k], error), number(rows[k - 1], error)) << name << " " << interpolation << " " << error;
        }
      }
    }
    for (const auto& row : scene.at("rows")) {
      EXPECT_EQ(row.at("finite"), 1.0);
      // The reference's own row has an estimate of its error in space, and no other error.
      if (row.at("interpolation") == "reference") continue;
      // Of three motions, the first and the last are no farther apart than by way of the second.
      const double space = number(row, "error_space_rms"), time = number(row, "error_time_rms");
      EXPECT_LE(number(row, "error_total_rms"), (1 + 1e-9) * (space + time)) << row;
      EXPECT_GE(number(row, "error_total_rms"), (1 - 1e-9) * std::abs(space - time)) << row;
      EXPECT_EQ(row.at("frames"), 24.0);
      EXPECT_GT(number(row, "simulation_ms"), 0.0);
      EXPECT_GT(number(row, "memory_bytes"), 0.0);
    }
  }
  // In the drop, contacts move single nodes: the motion is not smooth, so quadratic skinning gains nothing. Nor does it
  // gain in cages that fuse components which the reference keeps apart.
  for (const char* name : {"sag", "twist"}) {
    const auto linear = usualRowsOf(sceneOf(json, name), "linear", "calibrated");
    const auto quadratic = rowsOf(sceneOf(json, name), "quadratic", "calibrated");
    ASSERT_EQ(quadratic.size(), linear.size());
    for (std::size_t k = 0; k < linear.size(); ++k) {
      EXPECT_LT(number(quadratic[k], "error_embedding_rms"), number(linear[k], "error_embedding_rms")) << name << k;
    }
  }
}

/// Options for cages of one size in some numbers of substeps, in a scene with contact.
std::vector<std::string> inSubsteps(const std::string& substeps, const std::string& reference) {
  return test::words(
      "--quick --quiet --scenes drop --tets 300 --out out --reference-tets 1000 --triangles 2000 --interpolation "
      "linear "
      "--no-reduction --substeps " +
      substeps + " --reference-substeps " + reference);
}

TEST_F(ErrorVsTime, ErrorsInTimeVanishAtTheReferencesSubsteps) {
  ASSERT_EQ(run(inSubsteps("1,2,4,8,32", "32")).status, 0);
  const auto scene = folder.json("out/error_vs_time.json").at("scenes").at(0);
  const auto rows = rowsOf(scene, "linear", "calibrated");
  ASSERT_EQ(rows.size(), 5u);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    EXPECT_LT(number(rows[k], "error_time_rms"), 0.8 * number(rows[k - 1], "error_time_rms")) << rows[k];
    EXPECT_EQ(rows[k].at("error_space_rms"), rows[0].at("error_space_rms"));
    EXPECT_EQ(rows[k].at("error_embedding_rms"), rows[0].at("error_embedding_rms"));
  }
  EXPECT_GT(number(rows[0], "error_time_rms"), 1e-4);
  EXPECT_LT(number(rows[4], "error_time_rms"), 0.1 * number(rows[0], "error_time_rms"));
  EXPECT_GT(number(rows[4], "error_time_rms"), 0.0) << "the reference's solver leaves less";
  EXPECT_NEAR(number(rows[4], "error_total_rms") / number(rows[4], "error_space_rms"), 1.0, 1e-3);
  // Bare cages are simulated in the usual substeps only, the reference's tets in its own as well.
  EXPECT_EQ(rowsOf(scene, "linear").size(), 1u);
  const auto& references = scene.at("rows");
  EXPECT_EQ(references.at(0).at("substeps"), 4.0);
  EXPECT_GT(number(references.at(0), "error_time_rms"), 1e-4);
  EXPECT_EQ(references.at(0).at("speedup"), 1.0);
  EXPECT_EQ(references.at(1).at("substeps"), 32.0);
  EXPECT_EQ(references.at(1).at("error_total_rms"), 0.0);
}

TEST_F(ErrorVsTime, TellsApartWhatSplittingFillAndCalibrationDo) {
  const CommandResult result = run({"--quick", "--scenes", "sag", "--tets", "1000", "--cages", "all", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  const auto& scene = json.at("scenes").at(0);
  const auto row = [&](const char* kind) {
    const auto rows = usualRowsOf(scene, "linear", kind);
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
  const std::string ply = folder.read("out/error_sag_tetskin.ply");
  EXPECT_EQ(ply.rfind("ply\n", 0), 0u);
  EXPECT_NE(ply.find("element vertex " + std::to_string(json.at("vertices").get<int>())), std::string::npos);
}

TEST_F(ErrorVsTime, TakesAMeshOfTheUsersInItsOwnUnit) {
  folder.write("box.obj",
               "v 0 0 0\nv 400 0 0\nv 400 900 0\nv 0 900 0\nv 0 0 300\nv 400 0 300\nv 400 900 300\nv 0 900 300\n"
               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const CommandResult result = run({"--quick", "--quiet", "--scenes", "exact", "--mesh", "box.obj", "--tets", "300",
                                    "--reference-tets", "900", "--frames", "6", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/error_vs_time.json");
  EXPECT_EQ(json.at("model"), "box.obj");
  EXPECT_NEAR(number(json.at("scenes").at(0).at("rows").at(0), "box_diagonal_which_is_the_unit_of_errors_and_edge"),
              std::sqrt(400.0 * 400 + 900 * 900 + 300 * 300), 1e-6);
}

}  // namespace
}  // namespace tetskin::test
