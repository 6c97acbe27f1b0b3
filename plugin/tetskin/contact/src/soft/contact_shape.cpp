// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/other_components.h>
#include <tetskin/contact/src/soft/sample_normals.h>
#include <tetskin/contact/src/soft/surface_thickness.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>

namespace tetskin {
namespace contact_detail {
namespace {

/// Height above a triangle at which a point is tested for being inside another component, in sides of the mesh's box.
constexpr double kOverTriangle = 1e-4;
/// Divisions of a tet along each weight: 64 cells.
constexpr int kCellsAlong = 4;
static_assert(kCellsAlong * kCellsAlong * kCellsAlong <= 64, "CarriedCells has 64 bits");
/// Elements per leaf of the trees: few enough that a leaf's box is tight, many enough that fitting is cheap.
constexpr int kLeafSize = kLanes;
/// Added around the weights of a run's samples: more than rounding can change them.
constexpr btScalar kWeightMargin = btScalar(1e-3);

/// Default number of samples per node of the cage's surface, and the bounds of the total.
constexpr std::size_t kSamplesPerNode = 30, kFewSamples = 2000, kManySamples = 8000;

/// Few samples are used per node. With fewer than these, a pile of cubes takes longer to come to rest; with fewer than
/// the vertices, details finer than the cage enter other bodies: in the heap of `tetskin_pile` by 2.6 % of the body's
/// size instead of 0.5.
std::size_t defaultSampleCount(const Cage& cage, const TriangleMesh& mesh) {
  std::vector<char> atSurface(cage.mesh.nodes.size(), 0);
  for (const std::array<int, 3>& face : boundaryFaces(cage.mesh)) {
    for (const int n : face) atSurface[static_cast<std::size_t>(n)] = 1;
  }
  const auto nodes = static_cast<std::size_t>(std::count(atSurface.begin(), atSurface.end(), 1));
  return std::clamp(std::max(kSamplesPerNode * nodes, mesh.vertexCount()), kFewSamples, kManySamples);
}

Status checkOptions(const ContactShapeOptions& options) {
  if (options.sampleCount && (*options.sampleCount < 1 || *options.sampleCount > 10'000'000)) {
    return {StatusCode::InvalidOption, "the number of samples of a contact shape must be between 1 and 10,000,000"};
  }
  if (options.gridResolution && (*options.gridResolution < 4 || *options.gridResolution > 1024)) {
    return {StatusCode::InvalidOption, "the number of cells of a contact shape's grid must be between 4 and 1,024"};
  }
  return {};
}

/// Default number of cells of the grid, and the bound of corners if parts are thinner than two cells.
constexpr int kUsualCells = 64;
constexpr double kMostCorners = 4e5;
/// Cells along the longest side of the box. If the usual number would hardly give one cell in the body's thickness,
/// enough for two, within the bound.
int cellsFor(const TriangleMesh& mesh, const std::vector<int>& visible, const TriangleBvh& surface, const Box3& box) {
  constexpr double kSeen = 1.25;  // of a cell: ensures that a corner is inside
  const double size = box.sizes().maxCoeff(), seen = kSeen * size / kUsualCells;
  const double thickness = usualThickness(mesh, visible, surface, seen);
  if (!(thickness < seen)) return kUsualCells;
  int cells = static_cast<int>(std::ceil(2 * size / std::max(thickness, size / 512)));
  while (cells > kUsualCells && cornersOfGrid(box, cells) > kMostCorners) cells -= 1 + cells / 100;
  return std::max(cells, kUsualCells);
}

Status checkInput(const Cage& cage, const TriangleMesh& mesh, const ContactShapeOptions& options) {
  if (Status status = checkOptions(options); !status.ok()) return status;
  if (Status status = validate(mesh); !status.ok()) return status;
  if (mesh.triangles.empty()) return {StatusCode::Empty, "the mesh has no triangles; contact needs a surface"};
  if (Status status = validate(cage.mesh); !status.ok()) return status;
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  if (!cage.vertexTets.empty() && cage.vertexTets.size() != mesh.vertexCount()) {
    return {StatusCode::SizeMismatch, "the cage was built for a mesh of " + std::to_string(cage.vertexTets.size()) +
                                          " vertices, not of " + std::to_string(mesh.vertexCount())};
  }
  return {};
}

/// True if the normals point inwards, by the sign of the enclosed volume, computed relative to the first triangle's
/// first corner.
bool facesInwards(const TriangleMesh& mesh) {
  assert(!mesh.triangles.empty());
  double volume = 0.0;
  const Eigen::Vector3d& origin = mesh.positions[static_cast<std::size_t>(mesh.triangles[0][0])];
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto from = [&](int v) -> Eigen::Vector3d { return mesh.positions[static_cast<std::size_t>(v)] - origin; };
    volume += from(a).dot(from(b).cross(from(c)));
  }
  return volume < 0.0;
}

/// Triangles with at least one corner, or the centroid, outside of the solid that all triangles bound.
std::vector<int> visibleTriangles(const TriangleMesh& mesh, const WindingTree& solid) {
  const double over = kOverTriangle * surfaceBox(mesh).sizes().maxCoeff();
  std::vector<int> visible;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Eigen::Vector3d normal = (q - p).cross(r - p);
    if (!(normal.norm() > 0.0)) continue;
    const Eigen::Vector3d step = over * normal.normalized();
    const Eigen::Vector3d centroid = (p + q + r) / 3.0;
    const auto isOut = [&](const Eigen::Vector3d& at) { return solid.windingNumber(at + step) < kInside; };
    if (isOut(centroid) || isOut(p) || isOut(q) || isOut(r)) visible.push_back(static_cast<int>(t));
  }
  return visible;
}

/// By sample: the tet that carries it.
std::vector<int> tetsOf(const Cage& cage, const std::vector<SurfaceSample>& samples, Status& status) {
  std::vector<int> tets(samples.size());
  if (!cage.vertexTets.empty()) {
    const CageLocator locator(cage);
    std::transform(samples.begin(), samples.end(), tets.begin(), [&](const SurfaceSample& s) {
      return s.vertex >= 0 ? cage.vertexTets[static_cast<std::size_t>(s.vertex)] : locator.locate(s.point, s.corners);
    });
    return tets;
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(samples.size());
  for (const SurfaceSample& s : samples) points.push_back(s.point);
  const Result<Embedding> embedded = embed(static_cast<const TetMesh&>(cage.mesh), viewOf(points));
  status = embedded.status();
  if (!status.ok()) return tets;
  const std::vector<VertexBinding> bindings = embedded.value().bindings();
  std::transform(bindings.begin(), bindings.end(), tets.begin(), [](const VertexBinding& b) { return b.tet; });
  return tets;
}

void appendSample(const TetMesh& cage, int tet, const Eigen::Vector3d& rest, ShapeData& data) {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < cage.tetCount());
  EmbeddedPoint<btScalar>& point = data.samples.emplace_back();
  point.tet = tet;
  point.nodes = cage.tets[static_cast<std::size_t>(tet)];
  const TetCorners corners = cornersOf(cage, point.nodes);
  const BarycentricMap map(corners);
  const Eigen::Vector4d weights = map(rest);
  const Eigen::Vector4d clamped = map(closestPointInTet(rest, corners, weights)).cwiseMax(0.0);
  point.inside = weights.minCoeff() >= 0.0;
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    point.weights[i] = static_cast<btScalar>(weights[k]);
    point.clampedWeights[i] = static_cast<btScalar>(clamped[k] / clamped.sum());
    data.weights[i].push_back(point.weights[i]);
  }
  int main = 0;
  clamped.maxCoeff(&main);
  data.sampleNodes.push_back(point.nodes[static_cast<std::size_t>(main)]);
  data.sampleRest.push_back(toBullet(rest));
}

/// Sorts the samples by tet. Leaves out those of flat tets, in which no weights can be computed.
void makeRuns(const TetMesh& cage, const std::vector<SurfaceSample>& samples, const std::vector<btVector3>& normals,
              const std::vector<int>& tets, ShapeData& data) {
  assert(tets.size() == samples.size() && normals.size() == samples.size());
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tets[a] < tets[b]; });
  for (const std::size_t s : order) {
    if (isFlat(cornersOf(cage, cage.tets[static_cast<std::size_t>(tets[s])]))) continue;
    const int index = static_cast<int>(data.samples.size());
    if (data.runs.empty() || data.runs.back().tet != tets[s]) data.runs.push_back({tets[s], index, index});
    appendSample(cage, tets[s], samples[s].point, data);
    data.sampleNormals.push_back(normals[s]);
    data.runs.back().last = index + 1;
  }
  // The samples of the last run are also read in fours.
  for (std::vector<btScalar>& weights : data.weights) weights.resize(weights.size() + kLanes - 1);
}

ContactBox restBox(const ShapeData& data, int tet) {
  ContactBox box;
  for (const int n : data.tets[static_cast<std::size_t>(tet)]) box.extend(data.nodes[static_cast<std::size_t>(n)]);
  return box;
}

/// Computed from points of the tet that are so close together that the distance hardly changes between them.
TetSubregion filledSubregion(const ShapeData& data, const Tet& nodes, btScalar size) {
  assert(data.grid.spacing() > 0 && size >= 0);
  const int along = 2 + static_cast<int>(size / data.grid.spacing());
  const btScalar step = 1 / static_cast<btScalar>(along);
  const btScalar reach = kReachCubes * data.grid.spacing() + size * step;
  TetSubregion region;
  std::fill(region.minimum, region.minimum + 4, btScalar(1));
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; i + j <= along; ++j) {
      for (int k = 0; i + j + k <= along; ++k) {
        const btScalar w[4] = {i * step, j * step, k * step, (along - i - j - k) * step};
        btVector3 p(0, 0, 0);
        for (std::size_t n = 0; n < 4; ++n) p += w[n] * data.nodes[static_cast<std::size_t>(nodes[n])];
        GridDistance known;
        if (data.grid.at(p, known) && known.distance > reach) continue;
        for (int n = 0; n < 4; ++n) {
          const btScalar least = w[n] - step;
          region.minimum[n] = std::min(region.minimum[n], least > 0 ? least : kMinWeight);
        }
      }
    }
  }
  region.left = 1 - region.minimum[0] - region.minimum[1] - region.minimum[2] - region.minimum[3];
  return region;
}

void makeTrees(const TetMesh& cage, ShapeData& data) {
  assert(data.nodes.size() == cage.nodeCount() && data.tets.size() == cage.tetCount());
  std::vector<ContactBox> tetBoxes, runBoxes;
  std::vector<int> filled, runs(data.runs.size());
  for (std::size_t t = 0; t < data.tets.size(); ++t) {
    tetBoxes.push_back(restBox(data, static_cast<int>(t)));
    const Tet& n = data.tets[t];
    const TetCorners corners = cornersOf(cage, cage.tets[t]);
    data.filled.push_back(filledSubregion(data, n, static_cast<btScalar>(tetSize(corners))));
    if (!isFlat(corners) && data.filled.back().left > 0) filled.push_back(static_cast<int>(t));
  }
  for (const SampleRun& run : data.runs) runBoxes.push_back(tetBoxes[static_cast<std::size_t>(run.tet)]);
  std::iota(runs.begin(), runs.end(), 0);
  data.runTree = SearchTree(Bvh(runBoxes, runs, kLeafSize));
  data.tetTree = SearchTree(Bvh(tetBoxes, filled, kLeafSize));
}

void makeGroups(ShapeData& data) {
  for (const Bvh::Node& node : data.tetTree.tree.nodes()) {
    if (!node.isLeaf()) continue;
    assert(node.last - node.first <= kLanes);
    TetGroup& group = data.groups.emplace_back();
    group.fill(-1);
    for (int k = node.first; k < node.last; ++k) {
      group[static_cast<std::size_t>(k - node.first)] = data.tetTree.tree.item(k);
    }
  }
}

/// By run: the smallest weights of its samples.
void boundRuns(ShapeData& data) {
  for (const SampleRun& run : data.runs) {
    TetSubregion part;
    part.left = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto first = data.weights[k].begin();
      part.minimum[k] = *std::min_element(first + run.first, first + run.last) - kWeightMargin;
      part.left -= part.minimum[k];
    }
    data.runRegions.push_back(part);
    data.largestSpread = std::max(data.largestSpread, part.spread());
  }
}

/// True if a run and a tet are near at rest, both in space and along the body.
bool nearAtRest(const ShapeData& data, std::size_t run, int tet) {
  const btVector3& a = data.centroids[static_cast<std::size_t>(data.runs[run].tet)];
  const btScalar apart = kEdgesApart * data.edge;
  if (!((a - data.centroids[static_cast<std::size_t>(tet)]).length2() < apart * apart)) return false;
  const std::vector<int>& others = data.otherComponents[run];
  return !std::binary_search(others.begin(), others.end(), tet);
}

void findNearGroups(ShapeData& data) {
  assert(data.otherComponents.size() == data.runs.size());
  data.nearGroups.resize(data.runs.size());
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    for (std::size_t g = 0; g < data.groups.size(); ++g) {
      NearGroup found;
      found.group = static_cast<int>(g);
      for (std::size_t k = 0; k < kLanes; ++k) {
        found.near[k] = data.groups[g][k] >= 0 && nearAtRest(data, r, data.groups[g][k]);
      }
      if (found.near != NearGroup{}.near) data.nearGroups[r].push_back(found);
    }
  }
}

/// The numbers of tets that have duplicates.
std::vector<int> copiedTets(const Cage& cage) {
  std::map<int, std::vector<int>> atPlace;
  for (std::size_t t = 0; t < cage.sourceTet.size(); ++t) atPlace[cage.sourceTet[t]].push_back(static_cast<int>(t));
  std::vector<int> copied;
  for (const auto& [index, tets] : atPlace) {
    if (tets.size() > 1) copied.insert(copied.end(), tets.begin(), tets.end());
  }
  return copied;
}

/// A point of a cell; `along` is from 0 to 1 in each direction.
Eigen::Vector3d pointOfCell(const TetCorners& corners, int cell, const Eigen::Vector3d& along) {
  assert(cell >= 0 && cell < kCellsAlong * kCellsAlong * kCellsAlong);
  const Eigen::Vector3i at(cell % kCellsAlong, cell / kCellsAlong % kCellsAlong, cell / kCellsAlong / kCellsAlong);
  const Eigen::Vector3d low = at.cast<double>();
  Eigen::Vector3d w = (low + along) / kCellsAlong;
  if (w.sum() > 1.0) w /= w.sum();
  return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] + (1.0 - w.sum()) * corners[3];
}

/// The cells of a tet that contain a point whose nearest triangle is connected with the tet.
CarriedCells carriedCells(const Cage& cage, int tet, const CageLocator& locator, const TriangleMesh& mesh,
                          const TriangleBvh& surface) {
  CarriedCells cells{0};
  const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[static_cast<std::size_t>(tet)]);
  for (int cell = 0; cell < kCellsAlong * kCellsAlong * kCellsAlong; ++cell) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d along(corner & 1 ? 0.9 : 0.1, corner & 2 ? 0.9 : 0.1, corner & 4 ? 0.9 : 0.1);
      const Eigen::Vector3d p = pointOfCell(corners, cell, along);
      const int triangle = surface.nearest(p).triangle;
      assert(triangle >= 0);
      if (locator.locate(p, mesh.triangles[static_cast<std::size_t>(triangle)]) != tet) continue;
      cells.bits |= std::uint64_t{1} << cell;
      break;
    }
  }
  return cells;
}

void findCopies(const Cage& cage, const TriangleMesh& mesh, const TriangleBvh& surface, ShapeData& data) {
  if (cage.vertexTets.empty() || !cage.hasDuplicates()) return;
  const CageLocator locator(cage);
  data.carried.assign(cage.mesh.tetCount(), {});
  for (const int tet : copiedTets(cage)) {
    data.carried[static_cast<std::size_t>(tet)] = carriedCells(cage, tet, locator, mesh, surface);
  }
}

}  // namespace

SearchTree::SearchTree(Bvh from) : tree(std::move(from)) {
  const std::vector<Bvh::Node>& nodes = tree.nodes();
  past.resize(nodes.size());
  for (std::size_t n = nodes.size(); n-- > 0;) {
    past[n] = nodes[n].isLeaf() ? static_cast<int>(n) + 1 : past[static_cast<std::size_t>(nodes[n].right)];
  }
  int leaves = 0;
  for (const Bvh::Node& node : nodes) leafOf.push_back(node.isLeaf() ? leaves++ : -1);
}

int CarriedCells::cellOf(const btScalar weights[4]) {
  int cell = 0;
  for (int k = 2; k >= 0; --k) {
    const int along = static_cast<int>(weights[k] * kCellsAlong);
    cell = kCellsAlong * cell + std::min(std::max(along, 0), kCellsAlong - 1);
  }
  return cell;
}

}  // namespace contact_detail

using contact_detail::ShapeData;

ContactShape::ContactShape(std::unique_ptr<const ShapeData> data) : data_(std::move(data)) {}
ContactShape::~ContactShape() = default;

std::size_t ContactShape::nodeCount() const {
  return data_->nodes.size();
}
std::size_t ContactShape::tetCount() const {
  return data_->tets.size();
}
std::size_t ContactShape::sampleCount() const {
  return data_->samples.size();
}

Result<std::shared_ptr<const ContactShape>> ContactShape::create(const Cage& cage, const TriangleMesh& mesh,
                                                                 const ContactShapeOptions& options) {
  using namespace contact_detail;
  if (Status status = checkInput(cage, mesh, options); !status.ok()) return status;
  const WindingTree solid(mesh);
  const std::vector<int> visible = visibleTriangles(mesh, solid);
  const TriangleBvh surface(mesh, visible);
  auto data = std::make_unique<ShapeData>();
  const Box3 box = boundingBox(cage.mesh.nodes);
  const int cells = options.gridResolution ? *options.gridResolution : cellsFor(mesh, visible, surface, box);
  if (!visible.empty()) data->grid = DistanceGrid(surface, solid, box, cells);
  if (!data->grid.hasInside()) {
    return Status{StatusCode::Degenerate,
                  facesInwards(mesh)
                      ? "the mesh's triangles face inwards; reverse their orientation"
                      : "the mesh encloses no volume that a grid of " + std::to_string(cells) +
                            " cells along its longest side resolves: close the mesh, or give a larger gridResolution"};
  }
  const std::vector<SurfaceSample> samples =
      sampleSurface(mesh, visible, options.sampleCount.value_or(defaultSampleCount(cage, mesh)));
  Status status;
  const std::vector<int> tets = tetsOf(cage, samples, status);
  if (!status.ok()) return status;
  for (const Eigen::Vector3d& p : cage.mesh.nodes) data->nodes.push_back(toBullet(p));
  data->tets = cage.mesh.tets;
  for (const Tet& n : data->tets) {
    data->centroids.push_back((data->nodes[n[0]] + data->nodes[n[1]] + data->nodes[n[2]] + data->nodes[n[3]]) / 4);
  }
  data->edge = static_cast<btScalar>(meanEdge(cage.mesh));
  makeRuns(cage.mesh, samples, sampleNormals(mesh, visible, samples, data->grid), tets, *data);
  makeTrees(cage.mesh, *data);
  findCopies(cage, mesh, surface, *data);
  makeGroups(*data);
  boundRuns(*data);
  data->otherComponents = tetsOfOtherComponents(*data);
  findNearGroups(*data);
  return Access<ContactShape>::create(std::move(data));
}

}  // namespace tetskin
