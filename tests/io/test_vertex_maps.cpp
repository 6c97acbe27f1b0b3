// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Maps painted on vertices, in files of all formats that have them.
#ifdef TETSKIN_TEST_GLTF
#include "gltf_document.h"
#endif
#include "loaded_texts.h"
#include "raw_bytes.h"

#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

using Values = std::vector<double>;

Result<Values> mapOf(const std::string& file, const std::string& text, const std::string& name) {
  const TempFolder folder;
  return loadVertexMap(folder.write(file, text), name);
}

void expectMap(const Result<Values>& map, const Values& values) {
  ASSERT_TRUE(map.ok()) << map.status().message;
  ASSERT_EQ(map.value().size(), values.size());
  for (std::size_t v = 0; v < values.size(); ++v) EXPECT_NEAR(map.value()[v], values[v], 1e-7) << v;
}

void expectRefused(const Result<Values>& map, StatusCode code, const std::vector<std::string>& words) {
  EXPECT_EQ(map.status().code, code) << map.status().message;
  for (const std::string& word : words)
    EXPECT_NE(map.status().message.find(word), std::string::npos) << map.status().message;
}

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "property double stiff\nproperty uchar red\nproperty float blue\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 1 255 0.5\n1 0 0 4 0 0.25\n0 1 0 0.5 51 1\n3 0 1 2\n";
const std::string kObj = "v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0.25\nv 0 1 0 0.2 0 1 # red, green, blue\nf 1 2 3\n";

TEST(VertexMaps, OfAPlyFileAreItsProperties) {
  expectMap(mapOf("m.ply", kPly, "stiff"), {1, 4, 0.5});
  expectMap(mapOf("m.ply", kPly, "red"), {1, 0, 0.2});
  expectMap(mapOf("m.ply", kPly, "blue"), {0.5, 0.25, 1});
  std::string text = kPly;
  text.replace(text.find("uchar red"), 9, "short red");
  text.replace(text.find("255"), 3, "32767");
  expectMap(mapOf("m.ply", text, "red"), {1, 0, 51 / 32767.0});
}

TEST(VertexMaps, OfAnObjFileAreItsColours) {
  expectMap(mapOf("m.obj", kObj, "red"), {1, 0, 0.2});
  expectMap(mapOf("m.obj", kObj, "green"), {0, 1, 0});
  expectMap(mapOf("m.obj", kObj, "blue"), {0.5, 0.25, 1});
}

TEST(VertexMaps, ThatAreAbsentAreNamedWithThoseThatAreThere) {
  expectRefused(mapOf("m.ply", kPly, "Stiff"), StatusCode::InvalidOption,
                {"m.ply", "no map 'Stiff'", "'blue', 'red', 'stiff'"});
  expectRefused(mapOf("m.obj", kObj, "alpha"), StatusCode::InvalidOption, {"m.obj", "'blue', 'green', 'red'"});
  const std::string plain = "v 0 0 0\nv 1 0 0 1\nv 0 1 0\nf 1 2 3\n";
  expectRefused(mapOf("m.obj", plain, "red"), StatusCode::InvalidOption, {"no map 'red'", "it has none"});
  expectRefused(mapOf("m.stl", "solid\n", "red"), StatusCode::UnsupportedFormat, {"m.stl", "PLY or glTF"});
  EXPECT_EQ(loadVertexMap("none.ply", "red").status().code, StatusCode::FileNotFound);
}

TEST(VertexMaps, ThatAreIncompleteOrNotFiniteAreRefused) {
  const std::string partly = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
  expectRefused(mapOf("m.obj", partly, "red"), StatusCode::InvalidOption, {"on only 2 of 3 vertices", "'red'"});
  std::string text = kPly;
  text.replace(text.find("1 0 0 4"), 7, "1 0 0 nan");
  expectRefused(mapOf("m.ply", text, "stiff"), StatusCode::NonFinite, {"m.ply", "'stiff'", "vertex 1"});
  text = kObj;
  text.replace(text.find("0 0 0 1 0"), 9, "0 0 0 ? 0");
  expectRefused(mapOf("m.obj", text, "red"), StatusCode::Malformed, {"m.obj:1", "'?'"});
}

#ifdef TETSKIN_TEST_GLTF
TEST(VertexMaps, OfAGltfFileAreItsAttributes) {
  using namespace gltf_types;
  Document document = triangle();
  const int stiff = document.accessor(raw<float>({1, 4, 0.5}), kFloat, 3, "SCALAR");
  const int vector = document.accessor(raw<float>({1, 2, 3, 4, 5, 6}), kFloat, 3, "VEC2");
  const int colour = document.accessor(raw<std::uint8_t>({255, 0, 128, 255, 0, 255, 64, 0, 51, 0, 255, 102}),
                                       kUnsignedByte, 3, "VEC4", R"(,"normalized":true)");
  const auto text = [&](int map, const std::string& nodes = R"({"mesh":0})") {
    const std::string more = R"(,"_STIFF":)" + std::to_string(map) + R"(,"COLOR_0":)" + std::to_string(colour);
    const std::string one = R"({"attributes":{"POSITION":0)" + more + "}}";
    return document.json(meshOf(one), Document::embedded, nodes);
  };
  expectMap(mapOf("m.gltf", text(stiff), "_STIFF"), {1, 4, 0.5});
  expectMap(mapOf("m.gltf", text(stiff), "red"), {1, 0, 0.2});
  expectMap(mapOf("m.gltf", text(stiff), "alpha"), {1, 0, 0.4});
  expectMap(mapOf("m.gltf", text(stiff, R"({"mesh":0,"children":[1]},{"mesh":0})"), "_STIFF"), {1, 4, 0.5, 1, 4, 0.5});
  expectRefused(mapOf("m.gltf", text(stiff), "_SOFT"), StatusCode::InvalidOption,
                {"m.gltf", "'_STIFF', 'alpha', 'blue', 'green', 'red'"});
  expectRefused(mapOf("m.gltf", text(vector), "_STIFF"), StatusCode::InvalidOption, {"no map '_STIFF'"});
  const int few = document.accessor(raw<float>({1, 4}), kFloat, 2, "SCALAR");
  expectRefused(mapOf("m.gltf", text(few), "_STIFF"), StatusCode::Malformed, {"'_STIFF'", "positions"});
  expectRefused(mapOf("m.gltf", text(99), "_STIFF"), StatusCode::IndexOutOfRange, {"accessor 99"});
  const auto two = [&](int first, int second) {
    const auto one = [](int map) { return R"({"attributes":{"POSITION":0,"_STIFF":)" + std::to_string(map) + "}}"; };
    return document.json(meshOf(one(first) + "," + one(second)));
  };
  expectMap(mapOf("m.gltf", two(stiff, stiff), "_STIFF"), {1, 4, 0.5});
  const int other = document.accessor(raw<float>({2, 4, 0.5}), kFloat, 3, "SCALAR");
  expectRefused(mapOf("m.gltf", two(stiff, other), "_STIFF"), StatusCode::InvalidOption, {"two maps '_STIFF'"});
}
#endif

}  // namespace
}  // namespace tetskin::test
