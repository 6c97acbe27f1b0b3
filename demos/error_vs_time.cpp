// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How wrong is a coarse cage with an embedded surface, and how fast? Cages of several sizes against a fine one, in
// Bullet, with the coarse simulation's error and the embedding's told apart.
#include <cstdio>

#include "report/report.h"
#include "report/report_files.h"

namespace {

using namespace tetskin;

/// Prints what was found; false if a check did not hold.
bool tell(const report::ReportResult& result, const report::ReportOptions& options) {
  if (!options.quiet) {
    std::printf("%s\n", report::markdownOf(result, options.targetError).c_str());
    std::printf("%s/error_vs_time.csv, .md, %s\nPlots: python3 %s/error_vs_time.py %s\n", options.out.c_str(),
                options.json.c_str(), TETSKIN_PLOTS, options.json.c_str());
  }
  if (report::allFinite(result)) return true;
  std::fprintf(stderr, "tetskin_error_vs_time: a simulation exploded; see the column finite\n");
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Cages of several sizes, each with the mesh's surface embedded, against a fine cage, in Bullet's deformable "
      "world: how wrong each is, how much of that is the coarse simulation's and how much the embedding's, and what "
      "it costs. An interrupted run goes on where it stopped.");
  report::ReportCommandLine commandLine(app);
  return scenes::runDemo(app, argc, argv, [&] {
    const report::ReportOptions& options = commandLine.finish();
    return tell(report::makeReport(options), options) ? scenes::kDone : scenes::kRunFailed;
  });
}
