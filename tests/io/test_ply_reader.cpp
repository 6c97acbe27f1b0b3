// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "raw_bytes.h"

#include <tetskin/io/files.h>

#include <cstdint>
#include <limits>

namespace tetskin::test {
namespace {

using Triangle = std::array<int, 3>;

Result<TriangleMesh> loadPly(const std::string& text) {
  return loadMeshText("m.ply", text);
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_indices\n";

/// The header of a model: `vertices` and `faces` are counts followed by the properties.
std::string header(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\ncomment any\nelement vertex " + vertices + "element face " + faces +
         "end_header\n";
}
std::string ascii(const std::string& vertices, const std::string& faces) {
  return header("ascii", vertices, faces);
}

const std::string kPlyHead = ascii("4\n" + kXyz, "2\n" + kList);

void expectQuadAndTriangle(const Result<TriangleMesh>& mesh) {
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  ASSERT_EQ(mesh.value().vertexCount(), 4u);
  EXPECT_EQ(mesh.value().positions[2], Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}, {0, 2, 1}}));
  EXPECT_TRUE(mesh.value().groups.empty());
}

TEST(LoadPly, ReadsTextAndCutsPolygons) {
  const Result<TriangleMesh> mesh = loadPly(kPlyHead + kQuadCorners + "4 0 1 2 3\n3 0 2 1\n");
  expectQuadAndTriangle(mesh);
  EXPECT_EQ(mesh.value().positions[3].z(), 0.1);  // as a double, whatever type its property declares
  EXPECT_TRUE(mesh.value().normals.empty());
  EXPECT_TRUE(mesh.value().texcoords.empty());
}

TEST(LoadPly, LineBreaksOfTheBodyMeanNothing) {
  expectQuadAndTriangle(loadPly(kPlyHead + "0 0 0 1 0 0\n\n1 1 0\t0 1\n.1 4 0 1 2 3 3 0 2 1"));
}

TEST(LoadPly, IgnoresWhatStandsBehindAnElementInItsLine) {
  expectQuadAndTriangle(
      loadPly(kPlyHead + "0 0 0 255 0\n1 0 0 7\n1 1 0 red\n0 1 .1\n4 0 1 2 3 6 0 0 1 0 1 1\n3 0 2 1 9 1 1 1\n"));
}

TEST(LoadPly, ReadsOverALineOfAnOldBlenderInTheHeader) {
  std::string text = kPlyHead + kQuadCorners + "4 0 1 2 3\n3 0 2 1\n";
  text.replace(text.find("comment any"), 11, "Created by Blender3D 247 - www.blender.org, source file: ");
  expectQuadAndTriangle(loadPly(text));
}

TEST(LoadPly, ReadsTheLineEndsOfWindowsAndOldMacs) {
  const std::string text = kPlyHead + kQuadCorners + "4 0 1 2 3\n3 0 2 1\n";
  std::string windows, mac = text;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::replace(mac.begin(), mac.end(), '\n', '\r');
  expectQuadAndTriangle(loadPly(windows));
  expectQuadAndTriangle(loadPly(mac));
  mac.replace(mac.find("1 1 0"), 5, "1 x 0");
  expectError(loadPly(mac), kMalformed, {"m.ply:13:", "vertex 2"});
}

std::string binaryPly(bool big, const std::string& lineEnd = "\n") {
  std::string text = header(big ? "binary_big_endian" : "binary_little_endian", "4\nproperty uchar red\n" + kXyz,
                            "2\nproperty short material\nproperty list ushort uint vertex_index\n");
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + lineEnd.size())) {
    text.replace(at, 1, lineEnd);
  }
  for (const auto& p : {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}}) {
    text += '\n' + bytesOfAll<float>({p.x(), p.y(), p.z()}, big);
  }
  text +=
      bytesOf(std::int16_t(-1), big) + bytesOf(std::uint16_t(4), big) + bytesOfAll<std::uint32_t>({0, 1, 2, 3}, big);
  return text + bytesOf(std::int16_t(7), big) + bytesOf(std::uint16_t(3), big) +
         bytesOfAll<std::uint32_t>({0, 2, 1}, big);
}

TEST(LoadPly, ReadsBinaryOfEitherByteOrder) {
  for (const bool big : {false, true}) {
    for (const char* lineEnd : {"\n", "\r\n", "\r"}) {
      const Result<TriangleMesh> mesh = loadPly(binaryPly(big, lineEnd));
      expectQuadAndTriangle(mesh);
      EXPECT_EQ(mesh.value().positions[3].z(), static_cast<double>(0.1f));
    }
  }
}

TEST(LoadPly, ReadsEveryTypeOfNumber) {
  const std::pair<const char*, std::string> types[] = {{"char", bytesOf(std::int8_t(-2), false)},
                                                       {"int8", bytesOf(std::int8_t(-2), false)},
                                                       {"uchar", bytesOf(std::uint8_t(254), false)},
                                                       {"uint8", bytesOf(std::uint8_t(254), false)},
                                                       {"short", bytesOf(std::int16_t(-2), false)},
                                                       {"int16", bytesOf(std::int16_t(-2), false)},
                                                       {"ushort", bytesOf(std::uint16_t(254), false)},
                                                       {"uint16", bytesOf(std::uint16_t(254), false)},
                                                       {"int", bytesOf(std::int32_t(-2), false)},
                                                       {"int32", bytesOf(std::int32_t(-2), false)},
                                                       {"uint", bytesOf(std::uint32_t(254), false)},
                                                       {"uint32", bytesOf(std::uint32_t(254), false)},
                                                       {"float", bytesOf(-2.0f, false)},
                                                       {"float32", bytesOf(-2.0f, false)},
                                                       {"double", bytesOf(-2.0, false)},
                                                       {"float64", bytesOf(-2.0, false)}};
  for (const auto& [name, number] : types) {
    const std::string xyz = std::string("property ") + name + " x\nproperty int y\nproperty int z\n";
    const std::string yz(8, '\0'), face = '\3' + std::string(12, '\0');
    const Result<TriangleMesh> mesh =
        loadPly(header("binary_little_endian", "1\n" + xyz, "1\n" + kList) + number + yz + face);
    ASSERT_TRUE(mesh.ok()) << name << ": " << mesh.status().message;
    EXPECT_EQ(mesh.value().positions[0].x(), name[0] == 'u' ? 254 : -2) << name;
  }
}

TEST(LoadPly, ReadsNormalsAndTextureCoordinatesOfVertices) {
  const std::string more =
      "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n";
  const std::string text =
      ascii("3\n" + kXyz + more, "1\n" + kList) + "0 0 0 0 0 3 0 0\n1 0 0 0 0 0 1 0\n0 1 0 nan 0 1 0.5 1\n3 0 1 2";
  const Result<TriangleMesh> mesh = loadPly(text);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().normals, (std::vector<Eigen::Vector3f>{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(mesh.value().texcoords, (std::vector<Eigen::Vector2f>{{0, 0}, {1, 0}, {0.5f, 1}}));
}

TEST(LoadPly, KeepsTextureCoordinatesOfCornersIfEveryVertexHasOneOfItsOwn) {
  const std::string head = ascii("4\n" + kXyz, "2\n" + kList + "property list uchar float texcoord\n") + kQuadCorners;
  const std::string first = "3 0 1 2 6 0 0 1 0 1 1\n";
  EXPECT_EQ(loadPly(head + first + "3 0 2 3 6 0 0 1 1 0 1\n").value().texcoords,
            (std::vector<Eigen::Vector2f>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_TRUE(loadPly(head + first + "3 0 2 3 6 0 0 0.5 1 0 1\n").value().texcoords.empty());
  EXPECT_TRUE(loadPly(head + first + "3 0 2 3 0\n").value().texcoords.empty());
}

TEST(LoadPly, CutsStripsIntoTriangles) {
  const std::string text = "ply\nformat ascii 1.0\nobj_info any\nelement vertex 4\n" + kXyz +
                           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + kQuadCorners +
                           "8 0 1 2 3 -1 3 2 1\n";
  const Result<TriangleMesh> mesh = loadPly(text);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}, {2, 1, 3}, {3, 2, 1}}));
}

TEST(LoadPly, ReadsOverOtherElementsAndSmallFaces) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement camera 2\nproperty list uchar float view\nproperty int id\n"
      "element nothing 4000000000\nelement vertex 4\n" +
      kXyz + "element face 5\n" + kList +
      "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n2 0.5 0.5 1\n0 2\n" + kQuadCorners +
      "4 0 1 2 3\n0\n2 0 1\n1 3\n3 0 2 1\n0 1\n";
  expectQuadAndTriangle(loadPly(text));
}

TEST(LoadPly, RefusesCountsThatTheFileCannotHold) {
  const std::string list4 = "property list uint int vertex_indices\n";
  const std::string body =
      bytesOfAll<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, false) + '\3' + bytesOfAll<std::int32_t>({0, 1, 2}, false);
  const std::string text = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string few = "3\n" + kXyz, one = "1\n" + kList;
  for (const char* count : {"2000000000", "60000000", "4294967295", "4294967299", "18446744073709551615"}) {
    const std::string vertices = std::string(count) + "\n" + kXyz, faces = std::string(count) + "\n" + kList;
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
      expectError(loadPly(header(format, vertices, one) + body), kMalformed,
                  {"m.ply:4:", std::string("states ") + count + " of element 'vertex', at least 12 bytes each",
                   "only 49 bytes are left", "complete"});
      expectError(loadPly(header(format, few, faces) + body), kMalformed,
                  {"m.ply:8:", "element 'face', at least 1 bytes each", "only 13 bytes are left"});
    }
    expectError(loadPly(ascii(vertices, one) + text), kMalformed,
                {"m.ply:4:", "at least 6 bytes each", "only 26 bytes are left"});
    expectError(loadPly(ascii(few, faces) + text), kMalformed, {"m.ply:8:", "element 'face'"});
  }
  const std::string corners = bytesOfAll<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, false);
  for (const double count : {2e9, 6e7, 4.0}) {
    const std::string face =
        bytesOf(static_cast<std::uint32_t>(count), false) + bytesOfAll<std::int32_t>({0, 1, 2}, false);
    expectError(loadPly(header("binary_little_endian", few, "1\n" + list4) + corners + face), kMalformed,
                {"m.ply: face 0 of 1", "'vertex_indices'", "complete"});
  }
  expectError(loadPly(ascii(few, "1\n" + list4) + "0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n"), kMalformed,
              {"m.ply:14:", "face 0 of 1", "'vertex_indices'"});
  expectError(loadPly(ascii("99999999999999999999\n" + kXyz, one)), kMalformed,
              {"m.ply:4:", "'99999999999999999999'", "correct"});
}

TEST(LoadPly, RefusesBadHeaders) {
  expectError(loadPly(""), kMalformed, {"m.ply:1:", "'ply'"});
  expectError(loadPly("plyer\n"), kMalformed, {"m.ply:1:", "'ply'"});
  expectError(loadPly("ply\nformat ascii 1.0\nelement vertex 1\n"), kMalformed, {"m.ply:", "end_header", "complete"});
  expectError(loadPly("ply\nelement vertex 0\nend_header\n"), kMalformed, {"m.ply:", "no 'format'"});
  expectError(loadPly("ply\nformat ascii 1.0\nproperty int x\nend_header\n"), kMalformed, {"m.ply:3:", "before"});
  expectError(loadPly("ply\nformat ascii 1.0\nelement vertex 1\nsolid\n"), kMalformed, {"m.ply:4:", "'solid'"});
  expectError(loadPly("ply\nformat xml 1.0\n"), kUnsupportedFormat, {"m.ply:2:", "'xml'"});
  expectError(loadPly("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n"), kUnsupportedFormat,
              {"m.ply:4:", "'half'"});
  expectError(loadPly(ascii("1\nproperty float x\nproperty float y\n", "0\n") + "0 0\n"), kMalformed,
              {"m.ply:4:", "x, y or z"});
}

TEST(LoadPly, RefusesBadBodies) {
  const std::string faces = "3 0 1 2\n3 0 1 2\n";
  expectError(loadPly(kPlyHead + "0 0 0\n1 x 0\n1 1 0\n0 1 0\n" + faces), kMalformed,
              {"m.ply:12:", "vertex 1 of 4", "'y'"});
  expectError(loadPly(kPlyHead + "0 0 0\n1 0 inf\n1 1 0\n0 1 0\n" + faces), kNonFinite,
              {"m.ply:12:", "vertex 1", "not finite"});
  expectError(loadPly(kPlyHead + "0 0 0\n1 0 0\n1 1e19 0\n0 1 0\n" + faces), kNonFinite,
              {"m.ply:13:", "vertex 2", "beyond 1e18"});
  for (const char* bad : {"3 0 1 4", "3 0 1 -1", "3 0 1 0.5", "3 0 1 nan", "3 0 1 1e300"}) {
    expectError(loadPly(kPlyHead + kQuadCorners + "3 0 1 2\n" + bad), kIndexOutOfRange,
                {"m.ply:16:", "face 1 refers to vertex ", "there are 4"});
  }
  expectError(loadPly(kPlyHead + kQuadCorners + "3 0 1 2\n-3 0 1 2"), kMalformed, {"m.ply:16:", "face 1"});
  expectError(loadPly(kPlyHead + kQuadCorners + "3 0 1 2\n3 0 1"), kMalformed, {"m.ply:16:", "face 1"});
  expectError(loadPly(ascii("4\n" + kXyz, "0\n" + kList) + kQuadCorners), StatusCode::Empty,
              {"m.ply: ", "no triangles", "export"});
  expectError(loadPly("ply\nformat ascii 1.0\nend_header\n"), StatusCode::Empty, {"m.ply: ", "no vertices"});
  std::string nan = binaryPly(false);
  nan.replace(nan.find("end_header\n") + 11 + 13 + 1, 4, bytesOf(std::numeric_limits<float>::quiet_NaN(), false));
  expectError(loadPly(nan), kNonFinite, {"m.ply: vertex 1"});
}

/// Files of every reader of ours, cut short anywhere and with any bytes changed.
TEST(DamagedMeshFiles, AreRefusedOrSound) {
  const std::pair<const char*, std::string> files[] = {
      {"m.ply", kPlyHead + kQuadCorners + "4 0 1 2 3\n3 0 2 1\n"},
      {"m.ply", binaryPly(false)},
      {"m.ply", binaryPly(true)},
      {"m.off", "NOFF\n3 1 0\n0 0 0 0 0 2\n1 0 0 0 3 4\n0 1 0 0 0 1\n3 0 1 2\n"},
      {"m.obj",
       "\xEF\xBB\xBF# c\nmtllib a.mtl\no x\nv 0 0 0\nv 1e0 \\\n0 0\nv 0 1 0 1 1 1\nv -1 .5 +2\nvt 0 0\nvn 0 0 1\n"
       "g a\nusemtl m\nf 1/1/1 2/1/1 3/1/1 -1/-1/-1\nf 1//1 2//1 3//1\nl 1 2\n"}};
  std::mt19937 random(3);
  const TempFolder folder;
  for (const auto& [name, sound] : files) {
    std::size_t read = 0, refused = 0;
    const auto load = [&, file = std::string(name)](const std::string& bytes) {
      const Result<TriangleMesh> mesh = loadMesh(folder.write(file, bytes));
      EXPECT_TRUE(mesh.ok() ? validate(mesh.value()).ok() : !mesh.status().message.empty());
      ++(mesh.ok() ? read : refused);
    };
    for (std::size_t length = 0; length <= sound.size(); ++length) load(sound.substr(0, length));
    for (int i = 0; i < 600; ++i) load(damaged(sound, random));
    EXPECT_GT(read, 5u) << name;
    EXPECT_GT(refused, 100u) << name;
  }
}

}  // namespace
}  // namespace tetskin::test
