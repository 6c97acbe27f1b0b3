// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::js {
namespace {

/// The options from JavaScript; those not given are NaN.
struct SoftOptions {
  Vec3 position{};
  Quaternion rotation{0, 0, 0, 1};
  double density = 0, mass = 0, youngsModulus = 0, relativeStiffness = 0, poissonRatio = 0, stiffnessDamping = 0,
         friction = 0, margin = 0, solverTolerance = 0, contactMargin = 0, sampleSpacing = 0;
  int maxIterations = 0;
  std::string interpolation, normals;
  bool visible = true, surfaceContact = true, softContact = false, selfContact = false;
};

BodyOptions optionsOf(const SoftOptions& soft) {
  BodyOptions options;
  SoftBodyOptions& material = options.material;
  material.density = soft.density;
  material.mass = given(soft.mass);
  material.youngsModulus = given(soft.youngsModulus);
  material.relativeStiffness = soft.relativeStiffness;
  material.poissonRatio = soft.poissonRatio;
  material.stiffnessDamping = soft.stiffnessDamping;
  material.friction = soft.friction;
  material.margin = given(soft.margin);
  material.solverTolerance = soft.solverTolerance;
  material.maxIterations = soft.maxIterations;
  material.faceTree = false;
  options.binding = bindingOptions(soft.interpolation, soft.normals, "nearest", {});
  options.visible = soft.visible;
  options.surfaceContact = soft.surfaceContact;
  options.softContact = soft.softContact;
  options.selfContact = soft.selfContact;
  options.contactMargin = given(soft.contactMargin);
  options.sampleSpacing = given(soft.sampleSpacing);
  return options;
}

/// mesh  null: none
BodyHandle* addBody(WorldHandle& handle, const CageModel& cage, const MeshModel* mesh, SoftOptions soft,
                    Indices pinned) {
  BodyOptions options = optionsOf(soft);
  options.pinned.assign(pinned.begin(), pinned.end());
  auto body = std::make_unique<BodyHandle>(BodyHandle{handle.world, {}, {}, {}});
  body->state =
      handle.world->addBody(cage, mesh ? *mesh : MeshModel(), placementOf(soft.position, soft.rotation), options);
  return body.release();
}
void remove(BodyHandle& body) {
  body.world->remove(*body.state);
}

/// In Bullet, the numbers of different nodes are not contiguous.
template <class Of>
View gather(const btSoftBody& soft, std::vector<float>& numbers, Of&& vectorAt) {
  numbers.resize(3 * static_cast<std::size_t>(soft.m_nodes.size()));
  float* to = numbers.data();
  for (int i = 0; i < soft.m_nodes.size(); ++i) {
    const btVector3& v = vectorAt(soft.m_nodes[i]);
    *to++ = v.x();
    *to++ = v.y();
    *to++ = v.z();
  }
  return viewNumbers(numbers.data(), numbers.size());
}
View nodes(BodyHandle& body) {
  return gather(
      alive(*body.state).body(), body.nodes, [](const btSoftBody::Node& n) -> auto& { return n.m_x; });
}
View velocities(BodyHandle& body) {
  return gather(
      alive(*body.state).body(), body.velocities, [](const btSoftBody::Node& n) -> auto& { return n.m_v; });
}

void setVelocities(BodyHandle& body, Doubles numbers) {
  setVelocities(*body.state, numbers.begin(), numbers.count);
}
void setPinned(BodyHandle& body, Indices nodes, bool pinned) {
  setPinned(*body.state, {nodes.begin(), nodes.end()}, pinned);
}
void setPinnedPositions(BodyHandle& body, Indices nodes, Doubles positions) {
  setPinnedPositions(*body.state, {nodes.begin(), nodes.end()}, positions.begin(), positions.count);
}
View pinned(BodyHandle& body) {
  return lent(pinnedOf(*body.state));
}

View positions(BodyHandle& body) {
  (void)surfaceOf(*body.state);
  return viewNumbers(body.state->positions.data(), body.state->positions.size());
}
View normals(BodyHandle& body) {
  (void)surfaceOf(*body.state);
  return viewNumbers(body.state->normals.data(), body.state->normals.size());
}
View bounds(BodyHandle& body) {
  const Box3& box = surfaceOf(*body.state).bounds();
  return lent(
      std::vector<double>{box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
}
bool visible(BodyHandle& body) {
  return body.state->skin.visible();
}
void setVisible(BodyHandle& body, bool visible) {
  surfaceOf(*body.state).setVisible(visible);
}

bool asleep(BodyHandle& body) {
  return !alive(*body.state).body().isActive();
}
double mass(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().getTotalMass());
}
template <auto Get>
double read(BodyHandle& body) {
  return (alive(*body.state).*Get)();
}
template <auto Set>
void write(BodyHandle& body, double value) {
  check((alive(*body.state).*Set)(value));
}
double friction(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().m_cfg.kDF);
}
void setFriction(BodyHandle& body, double friction) {
  setFriction(*body.state, friction);
}
void setGravity(BodyHandle& body, Vec3 gravity) {
  check(alive(*body.state).setGravity(toBullet(gravity, "gravity")));
}
void followWorldGravity(BodyHandle& body) {
  alive(*body.state).followWorldGravity();
}
void transform(BodyHandle& body, Vec3 position, Quaternion rotation) {
  body.world->teleport(*body.state, toBullet(position, rotation));
}
void reset(BodyHandle& body) {
  body.world->reset(*body.state);
}
double applyRadialImpulse(BodyHandle& body, Vec3 centre, double radius, double strength) {
  finite({radius, strength, 0}, "radius, strength");
  const ImpulseResult result = body.world->radialImpulse(
      *body.state, {toBullet(centre, "centre"), static_cast<btScalar>(radius), static_cast<btScalar>(strength)});
  return static_cast<double>(result.vertices);
}

}  // namespace

EMSCRIPTEN_BINDINGS(bodies) {
  emscripten::value_object<SoftOptions>("BodyOptions")
      .field("position", &SoftOptions::position)
      .field("rotation", &SoftOptions::rotation)
      .field("density", &SoftOptions::density)
      .field("mass", &SoftOptions::mass)
      .field("youngsModulus", &SoftOptions::youngsModulus)
      .field("relativeStiffness", &SoftOptions::relativeStiffness)
      .field("poissonRatio", &SoftOptions::poissonRatio)
      .field("stiffnessDamping", &SoftOptions::stiffnessDamping)
      .field("friction", &SoftOptions::friction)
      .field("margin", &SoftOptions::margin)
      .field("solverTolerance", &SoftOptions::solverTolerance)
      .field("maxIterations", &SoftOptions::maxIterations)
      .field("contactMargin", &SoftOptions::contactMargin)
      .field("sampleSpacing", &SoftOptions::sampleSpacing)
      .field("interpolation", &SoftOptions::interpolation)
      .field("normals", &SoftOptions::normals)
      .field("visible", &SoftOptions::visible)
      .field("surfaceContact", &SoftOptions::surfaceContact)
      .field("softContact", &SoftOptions::softContact)
      .field("selfContact", &SoftOptions::selfContact);
  emscripten::class_<BodyHandle>("Body");
  expose<&addBody>("addBody");
  expose<&remove>("removeBody");
  expose<&nodes>("bodyNodes");
  expose<&velocities>("bodyVelocities");
  expose<&setVelocities>("setBodyVelocities");
  expose<&setPinned>("setPinned");
  expose<&setPinnedPositions>("setPinnedPositions");
  expose<&pinned>("pinned");
  expose<&positions>("bodyPositions");
  expose<&normals>("bodyNormals");
  expose<&bounds>("bodyBounds");
  expose<&visible>("visible");
  expose<&setVisible>("setVisible");
  expose<&asleep>("asleep");
  expose<&mass>("bodyMass");
  expose<&read<&DeformableBody::youngsModulus>>("youngsModulus");
  expose<&write<&DeformableBody::setYoungsModulus>>("setYoungsModulus");
  expose<&read<&DeformableBody::relativeStiffness>>("relativeStiffness");
  expose<&read<&DeformableBody::poissonRatio>>("poissonRatio");
  expose<&write<&DeformableBody::setPoissonRatio>>("setPoissonRatio");
  expose<&read<&DeformableBody::stiffnessDamping>>("stiffnessDamping");
  expose<&write<&DeformableBody::setStiffnessDamping>>("setStiffnessDamping");
  expose<&friction>("bodyFriction");
  expose<&setFriction>("setBodyFriction");
  expose<&setGravity>("setBodyGravity");
  expose<&followWorldGravity>("followWorldGravity");
  expose<&reset>("resetBody");
  expose<&transform>("transform");
  expose<&applyRadialImpulse>("applyRadialImpulse");
}

}  // namespace tetskin::js
