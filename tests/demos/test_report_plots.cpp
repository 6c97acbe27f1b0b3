// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <filesystem>
#include <fstream>

#include "error_vs_time_run.h"

namespace tetskin::test {
namespace {

class ReportPlots : public ErrorVsTimeRun {};

TEST_F(ReportPlots, SaysWhatItNeedsForTablesAndPlots) {
  std::vector<std::string> arguments = small("exact", {"--target-error", "0.5"});
  arguments.erase(arguments.begin() + 1);  // removes --quiet
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
TEST_F(ReportPlots, APlotProgramThatFailsIsAWarning) {
  const CommandResult result = runWith("", small("exact"));
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("tables or plots are missing"), std::string::npos) << result.err;
}

TEST_F(ReportPlots, HasTablesAndPlotsMade) {
  std::vector<std::string> arguments = small("sag,exact", {"--target-error", "0.5"});
  arguments.erase(arguments.begin() + 1);  // removes --quiet
  const CommandResult result = folder.run(TETSKIN_ERROR_VS_TIME, arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string tables = folder.read("out/error_vs_time.md");
  EXPECT_NE(result.out.find(tables), std::string::npos) << result.out;
  for (const char* words :
       {"# Error against run time: serpent", "## sag, tetskin", "## exact", "| the reference's tets | 4 |",
        "| reference | 16 |", "The error of the reference itself in space is about",
        "The error of the reference itself in time is about", "linear, calibrated, 1 substep: ", "calibrated**",
        "Cheapest setting with an error below 0.5: "}) {
    EXPECT_NE(tables.find(words), std::string::npos) << words << tables;
  }
  for (const char* name : {"sag_tetskin", "sag_tetskin_frames", "sag_tetskin_substeps", "exact"}) {
    for (const char* ending : {".png", ".svg"}) {
      EXPECT_TRUE(folder.exists("out/" + std::string(name) + ending)) << name << ending;
    }
  }
  // Plots drawn by hand: without the surface, in another folder, and with a target error that no cage reaches.
  const CommandResult drawn =
      folder.run(TETSKIN_PYTHON, {TETSKIN_PLOTS "/error_vs_time.py", "out/error_vs_time.json", "plots", "--no-surface",
                                  "--quiet", "--target-error", "1e-9"});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(drawn.out, "");
  EXPECT_TRUE(folder.exists("plots/exact.png"));
  EXPECT_NE(folder.read("plots/error_vs_time.md").find("No setting has an error below 1e-09."), std::string::npos);
}

TEST_F(ReportPlots, OneTableAndOnePlotCompareTheSolvers) {
  const CommandResult result =
      folder.run(TETSKIN_ERROR_VS_TIME,
                 {"--quick", "--solvers", "tetskin,xpbd_unfitted,bullet_linear", "--tets", "300", "--reference-tets",
                  "1000", "--triangles", "2000", "--frames", "6", "--out", "out", "--bullet-substeps", "4"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string tables = folder.read("out/error_vs_time.md"), csv = folder.read("out/sag_solvers.csv");
  EXPECT_NE(result.out.find(tables), std::string::npos) << result.out;
  for (const char* row : {"\n| tetskin | ", "\n| XPBD, not fitted | ", "\n| Bullet linear, explicit | "})
    EXPECT_NE(tables.find(row), std::string::npos) << row << tables;
  EXPECT_EQ(csv.rfind("solver,tets,substeps,ms per frame,", 0), 0u) << csv;
  for (const char* row : {"\ntetskin,", "\nxpbd_unfitted,", "\nbullet_linear,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 + 2 + 1) << csv;
  EXPECT_TRUE(folder.exists("out/sag_solvers.png"));
}
#endif

}  // namespace
}  // namespace tetskin::test
