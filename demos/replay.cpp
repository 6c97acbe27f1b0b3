// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays a run that a demo has recorded by --record: calls that demo with its arguments, and with --replay.
#include <tetskin/bullet/recorder.h>
#include <tetskin/tetskin.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>
#ifdef _WIN32
#include <process.h>
#else
#include <sys/wait.h>
#include <unistd.h>
#endif

#include "scenes/command_line.h"
#include "scenes/input_error.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct Call {
  std::string program, version;
  std::vector<std::string> arguments;
};

Call callOf(const std::string& file) {
  const Result<std::string> description = Replay::descriptionOf(file);
  require(description.status());
  const nlohmann::json made = nlohmann::json::parse(description.value(), nullptr, false);
  try {
    return {made.at("program"), made.at("tetskin"), made.at("arguments")};
  } catch (const nlohmann::json::exception&) {
    throw InputError(file +
                     ": was recorded by another program than a demo; build its world, and play it by tetskin::Replay");
  }
}

/// Runs a program; returns its exit status.
int runProgram(const std::string& path, const std::vector<std::string>& arguments) {
  std::vector<char*> raw;
  raw.push_back(const_cast<char*>(path.c_str()));
  for (const std::string& argument : arguments) raw.push_back(const_cast<char*>(argument.c_str()));
  raw.push_back(nullptr);
  std::fflush(stdout);
#ifdef _WIN32
  const std::intptr_t status = _spawnv(_P_WAIT, path.c_str(), raw.data());
  if (status < 0) throw InputError(path + ": cannot be run; build the demos");
  return static_cast<int>(status);
#else
  const pid_t child = fork();
  if (child == 0) {
    execv(path.c_str(), raw.data());
    std::_Exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return kRunFailed;
  if (WEXITSTATUS(status) == 127) throw InputError(path + ": cannot be run; build the demos");
  return WEXITSTATUS(status);
#endif
}

int replay(const std::string& folder, const std::string& file, bool quiet) {
  const Call call = callOf(file);
  const std::filesystem::path name = std::filesystem::path(call.program).filename();  // never one from elsewhere
  if (name.string().rfind("tetskin_", 0) != 0) throw InputError(file + ": names no demo");
  std::vector<std::string> arguments = call.arguments;
  std::string line = call.program;
  for (const std::string& argument : arguments) line += " " + argument;
  if (!quiet) std::printf("%s\n", line.c_str());
  if (call.version != TETSKIN_VERSION) {
    std::printf("recorded with tetskin %s, played with %s: steps may differ\n", call.version.c_str(), TETSKIN_VERSION);
  }
  arguments.insert(arguments.end(), {"--replay", file});
  if (quiet) arguments.emplace_back("--quiet");
  return runProgram((std::filesystem::path(folder) / name).string(), arguments);
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  bool quiet = false;
  CommandLine line(
      "Plays a run again that a demo has recorded by --record, and says the first step that differs, and in "
      "which body.",
      {{{"tetskin_drop --record drop.replay", "records"}, {"tetskin_replay drop.replay", "plays, in its folder"}},
       "a step differs from the recorded one, or the run failed"});
  line.addInput("file,--file", file, "The recorded run", CommandLine::Need::Required);
  line.addQuietOption(quiet);
  return line.run(argc, argv,
                  [&] { return replay(std::filesystem::absolute(argv[0]).parent_path().string(), file, quiet); });
}
