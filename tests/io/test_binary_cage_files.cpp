// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_texts.h"
#include "raw_bytes.h"

#include <tetskin/io/files.h>

#include <cstdint>
#include <initializer_list>

namespace tetskin::test {
namespace {

/// Integers of 32 bits, the highest byte first.
std::string bigWords(std::initializer_list<double> values) {
  return bigAll<std::uint32_t>(values);
}

std::string binaryCage() {
  const std::uint32_t one = 0x3F800000, half = 0x3F000000;  // floats
  std::string bytes(kFineTets, '\xF0');
  return "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n" +
         bigWords({0, 0, 0, one, 0, 0, 0, one, 0, 0, 0, one}) + "\nCELLS 2 9\n" +
         bigWords({3, 0, 1, 2, 4, 0, 1, 2, 3}) + "\nCELL_TYPES 2\n" + bigWords({5, 10}) +
         "\nFIELD FieldData 2\nmesh_hash 2 1 unsigned_int\n" + bigWords({0xFFFFFFFF, 2}) + "\nvertex_tets 1 3 int\n" +
         bigWords({0, 0, 0}) + "\nCELL_DATA 2\nSCALARS fill float\nLOOKUP_TABLE default\n" + bigWords({one, half}) +
         "\nCOLOR_SCALARS c 2\nabcd\nLOOKUP_TABLE l 1\nabcd\nVECTORS v float\n" + bigWords({0, 1, 2, 3, 4, 5}) +
         "\nSCALARS part int 1\n" + bigWords({9, 1}) + "\nFIELD FieldData 1\nfine_fill 64 2 " + "unsigned_char\n" +
         std::string(kFineTets, 'x') + bytes +
         "\nMETADATA\nINFORMATION 0\n\nPOINT_DATA 4\nSCALARS mass float 1\nLOOKUP_TABLE default\n" +
         bigWords({one, half, one, half}) + "\n";
}

TEST(BinaryCageFiles, ReadsBinaryData) {
  const Result<Cage> read = loadCageText(binaryCage());
  ASSERT_TRUE(read.ok()) << read.status().message;
  const Cage& cage = read.value();
  EXPECT_EQ(cage.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(cage.meshHash, 0xFFFFFFFF00000002u);
  EXPECT_EQ(cage.vertexTets, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(cage.volumeFraction, (std::vector<double>{0.5}));
  EXPECT_EQ(cage.component, (std::vector<int>{1}));
  EXPECT_EQ(cage.fineVolumeFraction, std::vector<std::uint8_t>(kFineTets, 0xF0));
  EXPECT_EQ(cage.masses, (std::vector<double>{1, 0.5, 1, 0.5}));
}

/// The length in front of a string is in 1, 2, 4 or 8 bytes, by its two bits on top.
TEST(BinaryCageFiles, ReadsOverStrings) {
  const std::string longer(300, 'x');
  const std::string strings =
      "\xC3"
      "abc" +
      std::string("\xC0") + "\x81\x2C" + longer + bigWords({0x40000002}) + "\n\n" + bigWords({0, 1}) + "z";
  const std::string text =
      with(binaryCage(), "FIELD FieldData 2\n", "FIELD FieldData 3\nnames 1 5 string\n" + strings + "\n");
  const Result<Cage> read = loadCageText(text);
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().meshHash, 0xFFFFFFFF00000002u);
  expectError(loadCageText(with(text, "names 1 5", "names 1 9999")), kMalformed, {});
  expectError(loadCageText(with(text, bigWords({0x40000002}), bigWords({0x7FFFFFFF}))), kMalformed,
              {"c.vtk", "complete"});
}

TEST(BinaryCageFiles, MassesFollowTheNodesOfTetsOfSecondOrder) {
  const std::string cage =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 float\n0 0 0 .5 0 0 1 0 0 .5 .5 0 0 "
      "1 "
      "0 0 .5 0 0 0 .5 .5 0 .5 0 .5 .5 0 0 1\nCELLS 1 11\n10 0 2 4 9 1 3 5 6 7 8\nCELL_TYPES 1\n24\nPOINT_DATA 10\n"
      "SCALARS mass double 1\nLOOKUP_TABLE default\n1 9 2 9 3 9 9 9 9 4\n";
  const Result<Cage> read = loadCageText(cage);
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().masses, (std::vector<double>{1, 9, 2, 9, 3, 9, 9, 9, 9, 4}));
}

TEST(BinaryCageFiles, SurvivesBinaryDataCutShortAnywhere) {
  const std::string bytes = binaryCage();
  std::size_t read = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) read += loadCageText(bytes.substr(0, length)).ok();
  EXPECT_LT(read, 40u);
  expectError(loadCageText(with(bytes, "mass float", "mass bit")), kMalformed, {"'mass' of type 'bit'"});
  expectError(loadCageText(with(bytes, "VECTORS v float", "VECTORS v bit")), kUnsupportedFormat,
              {"'bit'", "save it as ASCII"});
}

}  // namespace
}  // namespace tetskin::test
