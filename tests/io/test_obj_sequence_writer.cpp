// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "temp_folder.h"

#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <filesystem>
#include <limits>

namespace tetskin::test {
namespace {

const std::string kModel =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\ng plate\nusemtl steel\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

/// A writer of the model above into the sub-folder "out/frames".
ObjSequenceWriter makeWriter(const TempFolder& folder, const std::string& baseName = "frame_") {
  Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", kModel));
  EXPECT_TRUE(layout.ok()) << layout.status().message;
  Result<ObjSequenceWriter> writer =
      ObjSequenceWriter::create(folder.path("out/frames"), std::move(layout).value(), baseName);
  EXPECT_TRUE(writer.ok()) << writer.status().message;
  return std::move(writer).value();
}

const std::vector<Eigen::Vector3d> kAwkwardPositions = {
    {0.1, 1.0 / 3.0, -1e-300}, {1e18, 2, 3}, {-0.0, 5e-324, 7}, {123456.789, 8, 9.9999999999999987e17}};

TEST(ObjSequenceWriter, NumbersFramesWithFourDigitsOrMore) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder, "dragon.");
  ASSERT_TRUE(writer.write(0, viewOf(kAwkwardPositions)).ok());
  ASSERT_TRUE(writer.write(12345, viewOf(kAwkwardPositions)).ok());
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/frames/dragon.0000.obj")));
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/frames/dragon.12345.obj")));
  EXPECT_EQ(writer.framePath(7), folder.path("out/frames/dragon.0007.obj"));
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("out/frames"))) entries += entry.exists();
  EXPECT_EQ(entries, 2u);
}

TEST(ObjSequenceWriter, DoublePositionsReadBackExactly) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  ASSERT_TRUE(writer.write(1, viewOf(kAwkwardPositions)).ok());
  const Result<TriangleMesh> back = loadMesh(writer.framePath(1));
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_EQ(back.value().positions, kAwkwardPositions);
  EXPECT_TRUE(std::signbit(back.value().positions[2][0]));
}

TEST(ObjSequenceWriter, FloatPositionsReadBackExactlyAndShort) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  const std::vector<Eigen::Vector3f> floats = {
      {0.1f, 1.0f / 3.0f, 1e-45f}, {9.9999998e17f, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  ASSERT_TRUE(writer.write(1, viewOf(floats)).ok());
  EXPECT_EQ(TempFolder::read(writer.framePath(1)).substr(0, 23), "v 0.1 0.33333334 1e-45\n");
  const TriangleMesh back = loadMesh(writer.framePath(1)).value();
  ASSERT_EQ(back.vertexCount(), floats.size());
  for (std::size_t v = 0; v < floats.size(); ++v) EXPECT_EQ(back.positions[v].cast<float>(), floats[v]);
}

TEST(ObjSequenceWriter, FramesKeepTrianglesTexcoordsAndGroups) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  const TriangleMesh rest = loadMesh(folder.path("m.obj")).value();
  ASSERT_TRUE(writer.write(3, viewOf(rest.positions)).ok());
  const TriangleMesh frame = loadMesh(writer.framePath(3)).value();
  EXPECT_EQ(frame.positions, rest.positions);
  EXPECT_EQ(frame.triangles, rest.triangles);
  EXPECT_EQ(frame.texcoords, rest.texcoords);
  EXPECT_EQ(frame.texcoords.size(), 4u);
  EXPECT_TRUE(frame.normals.empty());
  ASSERT_EQ(frame.groups.size(), 1u);
  EXPECT_EQ(frame.groups[0].name, "plate");
  EXPECT_EQ(frame.groups[0].material, "steel");
}

TEST(ObjSequenceWriter, ReadsPositionsFromAnInterleavedBuffer) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  const std::vector<float> buffer = {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99, 10, 11, 12, 99};
  ASSERT_TRUE(writer.write(0, PointView<const float>(buffer.data(), 4, 4 * sizeof(float))).ok());
  EXPECT_EQ(TempFolder::read(writer.framePath(0)).substr(0, 33), "v 1 2 3\nv 4 5 6\nv 7 8 9\nv 10 11 1");
}

TEST(ObjSequenceWriter, NamesMaterialLibrariesFromItsFolder) {
  const TempFolder folder;
  folder.write("skin.mtl", "newmtl skin\n");
  Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", "mtllib skin.mtl\n" + kModel));
  ASSERT_TRUE(layout.ok());
  Result<ObjSequenceWriter> writer = ObjSequenceWriter::create(folder.path("a/b"), std::move(layout).value());
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer.value().write(0, viewOf(kAwkwardPositions)).ok());
  EXPECT_EQ(TempFolder::read(writer.value().framePath(0)).substr(0, 22), "mtllib ../../skin.mtl\n");
}

TEST(ObjSequenceWriter, WritesCurrentNormals) {
  const TempFolder folder;
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", kModel));
  ASSERT_TRUE(layout.ok());
  Result<ObjSequenceWriter> writer = ObjSequenceWriter::create(folder.path("out"), layout.value().withNormals());
  ASSERT_TRUE(writer.ok());
  const std::vector<Eigen::Vector3f> normals(4, Eigen::Vector3f(0.6f, 0, -0.8f));
  ASSERT_TRUE(writer.value().write(0, viewOf(kAwkwardPositions), viewOf(normals)).ok());
  const TriangleMesh frame = loadMesh(writer.value().framePath(0)).value();
  EXPECT_EQ(frame.positions, kAwkwardPositions);
  EXPECT_EQ(frame.texcoords.size(), 4u);
  ASSERT_EQ(frame.normals.size(), 4u);
  for (const Eigen::Vector3f& n : frame.normals) EXPECT_TRUE(n.isApprox(normals[0], 1e-6f));
  expectError(writer.value().write(1, viewOf(kAwkwardPositions)), kSizeMismatch, {"frame_0001.obj", "0 normals"});
}

TEST(ObjSequenceWriter, RefusesAnotherNumberOfPositions) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  const std::vector<Eigen::Vector3d> three(3, Eigen::Vector3d::Zero());
  expectError(writer.write(2, viewOf(three)), kSizeMismatch, {"frame_0002.obj", "3 positions", "4 vertices"});
  EXPECT_FALSE(std::filesystem::exists(writer.framePath(2)));
}

TEST(ObjSequenceWriter, RefusesPositionsThatAreNotFinite) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  std::vector<Eigen::Vector3f> positions(4, Eigen::Vector3f::Zero());
  positions[2][1] = std::numeric_limits<float>::quiet_NaN();
  expectError(writer.write(2, viewOf(std::as_const(positions))), kNonFinite, {"frame_0002.obj", "vertex 2"});
  EXPECT_FALSE(std::filesystem::exists(writer.framePath(2)));
}

TEST(ObjSequenceWriter, NamesAFolderThatCannotBeMade) {
  const TempFolder folder;
  const std::string blocked = folder.write("file", "not a folder") + "/out";
  Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", kModel));
  ASSERT_TRUE(layout.ok());
  expectError(ObjSequenceWriter::create(blocked, layout.value()), StatusCode::FileNotWritable, {blocked});
  expectError(ObjSequenceWriter::create(folder.path("file"), layout.value()), StatusCode::FileNotWritable,
              {folder.path("file"), "choose another"});
}

TEST(ObjSequenceWriter, ReportsAFolderThatVanishes) {
  const TempFolder folder;
  ObjSequenceWriter writer = makeWriter(folder);
  std::filesystem::remove_all(folder.path("out"));
  expectError(writer.write(0, viewOf(kAwkwardPositions)), StatusCode::FileNotWritable,
              {writer.framePath(0), "folder exists"});
}

}  // namespace
}  // namespace tetskin::test
