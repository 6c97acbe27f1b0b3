// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Stiff and extreme cases, each run in Bullet with its forces or with the library's. Judges whether the simulation
// stays bounded, and whether the skin does what it promises.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "measure/report.h"
#include "scenes/input_error.h"
#include "stress/report.h"
#include "stress/run_case.h"

using namespace tetskin;
using namespace tetskin::scenes;
using namespace tetskin::stress;

namespace {

struct StressOptions {
  bool quick = false;
  bool lasting = false;
  bool hash = false;
  std::string force = "both";
  std::string only;
  measure::ReportOptions report;
};

bool isOfForce(const StressCase& stressCase, const std::string& whose) {
  return whose == "both" || isOurs(stressCase.force) == (whose == "tetskin");
}

std::vector<StressCase> chosenCases(const StressOptions& options) {
  std::vector<StressCase> cases = stressCases();
  const auto leftOut = [&](const StressCase& c) {
    return c.lasts != options.lasting || (options.quick && !c.quick) || !isOfForce(c, options.force) ||
           c.name.find(options.only) == std::string::npos;
  };
  cases.erase(std::remove_if(cases.begin(), cases.end(), leftOut), cases.end());
  if (cases.empty()) throw InputError("--only " + options.only + ": none of the selected cases has this in its name");
  return cases;
}

int run(const StressOptions& options) {
  const std::vector<StressCase> cases = chosenCases(options);
  std::vector<Row> rows;
  RowPrinter printer(options.hash);
  for (const StressCase& stressCase : cases) {
    rows.push_back({stressCase, runCase(stressCase)});
    if (!options.report.quiet) printer.print(rows.back());
  }
  const auto broken = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.verdict.passed(); });
  measure::write(options.report, toJson(rows), toMarkdown(rows));
  if (!options.report.quiet) {
    printMap(rows);
    const auto gained = std::count_if(rows.begin(), rows.end(),
                                      [&](const Row& row) { return bulletCannot(row, rows).value_or(false); });
    const auto unconverged =
        std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.verdict.solve.unconverged > 0; });
    std::printf(
        "\n%zu cases; %td failed; %td are stable with tetskin's elasticity but not with Bullet's; in %td, contact did "
        "not converge in some step\n",
        rows.size(), broken, gained, unconverged);
  }
  return broken == 0 ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  StressOptions options;
  CommandLine line("Runs stiff and extreme cases in Bullet, each with a verdict on the simulation and on the skin.",
                   {{{"tetskin_stress --quick", "a selection of the cases, as a table"},
                     {"tetskin_stress --only event/ --markdown stress.md",
                      "all that may happen to a body, and a file of the results"}},
                    "a case failed"});
  line.addFlag("--quick", options.quick, "about 20 s");
  line.addFlag("--long", options.lasting,
               "Run the long cases instead: one minute of simulated time each, and all claims (about 25 minutes)");
  line.addWord("--elasticity", options.force, {"both", "tetskin", "bullet"}, "both: all cases");
  line.addText("--only", options.only);
  line.addFlag("--hash", options.hash, "one per case");
  measure::addReportOptions(line, options.report);
  return line.run(argc, argv, [&] { return run(options); });
}
