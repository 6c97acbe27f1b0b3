// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Stiff and extreme cases, each run in Bullet with its forces or with the library's, and judged: does the simulation
// stay bounded, does the skin do what it promises.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"
#include "stress/report.h"
#include "stress/run_case.h"

using namespace tetskin;
using namespace tetskin::scenes;
using namespace tetskin::stress;

namespace {

struct StressOptions {
  bool quick = false;
  bool lasting = false;
  bool quiet = false;
  bool hash = false;
  std::string force;  ///< whose; empty: both
  std::string only;
  std::string json;
  std::string markdown;
};

bool isOfForce(const StressCase& stressCase, const std::string& whose) {
  return whose.empty() || isOurs(stressCase.force) == (whose == "tetskin");
}

std::vector<StressCase> chosenCases(const StressOptions& options) {
  std::vector<StressCase> cases = stressCases();
  const auto leftOut = [&](const StressCase& c) {
    return c.lasts != options.lasting || (options.quick && !c.quick) || !isOfForce(c, options.force) ||
           c.name.find(options.only) == std::string::npos;
  };
  cases.erase(std::remove_if(cases.begin(), cases.end(), leftOut), cases.end());
  if (cases.empty()) throw InputError("--only " + options.only + ": no case of those wished for has that in its name");
  return cases;
}

int run(const StressOptions& options) {
  const std::vector<StressCase> cases = chosenCases(options);
  std::vector<Row> rows;
  for (const StressCase& stressCase : cases) {
    rows.push_back({stressCase, runCase(stressCase)});
    if (!options.quiet) printRow(rows.back(), options.hash);
  }
  const auto broken = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.verdict.held(); });
  if (!options.json.empty()) writeJson(toJson(rows), options.json);
  if (!options.markdown.empty()) writeFile(options.markdown, toMarkdown(rows));
  if (!options.quiet) {
    printMap(rows);
    const auto gained = std::count_if(rows.begin(), rows.end(),
                                      [&](const Row& row) { return bulletCannot(row, rows).value_or(false); });
    const auto unconverged =
        std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.verdict.solve.unconverged > 0; });
    std::printf(
        "\n%zu cases, %td of which did not hold; %td that Bullet's force cannot hold and tetskin's can; %td in which "
        "contact did not converge in some step\n",
        rows.size(), broken, gained, unconverged);
  }
  return broken == 0 ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  StressOptions options;
  CommandLine line(
      "Stiff and extreme cases in Bullet, each with a verdict on the simulation and on the skin.",
      {{{"tetskin_stress --quick", "a part of the cases, as a table"},
        {"tetskin_stress --only event/ --markdown stress.md", "what may happen to a body, and a file of it"}},
       "a case did not hold"});
  line.addFlag("--quick", options.quick, "A part of the cases, in some 20 s");
  line.addFlag("--long", options.lasting,
               "Instead of all others the cases of a minute of simulated time, and all claims, in some 25 minutes");
  line.addWord("--force", options.force, {"bullet", "tetskin"},
               "Only the cases of Bullet's forces, or of tetskin's force and solver (default: both)");
  line.addText("--only", options.only, "Only the cases with this in their names");
  line.addFlag("--hash", options.hash, "Print of each case a hash of the nodes in all frames, which equal runs share");
  line.addSummaryOption(options.json, "File of the results, a list of cases");
  line.addOutput("--markdown", options.markdown, "File of the results, as tables");
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] { return run(options); });
}
