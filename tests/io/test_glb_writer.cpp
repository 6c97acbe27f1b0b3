// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "full_disk.h"
#include "glb_model.h"
#include "support/bars.h"
#include "support/smooth_maps.h"
#include "temp_folder.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/io/animation.h>

#include <filesystem>
#include <limits>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A bar of 2 x 1 x 1 in a cage, a surface of two materials in it, with texture coordinates.
struct CagedBar {
  explicit CagedBar(double reach = 0.0, const Vector3d& at = Vector3d::Zero()) {
    cage.mesh = makeBox({4, 2, 2}, {2.0, 1.0, 1.0});
    for (Vector3d& node : cage.mesh.nodes) node += at;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int v = 0; v < 300; ++v) {
      const Vector3d inside(2.0 * unit(random), unit(random), unit(random));
      mesh.positions.push_back(at + inside + reach * (inside - Vector3d(1.0, 0.5, 0.5)));
      mesh.texcoords.emplace_back(static_cast<float>(unit(random)), static_cast<float>(unit(random)));
    }
    for (int t = 0; t < 100; ++t) mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    mesh.triangles.push_back({5, 5, 6});
    mesh.groups = {{"a", "red", 0, 60}, {"b", "blue", 60, 30}, {"c", "red", 90, 11}};
    embedding = embed(cage, mesh).value();
  }

  /// The surface as MeshSkin has it, in double.
  Points skinned(const Points& nodes, Interpolation interpolation) const {
    BindingOptions options;
    options.interpolation = interpolation;
    MeshSkin<double> skin;
    EXPECT_TRUE(skin.bind(SkinBinding<double>::create(cage, mesh, options, embedding).value(), viewOf(nodes)).ok());
    Points points;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) points.emplace_back(skin.positions()[v]);
    return points;
  }

  Cage cage;
  TriangleMesh mesh;
  Embedding embedding;
};

double farthest(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0.0;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) most = std::max(most, (a[v] - b[v]).norm());
  return most;
}

GlbWriter glbWriterOf(const std::string& path) {
  Result<GlbWriter> writer = GlbWriter::create(path, 60.0);
  EXPECT_TRUE(writer.ok()) << writer.status().message;
  return std::move(writer).value();
}

/// Writes one body, with a frame for each list of nodes.
std::string written(const TempFolder& folder, const CagedBar& bar, Interpolation interpolation,
                    const std::vector<Points>& frames) {
  const std::string path = folder.path("a.glb");
  GlbWriter writer = glbWriterOf(path);
  writer.setMaterials({{"red", {1.0f, 0.0f, 0.0f}, 1.0f, 0.5f}, {"blue", {0.0f, 0.0f, 0.5f}, 0.25f, 1.0f}});
  const auto model = writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, interpolation);
  EXPECT_TRUE(model.ok()) << model.status().message;
  writer.addBody(model.value(), "bar");
  for (const Points& nodes : frames) {
    const Status status = writer.addFrame({viewOf(nodes)});
    EXPECT_TRUE(status.ok()) << status.message;
  }
  const Status status = writer.finish();
  EXPECT_TRUE(status.ok()) << status.message;
  return path;
}

/// At rest, in three smooth maps, in an affine one that mirrors, in one plane, and all in one point.
std::vector<Points> framesOf(const CagedBar& bar) {
  std::vector<Points> frames = {bar.cage.mesh.nodes};
  const Vector3d centre = boundingBox(bar.cage.mesh.nodes).center();
  for (const SmoothMap& map : smoothMaps(centre)) {
    frames.push_back(partOf(map, 0.3)(bar.cage.mesh.nodes));
  }
  const auto scaled = [&](const Vector3d& factors) {
    Points nodes = bar.cage.mesh.nodes;
    for (Vector3d& node : nodes) node = centre + factors.cwiseProduct(node - centre);
    frames.push_back(nodes);
  };
  scaled({-1.0, 1.2, 1.0});
  scaled({1.0, 0.0, 1.0});
  scaled({0.0, 0.0, 0.0});
  return frames;
}

TEST(GlbWriter, ALinearBodyIsLinearSkinning) {
  const TempFolder folder;
  const CagedBar bar;
  const std::vector<Points> frames = framesOf(bar);
  const GlbModel file(written(folder, bar, Interpolation::Linear, frames));
  file.expectValid();
  ASSERT_EQ(file.frameCount(), frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_LT(farthest(file.positions("bar", f), bar.skinned(frames[f], Interpolation::Linear)), 2e-6) << f;
  }
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(GlbWriter, AQuadraticBodyIsQuadraticSkinning) {
  const TempFolder folder;
  const CagedBar bar;
  const std::vector<Points> frames = framesOf(bar);
  const GlbModel file(written(folder, bar, Interpolation::Quadratic, frames));
  file.expectValid();
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Points expected = bar.skinned(frames[f], Interpolation::Quadratic);
    EXPECT_LT(farthest(file.positions("bar", f), expected), 2e-6) << f;
  }
  EXPECT_GT(farthest(file.positions("bar", 1), bar.skinned(frames[1], Interpolation::Linear)), 1e-3);
}

TEST(GlbWriter, OutsideItsCageAQuadraticSurfaceGoesOnFromTheClosestPoint) {
  const TempFolder folder;
  const CagedBar bar(0.1);
  ASSERT_LT(bar.embedding.insideCount(), bar.mesh.vertexCount() - 20);
  std::vector<Points> frames = {bar.cage.mesh.nodes, affineMap(3)(bar.cage.mesh.nodes)};
  const Vector3d centre = boundingBox(bar.cage.mesh.nodes).center();
  for (const double part : {0.1, 0.2}) frames.push_back(partOf(smoothMaps(centre)[0], part)(frames[0]));
  const GlbModel file(written(folder, bar, Interpolation::Quadratic, frames));
  file.expectValid();
  const auto error = [&](std::size_t f) {
    return farthest(file.positions("bar", f), bar.skinned(frames[f], Interpolation::Quadratic));
  };
  EXPECT_LT(error(0), 2e-6) << "at rest";
  EXPECT_LT(error(1), 5e-6) << "affine maps are exact";
  EXPECT_LT(error(2), 3e-3);
  EXPECT_LT(error(3), 6e-3);
}

TEST(GlbWriter, OutsideItsCageALinearSurfaceKeepsItsDistanceVector) {
  const TempFolder folder;
  const CagedBar bar(0.1);
  Points moved = bar.cage.mesh.nodes, turned = moved;
  for (Vector3d& node : moved) node += Vector3d(1.0, 2.0, 3.0);
  const Eigen::AngleAxisd turn(0.5, Vector3d::UnitY());
  for (Vector3d& node : turned) node = turn * node;
  const GlbModel file(written(folder, bar, Interpolation::Linear, {bar.cage.mesh.nodes, moved, turned}));
  file.expectValid();
  EXPECT_LT(farthest(file.positions("bar", 0), bar.mesh.positions), 1e-6);
  EXPECT_LT(farthest(file.positions("bar", 1), bar.skinned(moved, Interpolation::Linear)), 2e-6);
  // At most the distance from the cage, 0.1 of half the bar's diagonal, times the chord of the turn.
  const double error = farthest(file.positions("bar", 2), bar.skinned(turned, Interpolation::Linear));
  EXPECT_GT(error, 1e-3);
  EXPECT_LT(error, 0.1 * std::sqrt(1.5) * 2.0 * std::sin(0.25));
}

TEST(GlbWriter, IsAsExactFarFromTheOrigin) {
  const TempFolder folder;
  const Vector3d away(1e6, -2e6, 5e5);
  const CagedBar bar(0.0, away);
  const Points bent = partOf(smoothMaps(away)[0], 0.2)(bar.cage.mesh.nodes);
  for (const Interpolation kind : {Interpolation::Linear, Interpolation::Quadratic}) {
    const GlbModel file(written(folder, bar, kind, {bar.cage.mesh.nodes, bent}));
    file.expectValid();
    const tinygltf::Value origin = file.model().scenes[0].extras.Get("origin");
    ASSERT_EQ(origin.ArrayLen(), 3u);
    Vector3d shift;
    for (int k = 0; k < 3; ++k) shift[k] = origin.Get(k).GetNumberAsDouble();
    const auto shifted = [&](Points points) {
      for (Vector3d& p : points) p -= shift;
      return points;
    };
    EXPECT_LT(farthest(file.positions("bar", 0), shifted(bar.mesh.positions)), 2e-6);
    EXPECT_LT(farthest(file.positions("bar", 1), shifted(bar.skinned(bent, kind))), 2e-6);
  }
}

TEST(GlbWriter, KeepsTextureCoordinatesMaterialsAndTriangles) {
  const TempFolder folder;
  const CagedBar bar;
  for (const Interpolation kind : {Interpolation::Linear, Interpolation::Quadratic}) {
    const GlbModel file(written(folder, bar, kind, {bar.cage.mesh.nodes}));
    file.expectValid();
    EXPECT_EQ(file.triangleCount("bar"), 100u) << "one names a vertex twice";
    EXPECT_EQ(file.materials("bar"), (std::vector<std::string>{"red", "blue"}));
    const auto& primitive = file.model().meshes[0].primitives[0];
    EXPECT_EQ(primitive.attributes.count("NORMAL"), kind == Interpolation::Quadratic ? 1u : 0u);
    const std::vector<double> uv = file.numbers(primitive.attributes.at("TEXCOORD_0"));
    for (std::size_t v = 0; v < bar.mesh.vertexCount(); ++v) {
      EXPECT_EQ(uv[2 * v], static_cast<double>(bar.mesh.texcoords[v].x()));
      EXPECT_EQ(uv[2 * v + 1], static_cast<double>(1.0f - bar.mesh.texcoords[v].y()));
    }
    const tinygltf::Material& blue = file.model().materials[1];
    EXPECT_EQ(blue.alphaMode, "BLEND");
    EXPECT_NEAR(blue.pbrMetallicRoughness.baseColorFactor[2], 0.21404, 1e-5) << "linear";
    EXPECT_EQ(blue.pbrMetallicRoughness.baseColorFactor[3], 0.25);
    EXPECT_EQ(file.model().materials[0].alphaMode, "OPAQUE");
  }
}

TEST(GlbWriter, BodiesShareAMeshAndObjectsMoveOrStay) {
  const TempFolder folder;
  const CagedBar bar;
  const std::string path = folder.path("a.glb");
  GlbWriter writer = glbWriterOf(path);
  const std::size_t model = writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, Interpolation::Linear).value();
  writer.addBody(model, "bar");
  writer.addBody(model, "bar");
  TriangleMesh floor;
  floor.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  floor.triangles = {{0, 1, 2}};
  ASSERT_TRUE(writer.addObject("floor", floor, false).ok());
  ASSERT_TRUE(writer.addObject("hat", floor, true).ok());
  Points other = bar.cage.mesh.nodes;
  for (Vector3d& node : other) node += Vector3d(0, 3, 0);
  Eigen::Affine3d place(Eigen::AngleAxisd(2.0, Vector3d(1, 2, 3).normalized()));
  place.pretranslate(Vector3d(4, 5, 6));
  ASSERT_TRUE(writer.addFrame({viewOf(bar.cage.mesh.nodes), viewOf(other)}, {Eigen::Affine3d::Identity()}).ok());
  ASSERT_TRUE(writer.addFrame({viewOf(other), viewOf(bar.cage.mesh.nodes)}, {place}).ok());
  const double promised = writer.bytesFor(2);
  ASSERT_TRUE(writer.finish().ok());
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  EXPECT_NEAR(promised, bytes, 0.2 * bytes);

  const GlbModel file(path);
  file.expectValid();
  EXPECT_EQ(file.model().meshes.size(), 3u);
  EXPECT_LT(farthest(file.positions("bar", 0), file.positions("bar_2", 1)), 1e-9);
  EXPECT_LT(farthest(file.positions("bar", 1), bar.skinned(other, Interpolation::Linear)), 2e-6);
  for (const std::size_t f : {0u, 1u}) EXPECT_LT(farthest(file.positions("floor", f), floor.positions), 1e-9);
  Points hat = floor.positions;
  EXPECT_LT(farthest(file.positions("hat", 0), hat), 1e-9);
  for (Vector3d& p : hat) p = place * p;
  EXPECT_LT(farthest(file.positions("hat", 1), hat), 2e-6);
}

TEST(GlbWriter, RotationsChangeLittleFromFrameToFrame) {
  const TempFolder folder;
  const CagedBar bar;
  std::vector<Points> frames;
  const Vector3d centre = boundingBox(bar.cage.mesh.nodes).center();
  for (int f = 0; f <= 100; ++f) {
    Points nodes = partOf(smoothMaps(centre)[0], 0.002 * f)(bar.cage.mesh.nodes);
    for (Vector3d& node : nodes) node = centre + Eigen::AngleAxisd(0.06 * f, Vector3d::UnitX()) * (node - centre);
    frames.push_back(nodes);
  }
  const GlbModel file(written(folder, bar, Interpolation::Quadratic, frames));
  for (const auto& channel : file.model().animations[0].channels) {
    if (channel.target_path != "rotation") continue;
    const auto all =
        file.numbers(file.model().animations[0].samplers[static_cast<std::size_t>(channel.sampler)].output);
    for (std::size_t i = 4; i < all.size(); i += 4) {
      EXPECT_GT(Eigen::Vector4d(&all[i]).dot(Eigen::Vector4d(&all[i - 4])), 0.0) << "players take the shorter turn";
    }
  }
}

TEST(GlbWriter, AnyNameIsText) {
  const TempFolder folder;
  CagedBar bar;
  bar.mesh.groups = {{"", "gr\xC3\xBCn", 0, 50}, {"", "latin gr\xFCn", 50, 50}, {"", "\xED\x95\x9C\"\\", 100, 1}};
  bar.mesh.triangles[100] = {0, 1, 5};
  const GlbModel file(written(folder, bar, Interpolation::Linear, {bar.cage.mesh.nodes}));
  EXPECT_EQ(file.materials("bar"), (std::vector<std::string>{"gr\xC3\xBCn", "latin gr?n", "\xED\x95\x9C\"\\"}));
}

TEST(GlbWriter, RefusesWhatItCannotHold) {
  const TempFolder folder;
  const CagedBar bar;
  GlbWriter writer = glbWriterOf(folder.path("a.glb"));
  TriangleMesh points = bar.mesh;
  points.triangles.clear();
  points.groups.clear();
  const auto none = writer.addModel("points", bar.cage, points, bar.embedding, Interpolation::Linear);
  expectError(none, StatusCode::Empty, {"a.glb", "points, which has no triangles"});
  writer.addBody(writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, Interpolation::Linear).value(), "bar");
  Points nodes = bar.cage.mesh.nodes;
  expectError(writer.addFrame({}), kSizeMismatch, {"0 bodies", "has 1"});
  expectError(writer.addFrame({viewOf(nodes)}, {Eigen::Affine3d::Identity()}), kSizeMismatch, {"objects"});
  nodes.pop_back();
  expectError(writer.addFrame({viewOf(nodes)}), kSizeMismatch, {"44 nodes", "45"});
  nodes = bar.cage.mesh.nodes;
  nodes[7].y() = std::numeric_limits<double>::quiet_NaN();
  expectError(writer.addFrame({viewOf(nodes)}), kNonFinite, {"a.glb", "node 7 of body 0"});
  expectError(writer.finish(), StatusCode::Empty, {"a.glb", "nothing to show"});
  EXPECT_EQ(folder.fileCount(), 0u);
  expectError(GlbWriter::create(folder.path("b.glb"), 0.0), StatusCode::InvalidOption, {"frames per second"});
}

TEST(GlbWriter, CallsAfterItsEndAreErrors) {
  const TempFolder folder;
  const CagedBar bar;
  GlbWriter writer = glbWriterOf(folder.path("a.glb"));
  const std::size_t model = writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, Interpolation::Linear).value();
  writer.addBody(model, "bar");
  ASSERT_TRUE(writer.addFrame({viewOf(bar.cage.mesh.nodes)}).ok());
  ASSERT_TRUE(writer.finish().ok());
  const std::string written = TempFolder::read(folder.path("a.glb"));
  const StatusCode code = StatusCode::FileNotWritable;
  expectError(writer.addFrame({viewOf(bar.cage.mesh.nodes)}), code, {"finished", "another writer"});
  expectError(writer.addObject("floor", bar.mesh, false), code, {"finished"});
  expectError(writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, Interpolation::Linear).status(), code,
              {"finished"});
  writer.addBody(model, "bar");
  writer.setMaterials({});
  EXPECT_EQ(writer.bytesFor(10), 0.0);
  expectError(writer.finish(), code, {"finished"});
  EXPECT_EQ(TempFolder::read(folder.path("a.glb")), written);
}

TEST(GlbWriter, NamesAFolderThatItCannotWriteToBeforeTheRun) {
  const TempFolder folder;
  expectError(GlbWriter::create(folder.path("no/a.glb"), 60.0), StatusCode::FileNotWritable, {"no/a.glb"});
  expectError(GlbWriter::create(folder.path(), 60.0), StatusCode::FileNotWritable, {"is a folder"});
}

TEST(GlbWriter, LeavesTheOldFileUntilTheNewOneIsComplete) {
  const TempFolder folder;
  const CagedBar bar;
  const std::string path = folder.write("a.glb", "old");
  const auto begun = [&] {
    GlbWriter writer = glbWriterOf(path);
    writer.addBody(writer.addModel("bar", bar.cage, bar.mesh, bar.embedding, Interpolation::Linear).value(), "bar");
    EXPECT_TRUE(writer.addFrame({viewOf(bar.cage.mesh.nodes)}).ok());
    return writer;
  };
  { const GlbWriter abandoned = begun(); }
  EXPECT_EQ(TempFolder::read(path), "old");
#ifndef _WIN32
  GlbWriter writer = begun();
  const Status status = onAFullDisk(1000, [&] { return writer.finish(); });
  expectError(status, StatusCode::FileNotWritable, {path, "cannot be written"});
  EXPECT_EQ(TempFolder::read(path), "old");
#endif
  EXPECT_EQ(folder.fileCount(), 1u);
}

}  // namespace
}  // namespace tetskin::test
