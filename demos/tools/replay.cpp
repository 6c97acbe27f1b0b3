// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays a run that a demo has recorded by --record: it calls that demo with its arguments, and with --replay.
#include <tetskin/replay/recorder.h>
#include <tetskin/tetskin.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/input_error.h"
#include "scenes/system.h"

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
    return Call{made.at("program"), made.at("tetskin"), made.at("arguments")};
  } catch (const nlohmann::json::exception&) {
    throw InputError(file +
                     ": was recorded by another program than a demo; build its world as that program does, and " +
                     "play the file by Replay::open(world, file)");
  }
}

int callDemo(const std::string& folder, const std::string& file, const Call& call, bool quiet) {
  const std::filesystem::path name = std::filesystem::path(call.program).filename();  // never one from elsewhere
  if (name.string().rfind("tetskin_", 0) != 0) throw InputError(file + ": names no demo");
  std::vector<std::string> command = {(std::filesystem::path(folder) / name).string()};
  command.insert(command.end(), call.arguments.begin(), call.arguments.end());
  if (!quiet) {
    std::printf("%s", call.program.c_str());
    for (const std::string& argument : call.arguments) std::printf(" %s", argument.c_str());
    std::printf("\n");
  }
  if (call.version != TETSKIN_VERSION) {
    std::printf("recorded with tetskin %s, played with %s: steps may differ\n", call.version.c_str(), TETSKIN_VERSION);
  }
  std::fflush(stdout);
  command.insert(command.end(), {"--replay", file});
  if (quiet) command.emplace_back("--quiet");
  const int status = runCommand(command);
  if (status < 0) throw InputError(command[0] + ": cannot be run; build the demos");
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  bool quiet = false;
  CommandLine line(
      "Plays a run again that a demo has recorded by --record, and says the first step that differs, and in which "
      "body.",
      {{{"tetskin_drop --record drop.replay", "records"}, {"tetskin_replay drop.replay", "plays, in its folder"}},
       "a step differs from the recorded one, or the run failed"});
  line.addInput("file,--file", file, "The recorded run", CommandLine::Need::Required);
  line.addQuietOption(quiet);
  return line.run(argc, argv, [&] {
    return callDemo(std::filesystem::absolute(argv[0]).parent_path().string(), file, callOf(file), quiet);
  });
}
