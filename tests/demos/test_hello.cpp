// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include "command.h"

namespace tetskin::test {
namespace {

TEST(Hello, RunsWithoutAnyFile) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_HELLO, {});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("20000 inside"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("frame 60"), std::string::npos) << result.out;
}

TEST(Attach, HangsAMeshOnABodyOfTetGensData) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_ATTACH, {});
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_NE(result.out.find("20000 inside"), std::string::npos) << result.out;
  // It hangs by its end: free fall would take it to -5.
  const std::size_t last = result.out.find("frame_0060.obj: lowest point at y = -");
  ASSERT_NE(last, std::string::npos) << result.out;
  EXPECT_LT(std::stod(result.out.substr(last + 37)), 3.0) << result.out;
  EXPECT_TRUE(folder.exists("out/attach/frame_0060.obj"));
  const CommandResult refused = folder.run(TETSKIN_ATTACH, {"none.obj", "none.node", "none.ele"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.out.find("none.obj: cannot be opened"), std::string::npos) << refused.out;
}

TEST(Hello, LinksOnlyWhatItUses) {
  const CommandFolder folder;
  const CommandResult libraries = folder.run("ldd", {TETSKIN_HELLO});
  ASSERT_EQ(libraries.status, 0);
  EXPECT_NE(libraries.out.find("libBulletSoftBody"), std::string::npos);
  EXPECT_EQ(libraries.out.find("assimp"), std::string::npos);
  const CommandResult symbols = folder.run("nm", {"-C", TETSKIN_HELLO});
  ASSERT_EQ(symbols.status, 0);
  EXPECT_NE(symbols.out.find("tetskin::SoftBodySkin::update"), std::string::npos);
  EXPECT_NE(symbols.out.find("tetskin::createCage"), std::string::npos);
  EXPECT_EQ(symbols.out.find("SoftContacts"), std::string::npos);
  EXPECT_EQ(symbols.out.find("loadMesh"), std::string::npos);
}

}  // namespace
}  // namespace tetskin::test
