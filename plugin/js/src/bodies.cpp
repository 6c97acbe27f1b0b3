// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::js {
namespace {

/// As JavaScript gives them; what is not given is no number.
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
  options.surfaceContact = soft.surfaceContact;
  options.softContact = soft.softContact;
  options.selfContact = soft.selfContact;
  options.contactMargin = given(soft.contactMargin);
  options.sampleSpacing = given(soft.sampleSpacing);
  return options;
}

void checkNodes(const Indices& nodes, std::size_t count) {
  for (const std::int32_t node : nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      fail(StatusCode::IndexOutOfRange, "nodes: there is no node " + std::to_string(node));
  }
}
std::size_t nodeCount(BodyHandle& body) {
  return body.state->cage.cage->mesh.nodeCount();
}

/// mesh  null: none
BodyHandle* addBody(WorldHandle& handle, const CageModel& cage, const MeshModel* mesh, SoftOptions soft,
                    Indices pinned) {
  const BodyOptions options = optionsOf(soft);
  checkNodes(pinned, cage.cage->mesh.nodeCount());
  if (!mesh && (soft.softContact || soft.selfContact))
    fail(StatusCode::Unbound, "a body without a mesh has no surface to be in contact with others");
  auto body = std::make_unique<BodyHandle>(BodyHandle{handle.world, {}, {}, {}});
  body->state =
      handle.world->addBody(cage, mesh ? *mesh : MeshModel(), placementOf(soft.position, soft.rotation), options);
  BodyState& state = *body->state;
  try {
    for (const std::int32_t node : pinned) check(state.body->setPinned(node));
    if (state.binding && !soft.visible) state.skin.setVisible(false);
  } catch (...) {  // as if nothing had been added
    handle.world->remove(state);
    throw;
  }
  return body.release();
}
void remove(BodyHandle& body) {
  body.world->remove(*body.state);
}

/// Bullet keeps a node's numbers far apart.
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

/// Three numbers for each of so many nodes.
PointView<const double> checked(const Doubles& numbers, std::size_t count, const char* name) {
  if (numbers.count != 3 * count)
    fail(StatusCode::SizeMismatch,
         std::string(name) + ": " + std::to_string(numbers.count) + " numbers for " + std::to_string(count) + " nodes");
  const PointView<const double> points(numbers.begin(), count);
  if (firstUnusable(points) != count)
    fail(StatusCode::NonFinite, std::string(name) + ": a number is not finite, or larger than 1e18");
  return points;
}
btVector3 vectorAt(const PointView<const double>& points, std::size_t i) {
  return {static_cast<btScalar>(points[i][0]), static_cast<btScalar>(points[i][1]),
          static_cast<btScalar>(points[i][2])};
}

void setVelocities(BodyHandle& body, Doubles numbers) {
  btSoftBody& soft = alive(*body.state).body();
  const PointView<const double> points = checked(numbers, nodeCount(body), "velocities");
  for (std::size_t i = 0; i < points.size(); ++i) {
    btSoftBody::Node& node = soft.m_nodes[static_cast<int>(i)];
    if (node.m_im > 0) node.m_v = vectorAt(points, i);
  }
  soft.activate(true);
}

void setPinned(BodyHandle& body, Indices nodes, bool pinned) {
  DeformableBody& soft = alive(*body.state);
  checkNodes(nodes, nodeCount(body));
  for (const std::int32_t node : nodes) check(soft.setPinned(node, pinned));
}
void setPinnedPositions(BodyHandle& body, Indices nodes, Doubles positions) {
  DeformableBody& soft = alive(*body.state);
  checkNodes(nodes, nodeCount(body));
  const PointView<const double> points = checked(positions, nodes.count, "positions");
  for (const std::int32_t node : nodes) {
    if (!soft.isPinned(node)) fail(StatusCode::InvalidOption, "nodes: node " + std::to_string(node) + " is not pinned");
  }
  for (std::size_t i = 0; i < nodes.count; ++i) check(soft.setPinnedPosition(nodes.begin()[i], vectorAt(points, i)));
}
View pinned(BodyHandle& body) {
  const DeformableBody& soft = alive(*body.state);
  std::vector<unsigned char> mask(nodeCount(body));
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = soft.isPinned(static_cast<int>(i));
  return lent(std::move(mask));
}

View positions(BodyHandle& body) {
  (void)alive(*body.state);
  checkSurface(*body.state);
  return viewNumbers(body.state->positions.data(), body.state->positions.size());
}
View normals(BodyHandle& body) {
  (void)alive(*body.state);
  checkSurface(*body.state);
  return viewNumbers(body.state->normals.data(), body.state->normals.size());
}
View bounds(BodyHandle& body) {
  (void)alive(*body.state);
  checkSurface(*body.state);
  const Box3& box = body.state->skin.bounds();
  return lent(
      std::vector<double>{box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
}
bool visible(BodyHandle& body) {
  return body.state->skin.visible();
}
void setVisible(BodyHandle& body, bool visible) {
  (void)alive(*body.state);
  checkSurface(*body.state);
  body.state->skin.setVisible(visible);
}

bool asleep(BodyHandle& body) {
  return !alive(*body.state).body().isActive();
}
double mass(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().getTotalMass());
}
double youngsModulus(BodyHandle& body) {
  return alive(*body.state).youngsModulus();
}
void setYoungsModulus(BodyHandle& body, double pressure) {
  check(alive(*body.state).setYoungsModulus(pressure));
}
double relativeStiffness(BodyHandle& body) {
  return alive(*body.state).relativeStiffness();
}
double poissonRatio(BodyHandle& body) {
  return alive(*body.state).poissonRatio();
}
void setPoissonRatio(BodyHandle& body, double ratio) {
  check(alive(*body.state).setPoissonRatio(ratio));
}
double stiffnessDamping(BodyHandle& body) {
  return alive(*body.state).stiffnessDamping();
}
void setStiffnessDamping(BodyHandle& body, double seconds) {
  check(alive(*body.state).setStiffnessDamping(seconds));
}
double friction(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().m_cfg.kDF);
}
void setFriction(BodyHandle& body, double friction) {
  if (!(friction >= 0.0 && friction <= 1.0)) fail(StatusCode::InvalidOption, "friction: must be from 0 to 1");
  alive(*body.state).body().m_cfg.kDF = static_cast<btScalar>(friction);
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
  expose<&youngsModulus>("youngsModulus");
  expose<&setYoungsModulus>("setYoungsModulus");
  expose<&relativeStiffness>("relativeStiffness");
  expose<&poissonRatio>("poissonRatio");
  expose<&setPoissonRatio>("setPoissonRatio");
  expose<&stiffnessDamping>("stiffnessDamping");
  expose<&setStiffnessDamping>("setStiffnessDamping");
  expose<&friction>("bodyFriction");
  expose<&setFriction>("setBodyFriction");
  expose<&setGravity>("setBodyGravity");
  expose<&followWorldGravity>("followWorldGravity");
  expose<&reset>("resetBody");
  expose<&transform>("transform");
  expose<&applyRadialImpulse>("applyRadialImpulse");
}

}  // namespace tetskin::js
