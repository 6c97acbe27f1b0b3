// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/reference.h"

#include "report/cage_skin.h"
#include "report/driven_nodes.h"
#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

MeshSkin<double> quadraticSkinOf(const Cage& cage, const TriangleMesh& mesh) {
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  options.normals = Normals::Transformed;
  return skinOf(cage, mesh, options);
}

/// A cage with a map, by which other cages' nodes find its duplicate tets, though it was made without a map.
Cage mapped(Cage cage, const Embedding& embedding) {
  cage.vertexTets.clear();
  for (const VertexBinding& binding : embedding.bindings()) cage.vertexTets.push_back(binding.tet);
  return cage;
}

void update(MeshSkin<double>& skin, const std::vector<Eigen::Vector3f>& nodes) {
  const Points current = toDouble(nodes);
  if (skin.update(viewOf(current)) != StatusCode::Ok)
    throw scenes::InputError("the reference has node positions that are not finite");
}

}  // namespace

Points toDouble(const std::vector<Eigen::Vector3f>& nodes) {
  Points result;
  result.reserve(nodes.size());
  for (const Eigen::Vector3f& p : nodes) result.emplace_back(p.cast<double>());
  return result;
}

SimulatedReference::SimulatedReference(const TriangleMesh& mesh, const Cage& cage, const Trajectory& trajectory)
    : mesh_(mesh),
      trajectory_(trajectory),
      skin_(quadraticSkinOf(cage, mesh)),
      cage_(mapped(cage, skin_.binding()->embedding())) {}

const ReferenceSurface& SimulatedReference::surfaceAt(int frame) {
  update(skin_, trajectory_[static_cast<std::size_t>(frame)]);
  const std::size_t count = skin_.positions().size();
  surface_.positions.resize(count);
  surface_.normals.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    surface_.positions[v] = Eigen::Map<const Eigen::Vector3d>(skin_.positions()[v]);
    surface_.normals[v] = Eigen::Map<const Eigen::Vector3f>(skin_.normals()[v]).cast<double>();
  }
  return surface_;
}

Trajectory SimulatedReference::drive(const Cage& cage) const {
  DrivenNodes nodes(mesh_, cage_, cage);
  Trajectory driven;
  for (const std::vector<Eigen::Vector3f>& frame : trajectory_) driven.push_back(nodes.positionsAt(toDouble(frame)));
  return driven;
}

ExactReference::ExactReference(const TriangleMesh& mesh, const scenes::Twist& map)
    : mesh_(mesh), map_(map), restNormals_(restNormals(mesh)) {}

scenes::Twist ExactReference::twistAt(int frame) const {
  scenes::Twist twist = map_;
  if (frame == 0) twist.turn = 0.0;
  return twist;
}

const ReferenceSurface& ExactReference::surfaceAt(int frame) {
  const scenes::Twist twist = twistAt(frame);
  surface_.positions.clear();
  surface_.normals.clear();
  for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) {
    surface_.positions.push_back(twist.point(mesh_.positions[v]));
    surface_.normals.push_back(twist.normal(mesh_.positions[v], restNormals_[v]));
  }
  return surface_;
}

Trajectory ExactReference::drive(const Cage& cage) const {
  Trajectory driven(2);
  for (int frame = 0; frame < 2; ++frame) {
    for (const Eigen::Vector3d& p : cage.mesh.nodes) driven[frame].emplace_back(twistAt(frame).point(p).cast<float>());
  }
  return driven;
}

}  // namespace tetskin::report
