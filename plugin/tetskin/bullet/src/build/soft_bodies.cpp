// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/build/soft_bodies.h>
#include <tetskin/bullet/src/search/body_contacts.h>
#include <tetskin/bullet/src/state/bullet_members.h>

#include <algorithm>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// By tet: see BodyParts::rest.
constexpr std::size_t kRestNumbers = 10;

template <class Values>
bool areFinite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](auto x) { return std::isfinite(x); });
}

void visitQuadratic(BuildStream& stream, QuadraticShape& shape) {
  stream.plain(shape.tet.nodes.data(), shape.tet.nodes.size());
  stream.plain(shape.tet.tets.data(), shape.tet.tets.size());
  stream.plain(shape.rest.nodes.data(), shape.rest.nodes.size());
  stream.plain(shape.rest.gradients.data(), shape.rest.gradients.size());
  stream.plain(shape.rest.points.data(), shape.rest.points.size());
  visitAll(stream, shape.rest.volume, shape.share);
}

bool isValid(const QuadraticShape& shape, std::size_t nodes, std::size_t tets) {
  return areBelow(shape.tet.nodes, nodes) && areBelow(shape.tet.tets, tets) && areBelow(shape.rest.nodes, nodes) &&
         areFinite(shape.rest.gradients) && areFinite(shape.rest.points) && shape.rest.volume > 0.0 &&
         shape.share > 0.0 && std::isfinite(shape.rest.volume) && std::isfinite(shape.share);
}

template <class Stream, class Patch>
void visitPatch(Stream& stream, Patch& patch) {
  visitAll(stream, patch.firstNode, patch.nodeCount, patch.firstPoint, patch.pointCount, patch.firstWeight,
           patch.divisions, patch.spread);
}

void visitPatches(BuildStream& stream, ContactPatches& patches) {
  stream.each(patches.patches, [&](ContactPatch& patch) { visitPatch(stream, patch); });
  stream.each(patches.clusters, [&](PatchCluster& c) {
    visitAll(stream, c.firstPatch, c.patchCount, c.firstNode, c.nodeCount, c.spread);
  });
  stream.array(patches.nodes);
  stream.array(patches.clusterNodes);
  stream.array(patches.weights);
  auto points = static_cast<std::uint64_t>(patches.pointCount);
  stream(points);
  patches.pointCount = static_cast<std::size_t>(points);
  patches.tree.visitState(stream);
  stream.array(patches.clusterOf);
}

bool fits(std::uint64_t first, std::uint64_t count, std::size_t size) {
  return first + count <= size;
}

bool isValid(const ContactPatches& p, std::size_t nodes) {
  for (const ContactPatch& patch : p.patches) {
    const std::uint64_t corners = patch.isTriangle() ? 3 : patch.pointCount;
    if (patch.nodeCount > kMaxCarriers || patch.divisions > 0xFFFF || !std::isfinite(patch.spread)) return false;
    if (!fits(patch.firstNode, patch.nodeCount, p.nodes.size())) return false;
    if (!fits(patch.firstWeight, corners * patch.nodeCount, p.weights.size())) return false;
  }
  for (const PatchCluster& cluster : p.clusters) {
    if (!fits(cluster.firstPatch, cluster.patchCount, p.patches.size()) || !std::isfinite(cluster.spread)) return false;
    if (!fits(cluster.firstNode, cluster.nodeCount, p.clusterNodes.size())) return false;
  }
  for (std::size_t n = 0; n < p.clusterOf.size(); ++n) {
    const bool leaf = n < p.tree.nodes().size() && p.tree.nodes()[n].isLeaf();
    if (leaf != (p.clusterOf[n] >= 0) || p.clusterOf[n] >= static_cast<int>(p.clusters.size())) return false;
  }
  return p.clusterOf.size() == p.tree.nodes().size() && p.tree.isValid() &&
         areBelow(p.tree.items(), p.patches.size()) && areBelow(p.nodes, nodes) && areBelow(p.clusterNodes, nodes) &&
         areFinite(p.weights) && !p.patches.empty();
}

}  // namespace

void BodyParts::readFrom(BuildStream& stream, const btSoftBody& body) {
  const BodyWithTrees* own = bodyWithTrees(body);
  if (!own || own->createdAt().size() != static_cast<std::size_t>(body.m_nodes.size())) {
    return stream.refuse("a soft body that got nodes after it was created");
  }
  if (body.m_deformableAnchors.size() > 0) return stream.refuse("an anchor of a soft body");
  for (const btVector3& p : own->createdAt()) nodes.insert(nodes.end(), {p.x(), p.y(), p.z()});
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    const btSoftBody::Tetra& tet = body.m_tetras[t];
    for (const btSoftBody::Node* node : tet.m_n) tets.push_back(static_cast<int>(node - &body.m_nodes[0]));
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) rest.push_back(tet.m_Dm_inverse[row][k]);
    }
    rest.push_back(tet.m_element_measure);
  }
  links = body.m_links.size();
  faces = body.m_faces.size();
  faceTree = !own->hasNoFaceTree();
  filters.readFrom(body);
}

void BodyParts::visit(BuildStream& stream) {
  filters.visit(stream);
  visitAll(stream, links, faces, forceModel, faceTree, weightPressure, material.youngsModulus, material.poissonRatio,
           material.damping, settings.tolerance, settings.iterations);
  stream.array(masses);
  stream.copied([this](BuildStream& bytes) {
    bytes.array(nodes);
    bytes.array(tets);
    bytes.array(rest);
    bytes.array(restNodes);
    bytes.array(stiffnessScale);
    bytes.each(quadratic, [&](QuadraticShape& shape) { visitQuadratic(bytes, shape); });
  });
  if (stream.saving()) return;
  const std::size_t nodeCount = nodes.size() / 3, tetCount = tets.size() / 4;
  const bool sizes = nodes.size() == 3 * nodeCount && tets.size() == 4 * tetCount && masses.size() == nodeCount &&
                     rest.size() == kRestNumbers * tetCount &&
                     (restNodes.empty() || restNodes.size() == nodes.size()) &&
                     (stiffnessScale.empty() || stiffnessScale.size() == tetCount);
  const bool kind = forceModel >= 0 && forceModel < static_cast<int>(ForceModel::MassSpring);
  stream.require(sizes && kind && areFinite(rest) && areFinite(restNodes) && std::isfinite(weightPressure),
                 "a soft body is damaged");
  for (const QuadraticShape& shape : quadratic) {
    stream.require(isValid(shape, nodeCount, tetCount), "a quadratic tet is damaged");
  }
  stream.require(settings.tolerance >= 0.0 && settings.tolerance < 1.0 && settings.iterations >= 1,
                 "a soft body has damaged settings");
}

SoftBodyOptions BodyParts::options() const {
  SoftBodyOptions options;
  options.forceModel = static_cast<ForceModel>(forceModel);
  options.nodeMasses.assign(masses.begin(), masses.end());
  options.solverTolerance = settings.tolerance;
  options.maxIterations = settings.iterations;
  options.faceTree = faceTree;
  options.configureWorld = false;
  if (options.forceModel == ForceModel::Corotated) options.stiffnessScale = stiffnessScale;
  return options;
}

std::unique_ptr<btSoftBody> BodyParts::build(BuildStream& stream, const SoftBodyOptions& options) const {
  if (stream.failed()) return nullptr;
  TetMesh mesh;
  for (std::size_t k = 0; k < nodes.size(); k += 3) {
    mesh.nodes.emplace_back(static_cast<double>(nodes[k]), static_cast<double>(nodes[k + 1]),
                            static_cast<double>(nodes[k + 2]));
  }
  for (std::size_t k = 0; k < tets.size(); k += 4)
    mesh.tets.push_back({tets[k], tets[k + 1], tets[k + 2], tets[k + 3]});
  Result<BuiltBody> built = buildBody(mesh, stream.world().getWorldInfo(), options);
  if (!built.ok()) {
    stream.refuse(built.status().message);
    return nullptr;
  }
  btSoftBody& body = *built.value().body;
  if (body.m_links.size() != links || body.m_faces.size() != faces) {
    stream.refuse("a soft body that got links or faces after it was created");
    return nullptr;
  }
  const btScalar* numbers = rest.data();
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    for (int row = 0; row < 3; ++row, numbers += 3) {
      body.m_tetras[t].m_Dm_inverse[row].setValue(numbers[0], numbers[1], numbers[2]);
    }
    body.m_tetras[t].m_element_measure = *numbers++;
  }
  body.setUserIndex(filters.userIndex);
  return std::move(built.value().body);
}

std::unique_ptr<PointSearch> buildSurfaceContact(BuildStream& stream, btSoftBody& body) {
  BodyWithTrees* own = bodyWithTrees(body);
  const std::shared_ptr<BodyContacts> contacts = stream.saving() && own ? own->surfaceContacts().lock() : nullptr;
  bool there = contacts != nullptr;
  stream(there);
  if (!there || !own) return nullptr;
  ContactPatches patches;
  SearchDistances distances;
  if (contacts) {
    patches = contacts->search().patches();
    distances = {0, contacts->search().slack(), contacts->thickness(), own->reach()};
  }
  visitAll(stream, distances.slack, distances.thickness, distances.beyondNodes);
  stream.copied([&](BuildStream& bytes) { visitPatches(bytes, patches); });
  if (contacts || stream.failed()) return nullptr;
  const bool sound = distances.slack >= 0 && distances.thickness >= 0 && distances.beyondNodes >= 0 &&
                     std::isfinite(distances.slack + distances.thickness + distances.beyondNodes);
  stream.require(sound && isValid(patches, static_cast<std::size_t>(body.m_nodes.size())),
                 "the contact of a surface is damaged");
  if (stream.failed()) return nullptr;
  return std::make_unique<PointSearch>(stream.world(), *own, std::move(patches), distances);
}

}  // namespace tetskin::bullet_detail
