// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/plot_program.h"

#include <cstdio>
#include <filesystem>

#include "scenes/files.h"
#include "scenes/system.h"

namespace tetskin::report {
namespace {

constexpr const char* kProgram = TETSKIN_PLOTS "/error_vs_time.py";

/// The first Python with matplotlib: the one in the path may differ from the system's, which has the package.
std::string pythonWithMatplotlib() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (scenes::runCommand({python, "-c", "import matplotlib"}, true) == 0) return python;
  }
  return {};
}

}  // namespace

void makeTablesAndPlots(const ReportOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.json, error)) return;  // a pipe: its reader has the results
  std::vector<std::string> command = {pythonWithMatplotlib(),           kProgram, options.json, options.out, "--tets",
                                      std::to_string(options.shownTets)};
  if (options.targetError > 0.0) {
    std::string target;
    scenes::appendNumber(target, options.targetError);
    command.insert(command.end(), {"--target-error", target});
  }
  if (options.quiet) command.emplace_back("--quiet");
  if (command.front().empty()) {
    if (options.quiet) return;
    command.front() =
        "Tables and plots are not made: they need Python with matplotlib (python3-matplotlib). To make them: python3";
    for (const std::string& word : command) std::printf("%s%c", word.c_str(), &word == &command.back() ? '\n' : ' ');
    return;
  }
  std::fflush(stdout);
  if (scenes::runCommand(command) != 0)
    std::fprintf(stderr, "tetskin_error_vs_time: warning: %s failed; tables or plots are missing\n", kProgram);
}

}  // namespace tetskin::report
