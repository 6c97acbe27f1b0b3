// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "full_disk.h"
#include "temp_folder.h"

#include <tetskin/io/src/text/atomic_file.h>

#include <filesystem>
#ifndef _WIN32
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace tetskin::io {
namespace {

using test::expectError;
using test::TempFolder;

TEST(WriteFile, ReplacesTheFileAndLeavesNothingElse) {
  const TempFolder folder;
  const std::string path = folder.write("a.txt", "a long text that was there before");
  ASSERT_TRUE(writeFile(path, "new").ok());
  EXPECT_EQ(TempFolder::read(path), "new");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteFile, NamesAFolderThatDoesNotExist) {
  const TempFolder folder;
  const std::string path = folder.path("missing/a.txt");
  expectError(writeFile(path, "new"), StatusCode::FileNotWritable, {path, "check that its folder exists"});
}

TEST(WriteFile, RefusesAFolder) {
  const TempFolder folder;
  expectError(writeFile(folder.path(), "new"), StatusCode::FileNotWritable, {folder.path(), "is a folder"});
}

#ifndef _WIN32  // links need a right there, and neither these pipes nor this limit exist
TEST(WriteFile, WritesThroughASymbolicLink) {
  const TempFolder folder;
  const std::string target = folder.write("target.txt", "old");
  const std::string link = folder.path("link.txt");
  std::filesystem::create_symlink(target, link);
  ASSERT_TRUE(writeFile(link, "new").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(TempFolder::read(target), "new");
}

TEST(WriteFile, WritesIntoAPipeWithoutReplacingIt) {
  const TempFolder folder;
  const std::string path = folder.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(writeFile(path, "new").ok());
  char text[8] = {};
  EXPECT_EQ(read(reader, text, sizeof(text)), 3);
  EXPECT_STREQ(text, "new");
  close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(WriteFile, KeepsTheOldFileIfTheNewOneDoesNotFit) {
  const TempFolder folder;
  const std::string path = folder.write("a.txt", "old");
  const Status status = test::onAFullDisk(1000, [&] { return writeFile(path, std::string(5000, 'x')); });
  expectError(status, StatusCode::FileNotWritable, {path, "cannot be written"});
  EXPECT_EQ(TempFolder::read(path), "old");
  EXPECT_EQ(folder.fileCount(), 1u);
}
#endif

}  // namespace
}  // namespace tetskin::io
