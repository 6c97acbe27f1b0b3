// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/forces/forced_bodies.h>
#include <tetskin/solver/src/forces/node_vectors.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace tetskin::bullet_detail {
namespace {

/// By how much a tet may differ from its nodes at rest, as a share of its size, because rest shapes are rounded tet by
/// tet. A cage's nodes have no such bound: the tets were made of rounded nodes, wherever in the world the body was
/// created.
constexpr double kRoundedTets = 3e-5;

/// 0: it is pinned.
btScalar massOf(const btSoftBody::Node& node) {
  return node.m_im > 0 ? 1 / node.m_im : btScalar(0);
}

Status badTet(std::size_t tet, const char* fault) {
  return {StatusCode::Degenerate, "tet " + std::to_string(tet) + fault};
}

bool hasRestShape(const btSoftBody::Tetra& tet) {
  btScalar size = 0;
  for (int i = 0; i < 3; ++i) size += tet.m_Dm_inverse[i].length2();
  return tet.m_element_measure > 0 && size > 0 && std::isfinite(size);
}

}  // namespace

btScalar restMeasureOf(const btSoftBody& body) {
  assert(body.m_tetras.size() > 0);
  btScalar sum = 0;
  const int last = body.m_tetras.size() - 1;
  for (const int t : {0, last / 3, 2 * last / 3, last}) {
    const btSoftBody::Tetra& tetra = body.m_tetras[t];
    sum += tetra.m_element_measure;
    for (int i = 0; i < 3; ++i) sum += tetra.m_Dm_inverse[i].length2();
  }
  return sum;
}

/// Bullet's own `transform` would take the present lengths of links for rest lengths. A node whose position did not
/// change in double keeps it.
void carryNodes(btSoftBody& body, Dynamics* dynamics, const Placement& placement) {
  const int count = body.m_nodes.size();
  if (dynamics && dynamics->nodeCount() != static_cast<std::size_t>(count)) dynamics = nullptr;
  std::vector<bool> exact(static_cast<std::size_t>(count), false);
  for (std::size_t n = 0; n < exact.size() && dynamics; ++n) {
    btScalar point[3];
    toPoint(body.m_nodes[static_cast<int>(n)].m_x, point);
    exact[n] = dynamics->isAt(n, point);
  }
  if (dynamics) dynamics->carry(placement.turns, placement.turn, placement.by);
  for (int n = 0; n < count; ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    const auto at = static_cast<std::size_t>(n);
    const bool led = node.m_q != node.m_x;
    placement.place(node.m_x, node.m_q);
    if (exact[at]) {
      btScalar point[3];
      dynamics->rounded(at, point);
      node.m_x = fromPoint(point);
    }
    if (!led) node.m_q = node.m_x;
    placement.rotate(node.m_v, node.m_vn, node.m_splitv, node.m_n);
  }
  for (int f = 0; f < body.m_faces.size(); ++f) placement.rotate(body.m_faces[f].m_normal);
  body.updateNodeTree(false, false);
  const BodyWithTrees* own = bodyWithTrees(body);
  if (!own || !own->hasNoFaceTree()) body.updateFaceTree(false, false);
  body.updateBounds();
}

void readNodes(const btSoftBody& body, Dynamics& dynamics) {
  assert(dynamics.nodeCount() == static_cast<std::size_t>(body.m_nodes.size()));
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    const auto at = static_cast<std::size_t>(n);
    toPoint(node.m_x, dynamics.point(at));
    toPoint(node.m_v, dynamics.velocity(at));
    dynamics.setMass(at, massOf(node));
  }
}

Result<elastic_detail::RestTets> restTetsOf(const btSoftBody& body) {
  if (body.m_tetras.size() == 0) {
    return Status{StatusCode::Degenerate, "the body has no tets; for cloth and ropes, use Bullet's mass-spring force"};
  }
  elastic_detail::RestTets rest;
  rest.tets = readTetMesh(body).tets;
  for (std::size_t t = 0; t < rest.count(); ++t) {
    const btSoftBody::Tetra& tetra = body.m_tetras[static_cast<int>(t)];
    if (std::count(rest.tets[t].begin(), rest.tets[t].end(), -1) > 0) {
      return badTet(t,
                    " refers to a node that the body does not have: Bullet leaves tets dangling when nodes are "
                    "appended after them; append the nodes first");
    }
    if (!hasRestShape(tetra)) {
      return badTet(
          t,
          " of the body has no volume at rest, or no rest shape; call initializeDmInverse() of the body after "
          "its tets have been appended");
    }
    std::array<double, 9>& gradients = rest.gradients.emplace_back();
    for (std::size_t k = 0; k < gradients.size(); ++k) {
      const btVector3& row = tetra.m_Dm_inverse[static_cast<int>(k / 3)];
      gradients[k] = static_cast<double>(row[static_cast<int>(k % 3)]);
    }
    rest.volumes.push_back(static_cast<double>(tetra.m_element_measure));
  }
  return rest;
}

Status checkMaterial(const ElasticMaterial& material) {
  return elastic_detail::checkMaterial<btScalar>(material.youngsModulus, material.poissonRatio, material.damping);
}

namespace {

/// Of a body's tets, and of all its nodes, if pinned ones have as much as the others; 0: all are pinned.
struct Matter {
  double mass = 0.0, volume = 0.0;
};

Matter matterOf(const btSoftBody& body) {
  Matter matter;
  int free = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_im == 0) continue;
    matter.mass += 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    ++free;
  }
  if (free == 0) return {};
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    matter.volume += static_cast<double>(body.m_tetras[t].m_element_measure);
  }
  matter.mass = matter.mass * body.m_nodes.size() / free;
  return matter;
}

}  // namespace

Status checkStiffness(const btSoftBody& body, const ElasticMaterial& material,
                      const elastic_detail::MaterialChanges& changes) {
  const Matter matter = matterOf(body);
  return changes.checkStiffness<btScalar>(material.youngsModulus, material.damping, matter.mass, matter.volume);
}

Status checkPressure(const btSoftBody& body, double pressure) {
  const Matter matter = matterOf(body);
  return elastic_detail::checkPressure<btScalar>(pressure, matter.mass, matter.volume);
}

Status checkGas(const btSoftBody& body, double pressure, double outside) {
  const Matter matter = matterOf(body);
  return elastic_detail::checkGas<btScalar>(pressure, outside, matter.mass, matter.volume);
}

void ForcedBody::build(const elastic_detail::RestTets& linear, const ElasticMaterial& material) {
  assert(body && linear.count() == static_cast<std::size_t>(body->m_tetras.size()));
  if (stiffnessScale.size() != linear.count()) stiffnessScale.clear();
  if (paintedDamping.size() != linear.count()) paintedDamping.clear();
  const bool sameTets = dynamics && tetCount == linear.count();
  if (dynamics && !sameTets) quadratic.clear();
  if (!sameTets) changes = elastic_detail::MaterialChanges(linear.count(), paintedDamping);
  tetCount = linear.count();
  const double lastSeconds = dynamics ? dynamics->lastSeconds() : 0.0;
  const auto nodes = static_cast<std::size_t>(body->m_nodes.size());
  elastic_detail::RestTets exact = linear;
  if (linear.nodes.empty() || !takeRestShapes(exact)) {
    findRestNodes(exact, nodes);
    takeRestShapes(exact, kRoundedTets);
  }
  dynamics = std::make_unique<Dynamics>(withQuadraticTets(exact, stiffnessScale, quadratic), nodes);
  dynamics->setLastSeconds(lastSeconds);
  restMeasure = restMeasureOf(*body);
  setMaterial(material);
  pressure.moveTo(*dynamics, sameTets);
}

void ForcedBody::setMaterial(const ElasticMaterial& material) {
  assert(dynamics);
  dynamics->setMaterial(elastic_detail::lameOf(material.youngsModulus, material.poissonRatio));
  applyChanges(material);
}

void ForcedBody::applyShapes(const ElasticMaterial& material) {
  changes.applyShapesTo(*dynamics, material.poissonRatio, material.youngsModulus);
}

void ForcedBody::applyChanges(const ElasticMaterial& material) {
  changes.applyTo(*dynamics, material.poissonRatio, material.youngsModulus, material.damping);
}

void ForcedBody::reset(const ElasticMaterial& material) {
  assert(hasItsRestShapes());
  elastic_detail::RestTets linear = restTetsOf(*body).value();
  linear.nodes = dynamics->tets()->rest().nodes;
  dynamics->setLastSeconds(0.0);
  build(linear, material);
}

elastic_detail::BodyProbe<btScalar> ForcedBody::probe() const {
  elastic_detail::BodyProbe<btScalar> probe(dynamics->matrix());
  assert(hasOwnCounts());
  for (int n = 0; n < body->m_nodes.size(); ++n)
    toPoint(body->m_nodes[n].m_x, probe.point(static_cast<std::size_t>(n)));
  return probe;
}

bool ForcedBody::hasOwnCounts() const {
  assert(body && dynamics);
  return dynamics->nodeCount() == static_cast<std::size_t>(body->m_nodes.size()) &&
         tetCount == static_cast<std::size_t>(body->m_tetras.size());
}

bool ForcedBody::hasItsRestShapes() const {
  return hasOwnCounts() && restMeasureOf(*body) == restMeasure;
}

/// A body that was scaled or got nodes since the last step gets new dynamics at the beginning of the next.
void ForcedBody::serialize(WorldStream& stream, const ElasticMaterial& material) {
  changes.serialize(stream);
  if (stream.restoring()) applyChanges(material);
  constexpr std::uint8_t kCurrent = 1, kPressure = 2;  // bits
  auto flags = static_cast<std::uint8_t>((hasItsRestShapes() ? kCurrent : 0) | (pressure.acts() ? kPressure : 0));
  stream(flags);
  elastic_detail::PressureLaw law = pressure.law();
  if ((flags & kPressure) == 0) law = {};
  if ((flags & kPressure) != 0) law.serialize(stream);
  if (stream.restoring() && law != pressure.law() && !pressure.restore(law, *dynamics).ok()) stream.fail();
  if ((flags & kCurrent) == 0) {
    double seconds = dynamics->lastSeconds();
    stream(seconds);
    dynamics->setLastSeconds(seconds);
    if (stream.restoring()) restMeasure = -1;
    return;
  }
  bool outdated = false, continues = true;
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body->m_nodes[n];
    const auto at = static_cast<std::size_t>(n);
    const btScalar mass = massOf(node);
    if (stream.restoring()) {
      dynamics->setMass(at, mass);
    } else {
      outdated |= dynamics->matrix().mass(at) != mass;
      // Pinned nodes are led to where the application puts them: the next step finds out whether they jump.
      continues &= !(node.m_im > 0) || dynamics->continues(at, node.m_x, node.m_vn);
    }
  }
  dynamics->serialize(stream, outdated, continues, [&](std::size_t n, btScalar(&velocity)[3]) {
    const btSoftBody::Node& node = body->m_nodes[static_cast<int>(n)];
    btVector3 reached = node.m_vn;
    if (node.m_im == 0) {
      // The application may since have stopped it, or moved it on.
      if (stream.saving()) reached = fromPoint(velocity);
      stream(reached);
    }
    toPoint(reached, velocity);
  });
}

}  // namespace tetskin::bullet_detail
