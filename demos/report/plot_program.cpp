// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/plot_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "scenes/files.h"

namespace tetskin::report {
namespace {

constexpr const char* kProgram = TETSKIN_PLOTS "/error_vs_time.py";

/// Runs a command found in the path, and waits for it; returns true if it succeeded.
bool run(const std::vector<std::string>& command, bool silent = false) {
  std::vector<char*> arguments(command.size() + 1);  // the last one null
  std::transform(command.begin(), command.end(), arguments.begin(),
                 [](const std::string& word) { return const_cast<char*>(word.c_str()); });
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {1, 2}) {
    if (silent) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0) return false;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The first Python with matplotlib: the one in the path may differ from the system's, which has the package.
std::string pythonWithMatplotlib() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (run({python, "-c", "import matplotlib"}, true)) return python;
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
  if (!run(command))
    std::fprintf(stderr, "tetskin_error_vs_time: warning: %s failed; tables or plots are missing\n", kProgram);
}

}  // namespace tetskin::report
