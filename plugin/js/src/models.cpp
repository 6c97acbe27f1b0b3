// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages.
#include "guarded.h"

#include <emscripten.h>
#include <facade/models.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/material_changes.h>
#include <tetskin/io/files.h>

#include <cstdio>
#include <functional>
#include <memory>

namespace tetskin::js {
namespace {

// NOLINTNEXTLINE: the macro's own
EM_JS(int, tellProgress, (double fraction), { return Module["progress"](fraction); });

std::function<bool(double)> progressIf(bool wanted) {
  if (!wanted) return {};
  return [](double fraction) { return tellProgress(fraction) != 0; };
}

std::vector<Eigen::Vector3d> pointsOf(const Doubles& numbers) {
  std::vector<Eigen::Vector3d> points(numbers.count / 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Eigen::Map<const Eigen::Vector3d>(numbers.begin() + 3 * i);
  return points;
}
template <class Row>
std::vector<Row> floatRows(const Doubles& numbers) {
  constexpr std::size_t kColumns = Row::RowsAtCompileTime;
  std::vector<Row> rows(numbers.count / kColumns);
  for (std::size_t i = 0; i < kColumns * rows.size(); ++i)
    rows[i / kColumns][static_cast<int>(i % kColumns)] = static_cast<float>(numbers.begin()[i]);
  return rows;
}
template <std::size_t K>
std::vector<std::array<int, K>> indexRows(const Indices& indices) {
  std::vector<std::array<int, K>> rows(indices.count / K);
  for (std::size_t i = 0; i < K * rows.size(); ++i) rows[i / K][i % K] = indices.begin()[i];
  return rows;
}

/// A file in the module's in-memory file system, while it is read.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& extension, const unsigned char* bytes, std::size_t count)
      : path_("/file." + extension) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path_.c_str(), "wb"), std::fclose);
    if (!file || std::fwrite(bytes, 1, count, file.get()) != count) throw std::bad_alloc();
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

MeshModel readMesh(std::uintptr_t bytes, std::size_t count, std::string extension) {
  const TemporaryFile file(extension, reinterpret_cast<const unsigned char*>(bytes), count);
  return {std::make_shared<const TriangleMesh>(take(loadMesh(file.path())))};
}

View loadVertexMapOf(std::uintptr_t bytes, std::size_t count, std::string extension, std::string name) {
  const TemporaryFile file(extension, reinterpret_cast<const unsigned char*>(bytes), count);
  return lent(take(loadVertexMap(file.path(), name)));
}

MeshModel createMesh(Doubles positions, Indices triangles, Doubles normals, Doubles texcoords) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = pointsOf(positions);
  mesh->triangles = indexRows<3>(triangles);
  mesh->normals = floatRows<Eigen::Vector3f>(normals);
  mesh->texcoords = floatRows<Eigen::Vector2f>(texcoords);
  checkMesh(*mesh);
  return {std::move(mesh)};
}

MeshModel meshFromBytes(std::uintptr_t bytes, std::size_t count) {
  return meshOfBytes(reinterpret_cast<const unsigned char*>(bytes), count);
}
template <class Model>
View lentBytes(const Model& model) {
  std::vector<unsigned char> bytes;
  writeBytes(model, [&](std::size_t count) {
    bytes.resize(count);
    return bytes.data();
  });
  return lent(std::move(bytes));
}
View meshToBytes(const MeshModel& model) {
  return lentBytes(model);
}
View meshPositions(const MeshModel& model) {
  return viewNumbers(model.mesh->positions.front().data(), 3 * model.mesh->vertexCount());
}
View meshTriangles(const MeshModel& model) {
  const auto& triangles = model.mesh->triangles;
  return viewNumbers(triangles.empty() ? nullptr : triangles[0].data(), 3 * triangles.size());
}
View meshNormals(const MeshModel& model) {
  const auto& normals = model.mesh->normals;
  return viewNumbers(normals.empty() ? nullptr : normals[0].data(), 3 * normals.size());
}
View meshTexcoords(const MeshModel& model) {
  const auto& texcoords = model.mesh->texcoords;
  return viewNumbers(texcoords.empty() ? nullptr : texcoords[0].data(), 2 * texcoords.size());
}
View meshRestNormals(const MeshModel& model) {
  std::vector<float> numbers;
  for (const Eigen::Vector3d& normal : restNormals(*model.mesh))
    for (const double x : normal) numbers.push_back(static_cast<float>(x));
  return lent(std::move(numbers));
}
View meshBounds(const MeshModel& model) {
  const Box3 box = boundingBox(model.mesh->positions);
  return lent(
      std::vector<double>{box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
}

/// By value, like calibrateCage: the progress function may delete the mesh that is being used.
CageModel createCageOf(MeshModel mesh, double targetTets, bool duplicateElements, bool fit, Doubles stiffness,
                       Doubles density, Doubles damping, bool tells) {
  if (!(targetTets >= 1 && targetTets <= static_cast<double>(Limits::kMaxTargetTets)))
    fail(StatusCode::InvalidOption, "targetTets: must be from 1 to " + std::to_string(Limits::kMaxTargetTets));
  CageOptions options;
  options.targetTets = static_cast<std::size_t>(targetTets);
  options.duplicateElements = duplicateElements;
  options.fit = fit;
  options.stiffness.assign(stiffness.begin(), stiffness.end());
  options.density.assign(density.begin(), density.end());
  options.damping.assign(damping.begin(), damping.end());
  options.progress = progressIf(tells);
  CageReport report;
  Cage cage = take(createCage(*mesh.mesh, options, &report));
  return cageModel(std::move(cage), report.describe());
}

CageModel calibrateCage(CageModel model, double poissonRatio, int modeCount, bool tells) {
  CalibrationOptions options;
  options.poissonRatio = poissonRatio;
  options.modeCount = modeCount;
  options.progress = progressIf(tells);
  Cage cage = *model.cage;
  const CalibrationReport report = take(calibrate(cage, options));
  return cageModel(std::move(cage), model.cage->report + report.describe());
}

CageModel paintedCage(const CageModel& model, const MeshModel& mesh, Doubles stiffness, Doubles density,
                      Doubles damping) {
  Cage cage = *model.cage;
  PaintedMaps maps;
  maps.stiffness.assign(stiffness.begin(), stiffness.end());
  maps.density.assign(density.begin(), density.end());
  maps.damping.assign(damping.begin(), damping.end());
  check(paintCage(cage, *mesh.mesh, maps));
  return cageModel(std::move(cage), model.cage->report);
}
/// Returns the values of tets, and then those of nodes.
View spreadMapOf(const CageModel& model, const MeshModel& mesh, Doubles values, bool geometric) {
  const MapMean mean = geometric ? MapMean::Geometric : MapMean::Arithmetic;
  SpreadMap map = take(spreadMap(*model.cage, *mesh.mesh, {values.begin(), values.end()}, mean));
  map.tets.insert(map.tets.end(), map.nodes.begin(), map.nodes.end());
  return lent(std::move(map.tets));
}
View fibresAlongOf(const CageModel& model, Indices tets, Doubles curve) {
  const std::vector<int> of(tets.begin(), tets.end());
  const TetMesh& mesh = model.cage->mesh;
  for (const int t : of) {
    if (t < 0 || static_cast<std::size_t>(t) >= mesh.tetCount())
      fail(StatusCode::IndexOutOfRange, "tets: there is no tet " + std::to_string(t));
  }
  std::vector<double> numbers;
  for (const Eigen::Vector3d& fibre : take(fibresAlong(mesh, of, pointsOf(curve))))
    numbers.insert(numbers.end(), fibre.data(), fibre.data() + 3);
  return lent(std::move(numbers));
}

CageModel quadraticCage(const CageModel& model) {
  return cageModel(take(refineQuadratic(*model.cage)));
}
CageModel scaledCage(const CageModel& model, double scale) {
  if (!(scale > 0.0 && scale < Limits::kMaxCoordinate))
    throw std::invalid_argument("scale: must be above 0, and finite");
  Cage cage = *model.cage;
  cage.scaleBy(scale);
  check(validate(cage));
  return cageModel(std::move(cage), model.cage->report);
}
CageModel cageOfTets(Doubles nodes, Indices tets) {
  TetMesh mesh;
  mesh.nodes = pointsOf(nodes);
  mesh.tets = indexRows<4>(tets);
  check(validate(mesh));
  (void)repairTetMesh(mesh);
  return cageModel(Cage(std::move(mesh)));
}

CageModel cageFromBytes(std::uintptr_t bytes, std::size_t count) {
  return cageOfBytes(reinterpret_cast<const unsigned char*>(bytes), count);
}
View cageToBytes(const CageModel& model) {
  return lentBytes(model);
}
View cageNodes(const CageModel& model) {
  return viewNumbers(model.cage->mesh.nodes.front().data(), 3 * model.cage->mesh.nodeCount());
}
View cageTets(const CageModel& model) {
  return viewNumbers(model.cage->mesh.tets.front().data(), 4 * model.cage->mesh.tetCount());
}
View cageVertexTets(const CageModel& model) {
  return viewNumbers(model.cage->vertexTets.data(), model.cage->vertexTets.size());
}
View cageQuadraticTet(const CageModel& model) {
  return viewNumbers(model.cage->quadraticTet.data(), model.cage->quadraticTet.size());
}
View cagePaintedStiffness(const CageModel& model) {
  return viewNumbers(model.cage->paintedStiffness.data(), model.cage->paintedStiffness.size());
}
View cageMasses(const CageModel& model) {
  return viewNumbers(model.cage->masses.data(), model.cage->masses.size());
}
template <std::size_t K>
View lentRows(const std::vector<std::array<int, K>>& rows) {
  std::vector<int> numbers;
  for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return lent(std::move(numbers));
}
View cageEdges(const CageModel& model) {
  return lentRows(uniqueEdges(model.cage->mesh));
}
View cageBoundaryFaces(const CageModel& model) {
  return lentRows(boundaryFaces(model.cage->mesh));
}
std::string cageReport(const CageModel& model) {
  return model.cage->report;
}

}  // namespace

EMSCRIPTEN_BINDINGS(models) {
  emscripten::value_object<Doubles>("Doubles").field("at", &Doubles::at).field("count", &Doubles::count);
  emscripten::value_object<Indices>("Indices").field("at", &Indices::at).field("count", &Indices::count);
  emscripten::value_object<View>("View").field("at", &View::at).field("count", &View::count);
  emscripten::class_<MeshModel>("Mesh");
  expose<&readMesh>("readMesh");
  expose<&loadVertexMapOf>("loadVertexMap");
  expose<&createMesh>("createMesh");
  expose<&meshFromBytes>("meshFromBytes");
  expose<&meshToBytes>("meshToBytes");
  expose<&meshPositions>("meshPositions");
  expose<&meshTriangles>("meshTriangles");
  expose<&meshNormals>("meshNormals");
  expose<&meshTexcoords>("meshTexcoords");
  expose<&meshRestNormals>("meshRestNormals");
  expose<&meshBounds>("meshBounds");
  emscripten::class_<CageModel>("Cage");
  expose<&createCageOf>("createCage");
  expose<&calibrateCage>("calibrate");
  expose<&paintedCage>("paintCage");
  expose<&spreadMapOf>("spreadMap");
  expose<&fibresAlongOf>("fibresAlong");
  expose<&quadraticCage>("refineQuadratic");
  expose<&scaledCage>("scaledCage");
  expose<&cageOfTets>("cageOfTets");
  expose<&cageFromBytes>("cageFromBytes");
  expose<&cageToBytes>("cageToBytes");
  expose<&cageNodes>("cageNodes");
  expose<&cageTets>("cageTets");
  expose<&cageVertexTets>("cageVertexTets");
  expose<&cageQuadraticTet>("cageQuadraticTet");
  expose<&cagePaintedStiffness>("cagePaintedStiffness");
  expose<&cageMasses>("cageMasses");
  expose<&cageEdges>("cageEdges");
  expose<&cageBoundaryFaces>("cageBoundaryFaces");
  expose<&cageReport>("cageReport");
}

}  // namespace tetskin::js
