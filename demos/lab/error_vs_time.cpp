// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How accurate is a coarse cage with an embedded surface, and how fast is it? Compares cages of several sizes, in
// several numbers of substeps, with a fine one in many, in Bullet, and separates the errors in space and in time, and
// the coarse simulation's error from the embedding's.
#include <cstdio>

#include "report/plot_program.h"
#include "report/report.h"

using namespace tetskin;

int main(int argc, char** argv) {
  scenes::CommandLine line(
      "Compares cages of several sizes, each with the mesh's surface embedded, with a fine reference in Bullet's "
      "deformable world: the error of each, how much of it comes from the coarse simulation, from the length of its "
      "steps and from the embedding, and the run time. An interrupted run resumes where it stopped.",
      {{{"tetskin_error_vs_time --quick",
         "a small report: out/error_vs_time/error_vs_time.csv, .json, tables and plots"},
        {"tetskin_error_vs_time --mesh yours.obj --target-error 0.01",
         "the cage and the substeps that your mesh needs for an error of 1 %"},
        {"tetskin_error_vs_time --solvers all",
         "the solver beside hand-written XPBD and Bullet's own forces, all in the same cage"}},
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
    std::fprintf(stderr, "tetskin_error_vs_time: a simulation exploded; see the column 'finite'\n");
    return scenes::kRunFailed;
  });
}
