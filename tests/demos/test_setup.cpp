// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs demos/run as on a machine that has nothing installed yet. Stand-ins for apt and CMake only record how they are
// called.

#include <filesystem>

#include "command.h"

namespace tetskin::test {
namespace {

class DemosRun : public testing::Test {
 protected:
  DemosRun() {
    std::filesystem::create_directory(folder.path("bin"));
    stub("apt-get", "");
    stub("dpkg-query", "exit 1\n");  // no package is installed
    stub("cmake", "exit 3\n");       // stops the script
    stub("sudo", "exec \"$@\"\n");
  }

  CommandResult run(const std::string& arguments) const {
    return folder.run("sh", {"-c", "PATH=" + folder.path("bin") + ":$PATH " TETSKIN_DEMOS_RUN " " + arguments});
  }
  std::string calls() const { return folder.exists("calls") ? folder.read("calls") : ""; }

  CommandFolder folder;

 private:
  void stub(const std::string& name, const std::string& end) const {
    const std::string program =
        folder.write("bin/" + name, "#!/bin/sh\necho " + name + " \"$@\" >>" + folder.path("calls") + "\n" + end);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  }
};

TEST_F(DemosRun, AnswersHelpAtOnce) {
  for (const char* arguments : {"--help", "-h", "--all --help", "--mesh yours.obj --help"}) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("./demos/run --all"), std::string::npos) << result.out;
  }
  EXPECT_EQ(calls(), "") << "nothing is installed, configured or built";
}

TEST_F(DemosRun, InstallsWhatTheDropNeedsAndNoMore) {
  EXPECT_EQ(run("").status, 3);
  EXPECT_NE(calls().find("libbullet-dev"), std::string::npos) << calls();
  EXPECT_NE(calls().find("libjs-three"), std::string::npos);
  for (const char* other : {"matplotlib", "benchmark", "gtest"}) EXPECT_EQ(calls().find(other), std::string::npos);
}

TEST_F(DemosRun, InstallsWhatAllDemosNeedForAll) {
  EXPECT_EQ(run("--all").status, 3);
  for (const char* name : {"libbullet-dev", "matplotlib", "benchmark"}) {
    EXPECT_NE(calls().find(name), std::string::npos) << calls();
  }
}

}  // namespace
}  // namespace tetskin::test
