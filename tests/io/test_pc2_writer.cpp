// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "full_disk.h"
#include "temp_folder.h"

#include <tetskin/io/animation.h>

#include <cstring>
#include <filesystem>
#include <limits>

namespace tetskin::test {
namespace {

const std::vector<Eigen::Vector3f> kFloats = {{0.1f, -2.0f, 3.5f}, {1e18f, 1e-45f, -0.0f}};
const std::vector<Eigen::Vector3d> kDoubles = {{1.0 / 3.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};

Pc2Writer pc2WriterOf(const std::string& path) {
  Result<Pc2Writer> writer = Pc2Writer::create(path, 2, 1.0f, 10.0f);
  EXPECT_TRUE(writer.ok()) << writer.status().message;
  return std::move(writer).value();
}

template <class Number>
Number numberAt(const std::string& bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

TEST(Pc2Writer, WritesAHeaderOf32BytesAndAllPositionsAsFloats) {
  const TempFolder folder;
  const std::string path = folder.path("a.pc2");
  Pc2Writer writer = pc2WriterOf(path);
  ASSERT_TRUE(writer.addFrame(viewOf(kFloats)).ok());
  ASSERT_TRUE(writer.addFrame(viewOf(kDoubles)).ok());
  EXPECT_FALSE(std::filesystem::exists(path)) << "it has its name when it is complete";
  ASSERT_TRUE(writer.finish().ok());
  EXPECT_EQ(folder.fileCount(), 1u);

  const std::string bytes = TempFolder::read(path);
  ASSERT_EQ(bytes.size(), 32u + 2u * 2u * 12u);
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(numberAt<std::int32_t>(bytes, 12), 1) << "version";
  EXPECT_EQ(numberAt<std::int32_t>(bytes, 16), 2) << "vertices";
  EXPECT_EQ(numberAt<float>(bytes, 20), 1.0f) << "first frame";
  EXPECT_EQ(numberAt<float>(bytes, 24), 10.0f) << "step";
  EXPECT_EQ(numberAt<std::int32_t>(bytes, 28), 2) << "frames";
  for (std::size_t v = 0; v < 2; ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      EXPECT_EQ(numberAt<float>(bytes, 32 + 12 * v + 4 * k), kFloats[v][i]);
      EXPECT_EQ(numberAt<float>(bytes, 56 + 12 * v + 4 * k), static_cast<float>(kDoubles[v][i]));
    }
  }
}

TEST(Pc2Writer, LeavesTheOldFileUntilTheNewOneIsComplete) {
  const TempFolder folder;
  const std::string path = folder.write("a.pc2", "old");
  {
    Pc2Writer abandoned = pc2WriterOf(path);
    ASSERT_TRUE(abandoned.addFrame(viewOf(kFloats)).ok());
  }
  EXPECT_EQ(TempFolder::read(path), "old");
#ifndef _WIN32
  Pc2Writer writer = pc2WriterOf(path);
  const Status status = onAFullDisk(40, [&] { return writer.addFrame(viewOf(kFloats)); });
  expectError(status, StatusCode::FileNotWritable, {path, "cannot be written"});
  EXPECT_EQ(TempFolder::read(path), "old");
#endif
  EXPECT_EQ(folder.fileCount(), 1u) << "no part of it stays";
}

TEST(Pc2Writer, RefusesWhatItCannotHold) {
  const TempFolder folder;
  Pc2Writer writer = pc2WriterOf(folder.path("a.pc2"));
  std::vector<Eigen::Vector3f> bad = kFloats;
  bad.pop_back();
  expectError(writer.addFrame(viewOf(std::as_const(bad))), kSizeMismatch, {"1 positions", "2 vertices"});
  bad = kFloats;
  bad[1].z() = std::numeric_limits<float>::infinity();
  expectError(writer.addFrame(viewOf(std::as_const(bad))), kNonFinite, {"vertex 1 in frame 0"});
  expectError(writer.finish(), StatusCode::Empty, {"a.pc2", "without frames"});
  EXPECT_EQ(folder.fileCount(), 0u);
#ifndef _WIN32
  expectError(Pc2Writer::create("/dev/null", 2), StatusCode::FileNotWritable, {"not a regular file"});
#endif
  expectError(Pc2Writer::create(folder.path("no/a.pc2"), 2), StatusCode::FileNotWritable, {"no/a.pc2"});
}

TEST(Pc2Writer, CallsAfterItsEndAreErrors) {
  const TempFolder folder;
  Pc2Writer writer = pc2WriterOf(folder.path("a.pc2"));
  ASSERT_TRUE(writer.addFrame(viewOf(kFloats)).ok());
  ASSERT_TRUE(writer.finish().ok());
  const std::string written = TempFolder::read(folder.path("a.pc2"));
  expectError(writer.addFrame(viewOf(kFloats)), StatusCode::FileNotWritable, {"finished", "another writer"});
  expectError(writer.finish(), StatusCode::FileNotWritable, {"finished"});
  EXPECT_EQ(TempFolder::read(folder.path("a.pc2")), written);
  Pc2Writer first = pc2WriterOf(folder.path("b.pc2"));
  Pc2Writer second = std::move(first);
  expectError(first.finish(), StatusCode::FileNotWritable, {"finished"});
  EXPECT_TRUE(second.addFrame(viewOf(kFloats)).ok());
}

}  // namespace
}  // namespace tetskin::test
