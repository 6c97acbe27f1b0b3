// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::js {
namespace {

/// An option's value for JavaScript, and back.
template <class T>
const T& shown(const T& option) {
  return option;
}
double shown(const std::optional<double>& option) {
  return option.value_or(std::numeric_limits<double>::quiet_NaN());
}
template <class Of>
const std::string& shown(const Choice<Of>& option) {
  return option.name;
}
template <class T>
void read(const T& value, T& option) {
  option = value;
}
void read(double value, std::optional<double>& option) {
  option = given(value);
}
template <class Of>
void read(const std::string& value, Choice<Of>& option) {
  option.name = value;
}
template <auto Member>
using Shown = std::decay_t<decltype(shown(BodyWords().*Member))>;
template <auto Member>
Shown<Member> getOption(const BodyWords& words) {
  return shown(words.*Member);
}
template <auto Member>
void setOption(BodyWords& words, Shown<Member> value) {
  read(value, words.*Member);
}
/// Arrays are passed separately, as addresses.
template <auto Member, class Fields>
void addField(Fields& fields, const char* name) {
  if constexpr (!std::is_same_v<Shown<Member>, std::vector<int>> && !std::is_same_v<Shown<Member>, std::vector<double>>)
    fields.field(name, &getOption<Member>, &setOption<Member>);
}

BodyWords bodyOptions() {
  return {};
}

/// mesh  null: none
BodyHandle* addBody(WorldHandle& handle, const CageModel& cage, const MeshModel* mesh, BodyWords words, Indices pinned,
                    Doubles nodeMasses, Doubles stiffnessScale) {
  words.pinned.assign(pinned.begin(), pinned.end());
  words.nodeMasses.assign(nodeMasses.begin(), nodeMasses.end());
  words.stiffnessScale.assign(stiffnessScale.begin(), stiffnessScale.end());
  auto body = std::make_unique<BodyHandle>(BodyHandle{handle.world, {}, {}, {}});
  body->state = facade::addBody(*handle.world, cage, mesh ? *mesh : MeshModel(), words);
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
  facade::setVelocities(*body.state, numbers.begin(), numbers.count);
}
void setPinned(BodyHandle& body, Indices nodes, bool pinned) {
  facade::setPinned(*body.state, {nodes.begin(), nodes.end()}, pinned);
}
void setPinnedPositions(BodyHandle& body, Indices nodes, Doubles positions) {
  facade::setPinnedPositions(*body.state, {nodes.begin(), nodes.end()}, positions.begin(), positions.count);
}
View pinned(BodyHandle& body) {
  return lent(facade::pinnedOf(*body.state));
}

View positions(BodyHandle& body) {
  (void)facade::surfaceOf(*body.state);
  return viewNumbers(body.state->positions.data(), body.state->positions.size());
}
View normals(BodyHandle& body) {
  (void)facade::surfaceOf(*body.state);
  return viewNumbers(body.state->normals.data(), body.state->normals.size());
}
View bounds(BodyHandle& body) {
  const Box3& box = facade::surfaceOf(*body.state).bounds();
  return lent(
      std::vector<double>{box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()});
}
bool visible(BodyHandle& body) {
  return body.state->skin.visible();
}
void setVisible(BodyHandle& body, bool visible) {
  facade::surfaceOf(*body.state).setVisible(visible);
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
void setGas(BodyHandle& body, double pressure, double outside) {
  check(alive(*body.state).setGas(pressure, outside));
}
/// mesh  null: the boundary of the tets
void setPressureSurface(BodyHandle& body, const MeshModel* mesh) {
  facade::setPressureSurface(*body.state, mesh ? *mesh : MeshModel());
}
double friction(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().m_cfg.kDF);
}
void setFriction(BodyHandle& body, double friction) {
  facade::setFriction(*body.state, friction);
}
double restitution(BodyHandle& body) {
  return static_cast<double>(alive(*body.state).body().getRestitution());
}
void setRestitution(BodyHandle& body, double restitution) {
  facade::setRestitution(alive(*body.state).body(), restitution);
}
void setGravity(BodyHandle& body, Vec3 gravity) {
  check(alive(*body.state).setGravity(toBullet(gravity, "gravity")));
}
void followWorldGravity(BodyHandle& body) {
  alive(*body.state).followWorldGravity();
}
void transform(BodyHandle& body, Vec3 position, Quaternion rotation) {
  check(body.world->teleport(*body.state, toBullet(position, rotation)));
}
void reset(BodyHandle& body) {
  check(body.world->reset(*body.state));
}
double applyRadialImpulse(BodyHandle& body, Vec3 centre, double radius, double strength) {
  finite({radius, strength, 0}, "radius, strength");
  const ImpulseResult result =
      radialImpulse(*body.world, *body.state,
                    {toBullet(centre, "centre"), static_cast<btScalar>(radius), static_cast<btScalar>(strength)});
  return static_cast<double>(result.vertices);
}

}  // namespace

EMSCRIPTEN_BINDINGS(bodies) {
  emscripten::value_object<BodyWords> options("BodyOptions");
#define TETSKIN_FIELD(of, type, name, python, ...) addField<&BodyWords::name>(options, #name);
  TETSKIN_BODY_OPTIONS(TETSKIN_FIELD)
#undef TETSKIN_FIELD
  emscripten::class_<BodyHandle>("Body");
  expose<&bodyOptions>("bodyOptions");
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
  expose<&read<&DeformableBody::pressure>>("pressure");
  expose<&write<&DeformableBody::setPressure>>("setPressure");
  expose<&read<&DeformableBody::volume>>("bodyVolume");
  expose<&setGas>("setGas");
  expose<&setPressureSurface>("setPressureSurface");
  expose<&friction>("bodyFriction");
  expose<&setFriction>("setBodyFriction");
  expose<&restitution>("bodyRestitution");
  expose<&setRestitution>("setBodyRestitution");
  expose<&setGravity>("setBodyGravity");
  expose<&followWorldGravity>("followWorldGravity");
  expose<&reset>("resetBody");
  expose<&transform>("transform");
  expose<&applyRadialImpulse>("applyRadialImpulse");
}

}  // namespace tetskin::js
