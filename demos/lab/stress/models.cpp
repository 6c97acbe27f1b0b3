// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/models.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/bar.h"
#include "scenes/caged_mesh.h"
#include "scenes/slotted_beam.h"

namespace tetskin::stress {
namespace {

constexpr std::size_t kTriangles = 2000, kTets = 200;
constexpr std::size_t kLargeTets = 300000;
constexpr std::size_t kMillionTriangles = 2000000;  ///< makes three million vertices

using Carried = scenes::CagedMesh;

/// The bar along x, in tets without volume fractions.
Carried makeBarModel(std::size_t triangles, std::size_t tets) {
  Carried bar = scenes::inWorld(scenes::makeBar(triangles), tets);
  return {std::move(bar.mesh), TetMesh(std::move(bar.cage).mesh)};
}

/// Made only once, as nearly all cases use it.
const Carried& smallBar() {
  static const Carried bar = makeBarModel(kTriangles, kTets);
  return bar;
}

const Carried& slottedBeam() {
  static const Carried beam = scenes::inWorld(scenes::makeSlottedBeam(kTriangles), kTets);
  return beam;
}

TetMesh oneTetAround(const Box3& box) {
  // Corners of the simplex x, y, z >= 0, x + y + z <= 3, which contains the unit cube.
  TetMesh cage;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(0, 0, 3)}) {
    cage.nodes.emplace_back(box.min() + p.cwiseProduct(box.sizes()));
  }
  cage.tets.push_back({0, 1, 2, 3});
  return cage;
}

/// Puts tets of no volume first, where the lowest index would win: three of one edge's nodes and a node on it, ...
void addFlatTets(TetMesh& cage) {
  std::vector<Tet> flat;
  for (std::size_t t = 0; t < cage.tetCount(); t += 10) {
    const Tet tet = cage.tets[t];
    const int centroid = static_cast<int>(cage.nodeCount());
    cage.nodes.emplace_back((cage.nodes[tet[0]] + cage.nodes[tet[1]] + cage.nodes[tet[2]]) / 3.0);
    flat.push_back({tet[0], tet[1], tet[2], centroid});
  }
  cage.tets.insert(cage.tets.begin(), flat.begin(), flat.end());
}

/// The criterion of `createSoftBody`: six-fold volume below a billionth of the longest edge's cube.
bool isFlat(const TetMesh& cage, const Tet& tet) {
  constexpr double kFlat = 1e-9;
  const Eigen::Vector3d p[4] = {cage.nodes[tet[0]], cage.nodes[tet[1]], cage.nodes[tet[2]], cage.nodes[tet[3]]};
  double longest = 0.0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 4; ++b) longest = std::max(longest, (p[a] - p[b]).norm());
  }
  const double volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
  return !(std::abs(volume) > kFlat * longest * longest * longest);
}

void scale(StressModel& model, const Eigen::Vector3d& factors) {
  for (auto* points : {&model.cage.mesh.nodes, &model.mesh.positions}) {
    for (Eigen::Vector3d& p : *points) p = p.cwiseProduct(factors);
  }
  model.size *= factors.maxCoeff();
}

void applyCage(Cage cage, StressModel& model) {
  switch (cage) {
    case Cage::Bar:
    case Cage::Split:
    case Cage::Large:
      return;
    case Cage::FlatTets:
      return addFlatTets(model.cage.mesh);
    case Cage::NeedleTets:
      return scale(model, {1.0, 1e-4, 1e-4});
    case Cage::SliverTets:
      return scale(model, {1.0, 1e-8, 1.0});
    case Cage::AllFlat:
      return scale(model, {1.0, 1e-12, 1.0});
    case Cage::Inverted:
      for (std::size_t t = 0; t < model.cage.mesh.tetCount(); t += 2)
        std::swap(model.cage.mesh.tets[t][2], model.cage.mesh.tets[t][3]);
      return;
    case Cage::Duplicates:
      model.cage.mesh.tets.insert(model.cage.mesh.tets.end(), smallBar().cage.mesh.tets.begin(),
                                  smallBar().cage.mesh.tets.end());
      return;
    case Cage::Unreferenced:
      for (int k = 0; k < 10; ++k) model.cage.mesh.nodes.emplace_back(0.1 * k - 0.5, 0.3, 0.0);
      return;
    case Cage::Far1e5:
      model.offset = Eigen::Vector3d(1e5 * scenes::kSize, 0, 0);
      return;
    case Cage::Far1e7:
      model.offset = Eigen::Vector3d(1e7 * scenes::kSize, 0, 0);
      return;
    case Cage::Tiny:
      return scale(model, Eigen::Vector3d::Constant(1e-4));
    case Cage::Huge:
      return scale(model, Eigen::Vector3d::Constant(1e4));
    case Cage::OneTet:
      model.cage = oneTetAround(boundingBox(model.mesh.positions));
      model.size = boundingBox(model.cage.mesh.nodes).sizes().maxCoeff();
      return;
  }
}

TriangleMesh repeated(const TriangleMesh& mesh, const std::vector<double>& scales) {
  TriangleMesh all;
  for (const double scale : scales) {
    const int first = static_cast<int>(all.vertexCount());
    for (const Eigen::Vector3d& p : mesh.positions) all.positions.emplace_back(scale * p);
    for (const auto& t : mesh.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

void applySurface(Surface surface, TriangleMesh& mesh) {
  switch (surface) {
    case Surface::Bar:
      return;
    case Surface::FarOutside:
      mesh = repeated(mesh, {1.0, 1.2, 10.0, 1000.0});
      return;
    case Surface::Coincident:
      mesh = repeated(mesh, {1.0, 1.0, 1.0});
      return;
    case Surface::NonFinite:
      mesh.positions[mesh.vertexCount() / 2].y() = std::numeric_limits<double>::quiet_NaN();
      return;
    case Surface::ThreeMillion:
      mesh = repeated(makeBarModel(kMillionTriangles, kTets).mesh, {1.0, 0.9, 0.8});
      return;
    case Surface::NoVertices:
      mesh = {};
      return;
  }
}

Carried carriedBy(Cage cage) {
  if (cage == Cage::Large) return makeBarModel(kTriangles, kLargeTets);
  return cage == Cage::Split ? slottedBeam() : smallBar();
}

}  // namespace

StressModel makeModel(Cage cage, Surface surface) {
  StressModel model;
  const Carried carried = carriedBy(cage);
  model.cage = carried.cage;
  model.mesh = carried.mesh;
  model.mesh.groups.clear();
  applySurface(surface, model.mesh);
  applyCage(cage, model);
  model.bodyCage = model.cage;
  auto& tets = model.bodyCage.mesh.tets;
  const auto flat = [&](const Tet& tet) { return isFlat(model.cage.mesh, tet); };
  if (cage != Cage::AllFlat) tets.erase(std::remove_if(tets.begin(), tets.end(), flat), tets.end());
  return model;
}

}  // namespace tetskin::stress
