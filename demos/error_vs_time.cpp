// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How wrong is a coarse cage with an embedded surface, and how fast? Cages of several sizes against a fine one, in
// Bullet, with the coarse simulation's error and the embedding's told apart.
#include <cstdio>

#include "report/plot_program.h"
#include "report/report.h"

using namespace tetskin;

int main(int argc, char** argv) {
  scenes::CommandLine line(
      "Cages of several sizes, each with the mesh's surface embedded, against a fine cage, in Bullet's deformable "
      "world: how wrong each is, how much of that is the coarse simulation's and how much the embedding's, and what "
      "it costs. An interrupted run goes on where it stopped.",
      {{{"tetskin_error_vs_time --quick",
         "a small report: out/error_vs_time/error_vs_time.csv, .json, tables and plots"},
        {"tetskin_error_vs_time --mesh yours.obj --target-error 0.01",
         "which cage a mesh of yours needs for an error of 1 %"}},
       "a simulation exploded"});
  report::ReportCommandLine commandLine(line);
  return line.run(argc, argv, [&] {
    const report::ReportOptions& options = commandLine.finish();
    const report::ReportResult result = report::makeReport(options);
    if (!options.quiet) {
      std::printf("%s/error_vs_time.csv, %s; reference: %s\n", options.out.c_str(), options.json.c_str(),
                  describe(result.reference).c_str());
    }
    report::makeTablesAndPlots(options);
    if (report::allFinite(result)) return scenes::kDone;
    std::fprintf(stderr, "tetskin_error_vs_time: a simulation exploded; see the column finite\n");
    return scenes::kRunFailed;
  });
}
