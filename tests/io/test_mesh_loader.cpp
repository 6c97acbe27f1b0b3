// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "raw_bytes.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/zip_entries.h>

namespace tetskin::test {
namespace {

using Triangle = std::array<int, 3>;

TEST(LoadMesh, KeepsTheThreeVerticesOfEveryStlTriangle) {
  const TriangleMesh mesh =
      loadMeshText("m.STL",
                   "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 "
                   "0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 "
                   "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid plate\n")
          .value();
  EXPECT_EQ(mesh.vertexCount(), 6u);
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[5], Eigen::Vector3f(0, 0, 1));
}

TEST(LoadMesh, ASolidWithoutTrianglesDoesNoHarm) {
  const Result<TriangleMesh> mesh =
      loadMeshText("m.stl",
                   "solid empty\nendsolid empty\nsolid plate\nfacet normal 0 0 1\nouter "
                   "loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid "
                   "plate\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
}

TEST(LoadMesh, LeavesOutLinesAndPoints) {
  const Result<TriangleMesh> mesh = loadMeshText(
      "m.dae",
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g" name="part"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 1 1 0 9 9 9</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 3</p></lines></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
  EXPECT_EQ(mesh.value().vertexCount(), 3u);
}

TEST(LoadMesh, RefusesCountsThatTheFileCannotHold) {
  const std::string triangle = raw<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}) + std::string(2, '\0');
  const auto stl = [&](std::uint32_t triangles, const std::string& mark) {
    return mark + std::string(80 - mark.size(), '\0') + raw<std::uint32_t>({triangles}) + triangle;
  };
  // In 32-bit arithmetic, 2147483649 triangles take as many bytes as one.
  for (const std::uint32_t count : {2u, 2000000000u, 2147483649u, 4294967295u}) {
    for (const char* mark : {"", "solid"}) {
      expectError(loadMeshText("m.stl", stl(count, mark)), kMalformed,
                  {"m.stl: states " + std::to_string(count) + " triangles", "contains 134 bytes", "complete"});
    }
  }
  EXPECT_EQ(loadMeshText("m.stl", stl(1, "solid")).value().triangleCount(), 1u);
}

TEST(LoadMesh, ReadsStlTextThatBeginsWithABlank) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part\n";
  for (const char* begin : {"solid part\n", " solid part\n", "\t solid part\n"}) {
    EXPECT_EQ(loadMeshText("m.stl", begin + facet).value().triangleCount(), 1u) << begin;
  }
}

/// The CRC-32 of the bytes.
std::uint32_t checksumOf(const std::string& bytes) {
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xEDB88320 : 0);
  }
  return ~sum;
}

/// A ZIP archive.
/// wide  sizes are stated in 64 bits, in the extras, as some programs do for small files, too
std::string zip(const std::vector<std::pair<std::string, std::string>>& files, bool wide = false) {
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  std::string archive, list;
  for (const auto& [name, bytes] : files) {
    const auto size = static_cast<U32>(bytes.size()), offset = static_cast<U32>(archive.size());
    const U32 stated = wide ? 0xFFFFFFFF : size;
    const std::string extras = wide ? raw<U16>({1, 16}) + raw<std::uint64_t>({size, size}) : std::string();
    const std::string common = raw<U16>({45, 0, 0, 0, 0x21}) + raw<U32>({checksumOf(bytes), stated, stated}) +
                               raw<U16>({static_cast<U16>(name.size()), static_cast<U16>(extras.size())});
    archive += "PK\3\4" + common + name + extras + bytes;
    list += "PK\1\2" + raw<U16>({45}) + common + raw<U16>({0, 0, 0}) + raw<U32>({0, offset}) + name + extras;
  }
  const auto count = static_cast<U16>(files.size());
  return archive + list + "PK\5\6" + raw<U16>({0, 0, count, count}) +
         raw<U32>({static_cast<U32>(list.size()), static_cast<U32>(archive.size())}) + raw<U16>({0});
}

std::vector<std::pair<std::string, std::string>> package3mf() {
  const std::string type = "http://schemas.openxmlformats.org/package/2006/relationships";
  return {{"[Content_Types].xml",
           R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
          {"_rels/.rels", "<?xml version=\"1.0\"?><Relationships xmlns=\"" + type +
                              R"("><Relationship Target="/3D/3dmodel.model" Id="rel0" )"
                              R"(Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
                              R"(<Relationship Target="/Metadata/thumbnail.png" Id="rel1" Type=")" +
                              type + R"(/metadata/thumbnail"/></Relationships>)"},
          {"3D/3dmodel.model", R"(<?xml version="1.0"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="3" y="0" z="0"/>
<vertex x="0" y="2" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
</resources><build><item objectid="1"/></build></model>)"}};
}

TEST(LoadMesh, Reads3mfWithAThumbnailAsSlicersSaveIt) {
  auto files = package3mf();
  for (const bool wide : {false, true}) {
    for (const bool thumbnail : {false, true}) {
      files.resize(3);
      if (thumbnail) files.insert(files.begin() + 1, {"Metadata/thumbnail.png", std::string("\x89PNG\r\n\x1A\n\0", 9)});
      const Result<TriangleMesh> mesh = loadMeshText("m.3mf", zip(files, wide));
      ASSERT_TRUE(mesh.ok()) << mesh.status().message << wide << thumbnail;
      ASSERT_EQ(mesh.value().triangleCount(), 1u);
      EXPECT_EQ(mesh.value().positions[1], Eigen::Vector3d(3, 0, 0));
      files = package3mf();
    }
  }
}

TEST(LoadMesh, RefusesA3mfOfSeveralModels) {
  auto files = package3mf();
  files.push_back({"3D/Objects/other.model", files[2].second});
  expectError(loadMeshText("m.3mf", zip(files)), kUnsupportedFormat,
              {"m.3mf: ", "2 models", "production extension", "save it"});
}

TEST(LoadMesh, A3mfThatIsCutShortOrDamagedIsAnError) {
  const std::string sound = zip(package3mf());
  for (std::size_t length = 0; length < sound.size(); length += 7) {
    EXPECT_FALSE(loadMeshText("m.3mf", sound.substr(0, length)).ok()) << length;
  }
  // Every number of the list of contents, one after the other, as large as can be.
  std::size_t refused = 0;
  for (std::size_t at = sound.find("PK\1\2"); at + 4 <= sound.size(); at += 2) {
    std::string damaged = sound;
    damaged.replace(at, 4, "\xFF\xFF\xFF\x7F");
    const Result<io::Models3mf> models = io::modelsOf3mf("m.3mf", damaged);
    EXPECT_TRUE(models.ok() || models.status().code == StatusCode::Malformed);
    refused += !models.ok();
  }
  EXPECT_GT(refused, 20u);
}

TEST(LoadMesh, NamesAMissingFileAndAFolder) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.ply")), kFileNotFound, {folder.path("none.ply"), "check"});
  std::filesystem::create_directory(folder.path("dir.ply"));
  expectError(loadMesh(""), kFileNotFound, {"(empty path)"});
  expectError(loadMesh(folder.path("dir.ply")), kFileNotFound, {folder.path("dir.ply"), "folder"});
}

TEST(LoadMesh, NamesFormatsThatAreNotRead) {
  expectError(loadMeshText("m.xyzzy", "text"), kUnsupportedFormat, {"m.xyzzy", "'.xyzzy'", "convert"});
  expectError(loadMeshText("mesh", "text"), kUnsupportedFormat, {"mesh: ", "no file name extension"});
}

#ifndef TETSKIN_TEST_GLTF
TEST(LoadMesh, RefusesGltfByNameWithoutTinygltf) {
  for (const char* name : {"m.gltf", "m.GLB", "m.vrm"}) {
    expectError(loadMeshText(name, "{}"), kUnsupportedFormat, {name, "tinygltf", "install"});
  }
}
#endif

TEST(LoadMesh, PassesOnWhatAssimpSaysOfABrokenFile) {
  expectError(loadMeshText("m.dae", "{ broken"), kMalformed, {"m.dae: cannot be read: ", "export"});
  expectError(loadMeshText("m.stl", ""), kMalformed, {"m.stl: cannot be read: "});
}

TEST(LoadMesh, NamesAVertexThatIsTooFar) {
  expectError(loadMeshText("m.stl",
                           "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1e31 "
                           "0\nendloop\nendfacet\nendsolid plate\n"),
              kNonFinite, {"m.stl: vertex 2", "beyond 1e18", "orrect"});
}

TEST(LoadMesh, NamesAFaceWithAnIndexOutOfRange) {
  expectError(loadMeshText("m.x3d",
                           R"(<?xml version="1.0"?><X3D><Scene><Shape><IndexedFaceSet coordIndex="0 1 2 -1 0 1 9 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/></IndexedFaceSet></Shape></Scene></X3D>)"),
              kIndexOutOfRange, {"m.x3d: ", "face 1", "vertex 9"});
}

}  // namespace
}  // namespace tetskin::test
