// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The order of a build-up: settings, soft bodies in the order of their forces, rigid objects, joints, contacts at
// surfaces, what else is in the solver's list of forces. Lists are then put into the order of the recorded ones.
#include <tetskin/bullet/src/base/body_forces.h>
#include <tetskin/bullet/src/base/required_solver.h>
#include <tetskin/bullet/src/base/row_source.h>
#include <tetskin/bullet/src/build/recorded_world.h>
#include <tetskin/bullet/src/build/soft_bodies.h>
#include <tetskin/bullet/src/state/bullet_members.h>
#include <tetskin/bullet/src/state/world_state.h>
#include <tetskin/core/src/base/bytes.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace tetskin::bullet_detail {
namespace {

using World = btDeformableMultiBodyDynamicsWorld;

/// An entry of the list of forces, as numbers of what it belongs to.
struct ForceEntry {
  enum Kind : std::int32_t { Gravity, Elasticity, Source } kind = Gravity;
  int number = 0;

  bool operator==(const ForceEntry& other) const { return kind == other.kind && number == other.number; }
};

/// What is in the list of forces: of bodies in the order of their elasticity, which is that of their creation.
struct ForceEntries {
  std::vector<BodyOwner*> bodies;
  std::vector<RowSource*> sources;
  std::vector<ForceEntry> entries;

  void readFrom(BuildStream& stream, const ForceList& list);
  void visit(BuildStream& stream);
  /// Puts the list into this order.
  void order(BuildStream& stream, ForceList& list) const;

 private:
  void findBodies(const ForceList& list);
  int numberOf(const BodyOwner& owner) const {
    return static_cast<int>(std::find(bodies.begin(), bodies.end(), &owner) - bodies.begin());
  }
};

BodyGravity* asGravity(btDeformableLagrangianForce* force) {
  return asOwn<BodyGravity>(OwnObject::Kind::BodyGravity, force);
}

/// Gravity stands in the list in the reverse order of elasticity.
void ForceEntries::findBodies(const ForceList& list) {
  for (int k = list.size() - 1; k >= 0; --k) {
    if (BodyGravity* gravity = asGravity(list[k])) bodies.push_back(&gravity->owner());
  }
}

void ForceEntries::readFrom(BuildStream& stream, const ForceList& list) {
  findBodies(list);
  for (int k = 0; k < list.size(); ++k) {
    btDeformableLagrangianForce* force = list[k];
    if (isPlaceholder(force)) continue;
    if (BodyGravity* gravity = asGravity(force)) {
      entries.push_back({ForceEntry::Gravity, numberOf(gravity->owner())});
      continue;
    }
    const auto owner =
        std::find_if(bodies.begin(), bodies.end(), [&](BodyOwner* body) { return &body->elasticForce() == force; });
    if (owner != bodies.end()) {
      entries.push_back({ForceEntry::Elasticity, static_cast<int>(owner - bodies.begin())});
      continue;
    }
    InactiveForce* own = inactiveForce(force);
    if (!own || !own->builderName()) return stream.refuse("a force of the application's own");
    entries.push_back({ForceEntry::Source, static_cast<int>(sources.size())});
    sources.push_back(static_cast<RowSource*>(own));
  }
}

void ForceEntries::visit(BuildStream& stream) {
  stream.each(entries, [&](ForceEntry& entry) { visitAll(stream, entry.kind, entry.number); });
}

void ForceEntries::order(BuildStream& stream, ForceList& list) const {
  std::vector<btDeformableLagrangianForce*> listed, ordered;
  for (int k = 0; k < list.size(); ++k) {
    if (!isPlaceholder(list[k])) listed.push_back(list[k]);
  }
  ForceEntries now;
  now.readFrom(stream, list);
  if (stream.failed() || now.entries.size() != entries.size()) return stream.fail();
  for (const ForceEntry& entry : entries) {
    const auto found = std::find(now.entries.begin(), now.entries.end(), entry);
    if (found == now.entries.end()) return stream.fail();
    ordered.push_back(listed[static_cast<std::size_t>(found - now.entries.begin())]);
    found->number = -1;  // taken
  }
  list.resize(0);
  for (btDeformableLagrangianForce* force : ordered) list.push_back(force);
}

void visitWorldSettings(BuildStream& stream) {
  visitSolverSettings(stream, *deformableSolverOf(stream.world()));
  btSoftBodyWorldInfo& info = stream.world().getWorldInfo();
  visitAll(stream, info.air_density, info.water_density, info.water_offset, info.m_maxDisplacement, info.water_normal,
           info.m_gravity);
}

/// In the order of the recorded world.
void orderObjects(BuildStream& stream, const std::vector<btCollisionObject*>& objects) {
  btCollisionObjectArray& list = stream.world().getCollisionObjectArray();
  if (objects.size() != static_cast<std::size_t>(list.size())) return stream.fail();
  for (int k = 0; k < list.size(); ++k) {
    list[k] = objects[static_cast<std::size_t>(k)];
    list[k]->setWorldArrayIndex(k);
  }
}

const SourceBuilder* builderOf(const std::vector<const SourceBuilder*>& builders, const std::string& name) {
  for (const SourceBuilder* builder : builders) {
    if (builder && name == builder->name) return builder;
  }
  return nullptr;
}

std::string namedBy(BuildStream& stream, const char* name) {
  std::vector<char> text;
  if (name) text.assign(name, name + std::strlen(name));
  stream.array(text);
  return {text.begin(), text.end()};
}

void describeAll(BuildStream& stream) {
  World& world = stream.world();
  visitWorldSettings(stream);
  ForceEntries forces;
  forces.readFrom(stream, *deformableSolverOf(world)->getLagrangianForceArray());
  forces.visit(stream);
  (void)stream.length(forces.bodies.size());
  for (BodyOwner* body : forces.bodies) body->describe(stream);

  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  (void)stream.length(static_cast<std::size_t>(objects.size()));
  for (int k = 0; k < objects.size(); ++k) {
    btCollisionObject* object = objects[k];
    const auto owner = std::find_if(forces.bodies.begin(), forces.bodies.end(),
                                    [&](BodyOwner* body) { return &body->ownedBody() == object; });
    auto number = owner == forces.bodies.end() ? -1 : static_cast<int>(owner - forces.bodies.begin());
    stream(number);
    if (number >= 0) continue;
    if (object->getInternalType() == btCollisionObject::CO_SOFT_BODY) {
      return stream.refuse("a soft body that no DeformableBody has created");
    }
    buildObject(stream, object);
  }
  buildJoints(stream);
  for (BodyOwner* body : forces.bodies) buildSurfaceContact(stream, body->ownedBody());
  for (RowSource* source : forces.sources) {
    namedBy(stream, source->builderName());
    source->describe(stream);
  }
}

}  // namespace

std::uint32_t CopyStore::indexOf(std::vector<unsigned char> bytes) {
  const std::uint64_t hash = hashOf(bytes.data(), bytes.size());
  const auto known = std::find(hashes.begin(), hashes.end(), hash);
  const auto index = static_cast<std::uint32_t>(known - hashes.begin());
  if (known == hashes.end()) {
    hashes.push_back(hash);
    unsaved.push_back(std::move(bytes));
  }
  return index;
}

Result<std::vector<unsigned char>> describeWorld(World& world, CopyStore& store) {
  if (!deformableSolverOf(world)) return Status{StatusCode::NotSaved, "a world without a DeformableSolver"};
  BuildStream counted(world, store);
  describeAll(counted);
  if (!counted.refusal().empty()) return Status{StatusCode::NotSaved, counted.refusal()};
  std::vector<unsigned char> bytes(counted.count());
  BuildStream written(world, store, bytes.data(), bytes.size());
  describeAll(written);
  return bytes;
}

void RecordedWorld::visit(BuildStream& stream, const std::vector<const SourceBuilder*>& builders) {
  visitWorldSettings(stream);
  ForceEntries forces;
  forces.visit(stream);
  const std::size_t bodies = stream.length(0);
  for (std::size_t k = 0; k < bodies && !stream.failed(); ++k) {
    if (std::unique_ptr<DeformableBody> body = Access<DeformableBody>::build(stream)) {
      bodies_.push_back(std::move(body));
    } else {
      stream.fail();
    }
  }
  std::vector<btCollisionObject*> order(stream.length(0, sizeof(int)));
  for (std::size_t k = 0; k < order.size() && !stream.failed(); ++k) {
    int number = 0;
    stream(number);
    if (number >= 0) {
      if (static_cast<std::size_t>(number) >= bodies_.size()) return stream.fail();
      order[k] = &bodies_[static_cast<std::size_t>(number)]->body();
      if (std::count(order.begin(), order.end(), order[k]) > 1) return stream.fail();
      continue;
    }
    BuiltObject built = buildObject(stream, nullptr);
    if (!built.object) return stream.fail();
    order[k] = built.object.get();
    objects_.push_back(std::move(built));
  }
  if (stream.failed()) return;
  orderObjects(stream, order);
  joints_ = buildJoints(stream);
  for (std::size_t k = 0; k < bodies_.size() && !stream.failed(); ++k) {
    if (std::unique_ptr<PointSearch> search = buildSurfaceContact(stream, bodies_[k]->body())) {
      searches_.push_back(std::move(search));
    }
  }
  const auto isSource = [](const ForceEntry& entry) { return entry.kind == ForceEntry::Source; };
  const auto sources = std::count_if(forces.entries.begin(), forces.entries.end(), isSource);
  for (std::ptrdiff_t k = 0; k < sources && !stream.failed(); ++k) {
    const std::string name = namedBy(stream, nullptr);
    const SourceBuilder* builder = stream.failed() ? nullptr : builderOf(builders, name);
    if (!builder) return stream.failed() ? void() : stream.refuse("no builder is given for its " + name);
    BuiltSource made = builder->build(stream);
    if (!made.entry) return stream.fail();
    sources_.push_back(std::move(made));
  }
  if (!stream.failed()) forces.order(stream, *world_.deformableSolver().getLagrangianForceArray());
}

Result<std::unique_ptr<RecordedWorld>> RecordedWorld::build(const std::vector<unsigned char>& bytes, CopyStore& store,
                                                            const std::vector<const SourceBuilder*>& builders) {
  std::unique_ptr<RecordedWorld> made(new RecordedWorld);
  BuildStream stream(made->world_, store, bytes.data(), bytes.size());
  made->visit(stream, builders);
  if (!stream.refusal().empty()) return Status{StatusCode::InvalidOption, stream.refusal()};
  if (stream.failed() || stream.count() != bytes.size()) {
    return Status{StatusCode::Malformed, "the build-up is damaged"};
  }
  return made;
}

RecordedWorld::~RecordedWorld() {
  sources_.clear();
  searches_.clear();
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  bodies_.clear();
  for (const BuiltObject& built : objects_) {
    if (btRigidBody* rigid = btRigidBody::upcast(built.object.get())) {
      world_.removeRigidBody(rigid);
    } else {
      world_.removeCollisionObject(built.object.get());
    }
  }
}

}  // namespace tetskin::bullet_detail
