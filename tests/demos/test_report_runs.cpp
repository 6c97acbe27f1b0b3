// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "error_vs_time_run.h"

namespace tetskin {
namespace {

using test::number;

class ReportRuns : public test::ErrorVsTimeRun {};

TEST_F(ReportRuns, TwoRunsGiveTheSameErrors) {
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

TEST_F(ReportRuns, GoesOnWhereItStopped) {
  const std::vector<std::string> arguments = small("sag", {"--elasticity", "tetskin", "--no-reduction"});
  ASSERT_EQ(run(arguments).status, 0);
  const auto before = folder.json("out/error_vs_time.json");
  // This is the state after a run that was stopped before its last cage.
  std::filesystem::path last;
  for (const auto& file : std::filesystem::directory_iterator(folder.path("out/rows"))) {
    if (file.path().extension() != ".json") continue;
    if (last.empty() || file.last_write_time() > std::filesystem::last_write_time(last)) last = file.path();
  }
  std::filesystem::remove(last);
  ASSERT_EQ(run(arguments).status, 0);
  const auto after = folder.json("out/error_vs_time.json");
  const auto &a = before.at("scenes").at(0).at("rows"), &b = after.at("scenes").at(0).at("rows");
  ASSERT_EQ(a.size(), b.size());
  std::size_t sameTimes = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (const char* error : {"error_total_rms", "error_space_rms", "error_time_rms"})
      EXPECT_NEAR(number(a[k], error), number(b[k], error), 1e-9);
    sameTimes += a[k].at("simulation_ms") == b[k].at("simulation_ms");  // equal to the bit: not measured again
  }
  EXPECT_EQ(sameTimes, a.size() - 4) << "the last cage has three numbers of substeps, and two surfaces in one of them";
}

TEST_F(ReportRuns, MeasuresAnewWhatAnotherBuildHasLeft) {
  // A program with different bytes that does the same.
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

}  // namespace
}  // namespace tetskin
