// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/forces/elastic_force.h>
#include <tetskin/solver/src/forces/node_vectors.h>

#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {

ElasticForce::ElasticForce(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                           const elastic_detail::RestTets& linear, const ElasticMaterial& material,
                           std::vector<double> stiffnessScale, std::vector<double> paintedDamping,
                           std::vector<QuadraticShape> quadratic, const SolverSettings& settings)
    : material_(material), settings_(settings) {
  assert(checkMaterial(material).ok());
  assert(stiffnessScale.empty() || stiffnessScale.size() == linear.count());
  assert(settings.tolerance >= 0.0 && settings.tolerance < 1.0 && settings.iterations >= 1);
  body_.body = &body;
  setWorld(world);
  body_.stiffnessScale = std::move(stiffnessScale);
  body_.paintedDamping = std::move(paintedDamping);
  body_.quadratic = std::move(quadratic);
  body_.build(linear, material);
}

void ElasticForce::setMaterial(const ElasticMaterial& material) {
  assert(checkMaterial(material).ok());
  material_ = material;
  body_.setMaterial(material);
}

void ElasticForce::reset() {
  body_.reset(material_);
}

void ElasticForce::setWorld(btDeformableMultiBodyDynamicsWorld& world) {
  body_.world = &world;
  body_.worldInfo = &world.getWorldInfo();
}

void ElasticForce::reinitialize(bool) {
  if (m_softBodies.size() == 0 || body_.hasItsRestShapes()) return;
  if (Result<elastic_detail::RestTets> rest = restTetsOf(*body_.body); rest.ok()) {
    body_.build(rest.value(), material_);
  } else if (!body_.hasOwnCounts()) {
    removeSoftBody(body_.body);
  }
}

double ElasticForce::totalElasticEnergy(btScalar) {
  if (m_softBodies.size() == 0 || !body_.body->isActive()) return 0.0;
  const auto& nodes = body_.body->m_nodes;
  assert(body_.dynamics->nodeCount() == static_cast<std::size_t>(nodes.size()));
  elastic_detail::BodyProbe<btScalar> probe(body_.dynamics->matrix());
  for (int n = 0; n < nodes.size(); ++n) toPoint(nodes[n].m_q, probe.point(static_cast<std::size_t>(n)));
  return body_.dynamics->energy(std::move(probe), nullptr);
}

void ElasticForce::serialize(WorldStream& stream) {
  body_.serialize(stream, material_);
}

void ElasticForce::checkState(WorldStream& stream) {
  stream.same(body_.body->m_nodes.size(), "a soft body has another number of nodes");
  stream.same(body_.body->m_tetras.size(), "a soft body has another number of tets");
  const std::uint64_t faces = body_.pressure.givenFaces(), quadratic = body_.quadratic.size();
  stream.same(quadratic + (faces << 32), "a soft body has other quadratic tets, or another surface of its pressure");
  stream.same(body_.dynamics->componentCount(), "a soft body has another number of parts");
  stream.same(body_.changes.muscleCount(), "a soft body has another number of muscles");
  const std::uint64_t fibres = body_.changes.fibresCount(), fibreTets = body_.changes.fibreTetCount();
  stream.same(fibres + (fibreTets << 32), "a soft body has other fibres");
  stream.same(restMeasureOf(*body_.body), "a soft body has another shape at rest, or was scaled");
}

}  // namespace tetskin::bullet_detail
