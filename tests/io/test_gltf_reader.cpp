// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gltf_document.h"
#include "raw_bytes.h"
#include "temp_folder.h"

#include <tetskin/io/files.h>

#include <filesystem>

namespace tetskin::test {
namespace {

using namespace gltf_types;
using Triangle = std::array<int, 3>;

/// Two meshes of the same triangle in the plane z = 1: "lit" has slanted normals and texture coordinates, "plain" has
/// neither. `nodes` is the list of the scene's nodes; the first is its root.
std::string gltf(const std::string& nodes) {
  const std::string buffer = raw<float>({0, 0, 1, 2, 0, 1, 0, 1, 1}) +
                             raw<float>({0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f}) +
                             raw<float>({0, 0, 0.5f, 0, 0, 0.25f}) + raw<std::uint16_t>({0, 1, 2, 0});
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
         R"(],"materials":[{"name":"skin"}],"meshes":[
{"name":"lit","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]},
{"name":"plain","primitives":[{"attributes":{"POSITION":0},"indices":3}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,1],"max":[2,1,1]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":3,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
{"buffer":0,"byteOffset":72,"byteLength":24},{"buffer":0,"byteOffset":96,"byteLength":8}],
"buffers":[{"byteLength":104,"uri":"data:application/octet-stream;base64,)" +
         base64(buffer) + "\"}]}";
}

TEST(LoadGltf, AppliesTheTransformsOfAllNodes) {
  const Result<TriangleMesh> loaded = loadMeshText(
      "m.gltf", gltf(R"({"children":[1,2],"translation":[10,0,0]},{"mesh":0,"scale":[3,1,1]},{"children":[3]},)"
                     R"({"mesh":0,"rotation":[0,0,0.70710678118,0.70710678118]})"));
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  const TriangleMesh& mesh = loaded.value();
  ASSERT_EQ(mesh.vertexCount(), 6u);
  EXPECT_EQ(mesh.positions[1], Eigen::Vector3d(16, 0, 1));
  EXPECT_LT((mesh.positions[4] - Eigen::Vector3d(10, 2, 1)).norm(), 1e-6);
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(mesh.normals.size(), 6u);
  // When stretched by three along x, a normal's x component shrinks by a factor of three.
  EXPECT_LT((mesh.normals[0] - Eigen::Vector3f(0.2f, 0, 0.8f).normalized()).norm(), 1e-6f);
  EXPECT_LT((mesh.normals[3] - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 1e-6f);
  ASSERT_EQ(mesh.texcoords.size(), 6u);
  EXPECT_EQ(mesh.texcoords[4][0], 0.5f);
}

TEST(LoadGltf, NamesGroupsAfterMeshesAndMaterials) {
  const TriangleMesh mesh =
      loadMeshText("m.gltf", gltf(R"({"children":[1,2]},{"mesh":0},{"mesh":1,"translation":[0,0,1]})")).value();
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "lit");
  EXPECT_EQ(mesh.groups[0].material, "skin");
  EXPECT_EQ(mesh.groups[0].firstTriangle, 0u);
  EXPECT_EQ(mesh.groups[0].triangleCount, 1u);
  EXPECT_EQ(mesh.groups[1].name, "plain");
  EXPECT_EQ(mesh.groups[1].material, "");
  EXPECT_EQ(mesh.groups[1].firstTriangle, 1u);
}

TEST(LoadGltf, AMirroredMeshStaysTheRightWayOut) {
  const TriangleMesh mesh = loadMeshText("m.gltf", gltf(R"({"mesh":0,"scale":[1,1,-1]})")).value();
  ASSERT_EQ(mesh.triangleCount(), 1u);
  const Triangle& t = mesh.triangles[0];
  const Eigen::Vector3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  EXPECT_EQ(a[2], -1.0);
  EXPECT_LT((b - a).cross(c - a)[2], 0.0);
  EXPECT_LT((mesh.normals[0] - Eigen::Vector3f(0.6f, 0, -0.8f)).norm(), 1e-6f);
}

/// As glTF says: if the transforms of a node and of those above it together mirror an odd number of times.
TEST(LoadGltf, WindingIsTurnedAsOftenAsNodesMirror) {
  struct Case {
    const char* nodes;
    Eigen::Vector3d scale;
  };
  for (const auto& [nodes, scale] : {
           Case{R"({"mesh":1,"scale":[-1,1,1]})", {-1, 1, 1}},
           Case{R"({"mesh":1,"scale":[-2,-2,-2]})", {-2, -2, -2}},
           Case{R"({"mesh":1,"scale":[-1,-1,1]})", {-1, -1, 1}},
           Case{R"({"mesh":1,"matrix":[1,0,0,0,0,-1,0,0,0,0,1,0,0,0,0,1]})", {1, -1, 1}},
           Case{R"({"children":[1],"scale":[-1,1,1]},{"mesh":1})", {-1, 1, 1}},
           Case{R"({"children":[1],"scale":[-1,1,1]},{"mesh":1,"scale":[1,1,-1]})", {-1, 1, -1}},
       }) {
    SCOPED_TRACE(nodes);
    const TriangleMesh mesh = loadMeshText("m.gltf", gltf(nodes)).value();
    ASSERT_EQ(mesh.triangleCount(), 1u);
    const Triangle& t = mesh.triangles[0];
    const auto at = [&](int k) { return mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
    // The triangle faces along z where nothing mirrors; its outside goes where the mirror puts it.
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z() * scale.z(), 0.0);
    EXPECT_LT((mesh.positions[1] - scale.cwiseProduct(Eigen::Vector3d(2, 0, 1))).norm(), 1e-12);
  }
}

TEST(LoadGltf, FillsWhatOnlySomeMeshesHave) {
  const TriangleMesh mesh = loadMeshText("m.gltf", gltf(R"({"children":[1,2]},{"mesh":1},{"mesh":0})")).value();
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_LT((mesh.normals[3] - Eigen::Vector3f(0.6f, 0, 0.8f)).norm(), 1e-6f);
  ASSERT_EQ(mesh.texcoords.size(), 6u);
  EXPECT_EQ(mesh.texcoords[1], Eigen::Vector2f(0, 0));
  const TriangleMesh plain = loadMeshText("m.gltf", gltf(R"({"mesh":1})")).value();
  EXPECT_EQ(plain.triangleCount(), 1u);
  EXPECT_TRUE(plain.normals.empty());
  EXPECT_TRUE(plain.texcoords.empty());
}

TEST(LoadGltf, NamesTheMaterialsOfPrimitivesThatShareTheirVertices) {
  Document document;
  const int corners = document.accessor(raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), kFloat, 4, "VEC3");
  const int lower = document.accessor(raw<std::uint8_t>({0, 1, 2, 0}), kUnsignedByte, 3, "SCALAR");
  const int upper = document.accessor(raw<std::uint32_t>({0, 2, 3}), kUnsigned, 3, "SCALAR");
  const TriangleMesh mesh =
      document
          .load(R"("materials":[{"name":"red"},{"name":"blue"}],"meshes":[{"name":"plate","primitives":[)" +
                primitive(corners, lower, R"(,"material":0)") + "," + primitive(corners, upper, R"(,"material":1)") +
                "]}]")
          .value();
  EXPECT_EQ(mesh.vertexCount(), 4u) << "an edge where materials meet stays closed";
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[1].name, "plate");
  EXPECT_EQ(mesh.groups[1].material, "blue");
  EXPECT_EQ(mesh.groups[1].firstTriangle, 1u);
}

TEST(LoadGltf, ReadsQuantisedAndNormalisedNumbers) {
  struct Case {
    int type;
    bool normalized;
    std::string bytes;
    double expected[3];  // of the second vertex
  };
  const std::vector<Case> cases = {
      {kShort, false, raw<std::int16_t>({0, 0, 0, 0, 100, -200, 7, 0, 0, 9, 0, 0}), {100, -200, 7}},
      {kShort, true, raw<std::int16_t>({0, 0, 0, 0, 32767, -32768, 16384, 0, 0, 9, 0, 0}), {1, -1, 16384.0 / 32767}},
      {kUnsignedShort, true, raw<std::uint16_t>({0, 0, 0, 0, 65535, 0, 1, 0, 0, 9, 0, 0}), {1, 0, 1 / 65535.0}},
      {kUnsignedByte, true, raw<std::uint8_t>({0, 0, 0, 0, 255, 51, 0, 0, 0, 9, 0, 0}), {1, 0.2, 0}},
      {kSignedByte, false, raw<std::int8_t>({0, 0, 0, 0, 127, -128, 1, 0, 0, 9, 0, 0}), {127, -128, 1}}};
  for (const Case& one : cases) {
    Document document;  // elements are padded to four bytes
    const int stride = one.bytes.size() == 12 ? 4 : 8;
    const int view = document.view(one.bytes, stride);
    const int corners = document.accessor(view, one.type, 3, "VEC3", one.normalized ? R"(,"normalized":true)" : "");
    const Result<TriangleMesh> mesh =
        document.load(R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)" +
                      meshOf(primitive(corners, -1)));
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(mesh.value().positions[1][k], one.expected[k]) << one.type;
  }
}

TEST(LoadGltf, QuantisedTexturesAndNormalsAreFractions) {
  Document document;
  const int corners = document.accessor(raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), kFloat, 3, "VEC3");
  const int normals = document.accessor(document.view(raw<std::int8_t>({0, 0, 127, 0, 0, 76, 102, 0, 0, 0, 127, 0}), 4),
                                        kSignedByte, 3, "VEC3", R"(,"normalized":true)");
  const int texcoords = document.accessor(raw<std::uint16_t>({0, 0, 65535, 13107, 0, 65535}), kUnsignedShort, 3, "VEC2",
                                          R"(,"normalized":true)");
  const TriangleMesh mesh =
      document
          .load(meshOf(R"({"attributes":{"POSITION":)" + std::to_string(corners) + R"(,"NORMAL":)" +
                       std::to_string(normals) + R"(,"TEXCOORD_0":)" + std::to_string(texcoords) + "}}"))
          .value();
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_LT((mesh.normals[1] - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 0.004f);
  ASSERT_EQ(mesh.texcoords.size(), 3u);
  EXPECT_LT((mesh.texcoords[1] - Eigen::Vector2f(1, 0.8f)).norm(), 1e-6f) << "v counts from below here";
}

TEST(LoadGltf, ReadsSparseAccessors) {
  for (const bool onZeros : {false, true}) {
    Document document;
    const int values = document.view(raw<float>({5, 6, 7, 8, 9, 10}));
    const int indices = document.view(raw<std::uint16_t>({1, 2}));
    const std::string sparse = R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(indices) +
                               R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}";
    const int base = onZeros ? -1 : document.view(raw<float>({1, 1, 1, 2, 2, 2, 3, 3, 3}));
    const int corners = document.accessor(base, kFloat, 3, "VEC3", sparse);
    const Result<TriangleMesh> mesh = document.load(meshOf(primitive(corners, -1)));
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().positions[0], Eigen::Vector3d::Constant(onZeros ? 0 : 1));
    EXPECT_EQ(mesh.value().positions[1], Eigen::Vector3d(5, 6, 7));
    EXPECT_EQ(mesh.value().positions[2], Eigen::Vector3d(8, 9, 10));
  }
}

TEST(LoadGltf, ReadsStripsFansAndInterleavedViews) {
  Document document;
  // Position and normal by turns.
  const int view =
      document.view(raw<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1}), 24);
  const int corners = document.accessor(view, kFloat, 4, "VEC3");
  const int normals = document.accessor(view, kFloat, 4, "VEC3", R"(,"byteOffset":12)");
  const int strip = document.accessor(raw<std::uint16_t>({0, 1, 2, 3, 3, 0}), kUnsignedShort, 5, "SCALAR");
  const int fan = document.accessor(raw<std::uint16_t>({0, 1, 3, 2}), kUnsignedShort, 4, "SCALAR");
  const auto read = [&](int indices, int mode) {
    const std::string text = R"({"attributes":{"POSITION":)" + std::to_string(corners) + R"(,"NORMAL":)" +
                             std::to_string(normals) + R"(},"indices":)" + std::to_string(indices) + R"(,"mode":)" +
                             std::to_string(mode) + "}";
    return document.load(meshOf(text)).value();
  };
  const TriangleMesh stripped = read(strip, 5);
  EXPECT_EQ(stripped.triangles, std::vector<Triangle>({{0, 1, 2}, {1, 3, 2}})) << "all to one side, none flat";
  EXPECT_EQ(stripped.positions[3], Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(stripped.normals[3], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(read(fan, 6).triangles, std::vector<Triangle>({{0, 1, 3}, {0, 3, 2}}));
  expectError(document.load(meshOf(primitive(corners, fan, R"(,"mode":1)"))), StatusCode::Empty, {"no triangles"});
}

TEST(LoadGltf, ANodesMatrixIsByColumns) {
  const TriangleMesh mesh =
      loadMeshText("m.gltf", gltf(R"({"mesh":0,"matrix":[0,2,0,0,-2,0,0,0,0,0,2,0,7,8,9,1]})")).value();
  EXPECT_EQ(mesh.positions[1], Eigen::Vector3d(7, 12, 11));
  expectError(loadMeshText("m.gltf", gltf(R"({"mesh":0,"scale":[1,2]})")), kMalformed, {"node 0"});
}

TEST(LoadGltf, ReadsGlbAsWellAsText) {
  Document document = triangle();
  for (const std::string& after : {std::string(), raw<std::uint32_t>({4}) + "MORE" + "abcd"}) {
    const Result<TriangleMesh> mesh = document.loadGlb(meshOf(primitive(0, -1)), after);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().positions[1], Eigen::Vector3d(2, 0, 0));
  }
  EXPECT_TRUE(document.load(meshOf(primitive(0, -1)), "data:;base64," + base64(document.bytes)).ok());
  EXPECT_TRUE(
      document.load(meshOf(primitive(0, -1)), "data:application/gltf-buffer;base64," + base64(document.bytes)).ok());
  expectError(document.load(meshOf(primitive(0, -1)), "data:;base64,????"), kMalformed, {"base 64"});
}

TEST(LoadGltf, NamesRequiredExtensionsThatAreNotSupported) {
  Document document = triangle();
  for (const char* name :
       {"EXT_meshopt_compression", "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "ANY_new"}) {
    const std::string list = R"("extensionsRequired":["KHR_materials_unlit",")" + std::string(name) + R"("],)";
    // The buffers of such files may not be there without a decoder.
    expectError(document.load(list + meshOf(primitive(0, -1)), "none.bin"), kUnsupportedFormat,
                {"m.gltf: ", name, "not supported", "save it without"});
  }
  EXPECT_TRUE(
      document
          .load(R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"],)" + meshOf(primitive(0, -1)))
          .ok());
  // Not required, but there is nothing else.
  const int nothing = document.accessor(-1, kFloat, 3, "VEC3");
  expectError(
      document.load(meshOf(primitive(nothing, -1, R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})"))),
      kUnsupportedFormat, {"KHR_draco_mesh_compression"});
}

TEST(LoadGltf, ImagesAreNeitherNeededNorOpened) {
  Document document = triangle();
  const std::string mesh = meshOf(primitive(0, -1));
  for (const char* images : {R"([{"uri":"missing.png"}])", R"([{"uri":"../../etc/passwd"}])", R"([{}])", R"({"a":1})",
                             R"([{"bufferView":99}])", R"([{"uri":"data:image/png;base64,AAAA"}])",
                             R"([{"bufferView":0,"mimeType":"image/png"}])", R"([{"uri":"pipe"}])"}) {
    const TempFolder folder;
    const Result<TriangleMesh> read = loadMesh(
        folder.write("m.gltf", document.json(R"("images":)" + std::string(images) +
                                             R"(,"textures":[{"source":0}],"materials":[{"name":"m"}],)" + mesh)));
    EXPECT_TRUE(read.ok()) << read.status().message;
  }
}

TEST(LoadGltf, ReadsBuffersOfItsFolderAlone) {
  Document document = triangle();
  const std::string mesh = meshOf(primitive(0, -1));
  const TempFolder folder;
  std::filesystem::create_directories(folder.path("model/deep"));
  for (const char* name : {"out.bin", "model/in.bin", "model/deep/a b.bin", "model/..bin"})
    folder.write(name, document.bytes);
  const auto load = [&](const std::string& uri) {
    return loadMesh(folder.write("model/m.gltf", document.json(mesh, uri))).status();
  };
  for (const char* uri : {"in.bin", "./in.bin", "deep/a%20b.bin", "deep/../in.bin", "deep\\\\a b.bin", "..bin"}) {
    EXPECT_TRUE(load(uri).ok()) << uri << " " << load(uri).message;
  }
  for (const std::string& uri :
       {std::string("../out.bin"), std::string("%2e%2e/out.bin"), std::string("deep/../../out.bin"),
        std::string("..%2Fout.bin"), std::string("..\\\\out.bin"), folder.path("out.bin"),
        "file://" + folder.path("model/in.bin"), std::string("http://localhost/in.bin"), std::string("C:in.bin"),
        std::string("in.bin%00")}) {
    expectError(load(uri), kUnsupportedFormat, {"m.gltf: refers to", "not in its folder", "copy"});
  }
  for (const char* uri : {"no.bin", "deep"}) expectError(load(uri), kFileNotFound, {"refers to", uri});
  expectError(load(""), kUnsupportedFormat, {"refers to ''"});
  std::filesystem::create_symlink(folder.path("out.bin"), folder.path("model/link.bin"));
  std::filesystem::create_directory_symlink(folder.path(), folder.path("model/up"));
  std::filesystem::create_symlink("in.bin", folder.path("model/inner.bin"));
  expectError(load("link.bin"), kUnsupportedFormat, {"not in its folder"});
  expectError(load("up/out.bin"), kUnsupportedFormat, {"not in its folder"});
  EXPECT_TRUE(load("inner.bin").ok());
}

TEST(LoadGltf, ABufferThatNothingNeedsMayBeMissing) {
  Document document = triangle();
  document.moreBuffers = R"(,{"byteLength":10,"uri":"animation.bin"})";
  EXPECT_TRUE(document.load(meshOf(primitive(0, -1))).ok());
}

TEST(LoadGltf, AMeshWithBonesAndIntegersIsRefusedAsItsBonesScaleIt) {
  Document document;
  const int corners =
      document.accessor(document.view(raw<std::int16_t>({0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0}), 8), kShort, 3, "VEC3");
  expectError(document.load(meshOf(primitive(corners, -1)), Document::embedded, R"({"mesh":0,"skin":0})"),
              kUnsupportedFormat, {"m.gltf: ", "bones", "quantis", "-noq"});
  EXPECT_TRUE(triangle().load(meshOf(primitive(0, -1)), Document::embedded, R"({"mesh":0,"skin":0})").ok());
}

TEST(LoadGltf, HugeCountsAndIndicesAreErrors) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {R"("count":3)", R"("count":4)"},
      {R"("count":3)", R"("count":4294967295)"},
      {R"("count":3)", R"("count":9223372036854775807)"},
      {R"("count":3)", R"("count":6148914691236517206)"},
      {R"("bufferView":0)", R"("bufferView":-2147483648)"},
      {R"("bufferView":0)", R"("bufferView":1)"},
      {R"("bufferView":0)", R"("byteOffset":18446744073709551612,"bufferView":0)"},
      {R"("byteLength":36,"byteOffset")", R"("byteLength":18446744073709551615,"byteOffset")"},
      {R"("buffer":0)", R"("buffer":7)"},
      {R"("byteOffset":0)", R"("byteOffset":4)"},
      {R"("POSITION":0)", R"("POSITION":1000)"},
      {R"("POSITION":0)", R"("POSITION":0,"NORMAL":-7,"TEXCOORD_0":0)"},
      {R"("VEC3")", R"("MAT4")"},
      {R"("nodes":[{"mesh":0}])", R"("nodes":[{"mesh":3}])"},
      {R"("nodes":[{"mesh":0}])", R"("nodes":[{"mesh":0,"children":[0]}])"},
      {R"("nodes":[{"mesh":0}])", R"("nodes":[{"mesh":0,"children":[5]}])"},
      {R"("nodes":[0])", R"("nodes":[-1])"}};
  const std::string sound = triangle().json(meshOf(primitive(0, -1)));
  ASSERT_TRUE(loadMeshText("m.gltf", sound).ok()) << loadMeshText("m.gltf", sound).status().message;
  for (const auto& [what, instead] : faults) {
    std::string text = sound;
    ASSERT_NE(text.find(what), text.npos) << what;
    text.replace(text.find(what), what.size(), instead);
    const Status status = loadMeshText("m.gltf", text).status();
    EXPECT_TRUE(status.code == StatusCode::Malformed || status.code == StatusCode::IndexOutOfRange)
        << instead << ": " << status.message;
    EXPECT_NE(status.message.find("m.gltf: "), std::string::npos);
  }
  Document document;
  const int zeros = document.accessor(-1, kFloat, 2000000000, "VEC3");
  expectError(document.load(meshOf(primitive(zeros, -1))), kMalformed, {"without data"});
}

TEST(LoadGltf, ValuesInsideValuesAreBounded) {
  const std::string sound = triangle().json(meshOf(primitive(0, -1, R"(,"extras":@)")));
  for (const auto& [depth, good] : {std::pair<int, bool>(50, true), {200000, false}}) {
    const auto levels = static_cast<std::size_t>(depth);
    std::string text = sound;
    text.replace(text.find('@'), 1, std::string(levels, '[') + "1" + std::string(levels, ']'));
    EXPECT_EQ(loadMeshText("m.gltf", text).ok(), good) << depth;
  }
}

TEST(LoadGltf, NamesWhatIsNoGltf) {
  for (const char* text : {"", "{ broken", "[]", "{}", "solid", "\"", "{\"meshes"}) {
    const Status status = loadMeshText("m.gltf", text).status();
    EXPECT_FALSE(status.ok()) << text;
    EXPECT_NE(status.message.find("m.gltf: "), std::string::npos) << status.message;
  }
  for (const char* text : {"", " \n", "solid", "\xef\xbb\xbf[1]", "GLTF"}) {
    expectError(loadMeshText("m.glb", text), kMalformed, {"m.glb: is not glTF 2.0", "'glTF'", "'{'"});
  }
  const auto glb = [](std::uint32_t scene) { return "glTF" + raw<std::uint32_t>({2, 24, scene}) + "JSON" + "{}  "; };
  expectError(loadMeshText("m.glb", glb(2000000000)), kMalformed,
              {"m.glb: states a chunk of 2000000000 bytes", "contains 4", "complete"});
  expectError(loadMeshText("m.glb", glb(5)), kMalformed, {"m.glb: states a chunk of 5 bytes"});
  expectError(loadMeshText("m.glb", glb(4)), StatusCode::Empty, {"m.glb: has no triangles"});
  expectError(loadMeshText("m.glb", "glTF"), kMalformed, {"m.glb: ends within the header"});
  expectError(loadMeshText("m.gltf", R"({"asset": {"version": "1.0"}, "meshes": {}})"), kUnsupportedFormat,
              {"m.gltf: is glTF 1.0", "save it as glTF 2.0"});
}

TEST(LoadGltf, SurvivesDamage) {
  std::mt19937 random(3);
  const TempFolder folder;
  const std::string sound = triangle().glb(meshOf(primitive(0, -1)));
  std::size_t refused = 0;
  const auto check = [&](const std::string& bytes) {
    const Result<TriangleMesh> mesh = loadMesh(folder.write("m.glb", bytes));
    EXPECT_TRUE(mesh.ok() ? validate(mesh.value()).ok() : !mesh.status().message.empty());
    refused += !mesh.ok();
  };
  for (std::size_t length = 0; length < sound.size(); length += 3) check(sound.substr(0, length));
  for (int i = 0; i < 1000; ++i) check(damaged(sound, random, 8));
  EXPECT_GT(refused, 300u);
}

}  // namespace
}  // namespace tetskin::test
