// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <emscripten.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/replay/src/exported/state_hash.h>

#include <cstdio>
#include <cstdlib>
#include <new>

namespace tetskin::js {
namespace {

/// Bullet writes to memory that it asked for without checking whether it got it.
void* allocated(std::size_t bytes) {
  void* const memory = std::malloc(bytes);
  if (!memory) throw std::bad_alloc();
  return memory;
}

WorldHandle* createWorld(Vec3 gravity, bool deterministic, bool recordForces, double sleepAfter, int impactParts) {
  const WorldOptions options = worldOptions(gravity, deterministic, recordForces, sleepAfter, impactParts);
  return new WorldHandle{std::make_shared<World>(options), {}, {}};
}

/// The object of a soft or a rigid body, the other being null; null if both are.
const btCollisionObject* objectOf(const BodyHandle* soft, const RigidHandle* rigid) {
  if (soft) return &alive(*soft->state).body();
  return rigid ? &alive(*rigid->state) : nullptr;
}
/// Forces, each with its torque, in the order of AppliedForces in tetskin.d.ts.
View forcesOn(WorldHandle& handle, const BodyHandle* soft, const RigidHandle* rigid, const BodyHandle* otherSoft,
              const RigidHandle* otherRigid) {
  const btCollisionObject& object = *objectOf(soft, rigid);
  const btCollisionObject* other = objectOf(otherSoft, otherRigid);
  const ForceRecord& record = forcesOf(*handle.world);
  const AppliedForces forces = other ? record.forcesBetween(object, *other) : record.forcesOn(object);
  std::vector<double> numbers;
  for (const Wrench& wrench : {forces.contact, forces.friction, forces.joints, forces.total()})
    for (const btVector3& v : {wrench.force, wrench.torque}) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  return lent(std::move(numbers));
}

int step(WorldHandle& handle, double dt, int substeps) {
  DeformableWorld& bullet = handle.world->bullet();
  const StepTimes before = bullet.deformableSolver().stepTimes();
  const double start = emscripten_get_now();
  double stepped = start;
  const int made = facade::step(*handle.world, dt, substeps, [&](btScalar whole, int count, btScalar substep) {
    const int steps = bullet.stepSimulation(whole, count, substep);
    stepped = emscripten_get_now();
    return steps;
  });
  const double end = emscripten_get_now();
  const StepTimes& after = bullet.deformableSolver().stepTimes();
  const double stages[] = {after.prediction - before.prediction, after.rigidSearch - before.rigidSearch,
                           after.softSearch - before.softSearch, after.rows - before.rows,
                           after.system - before.system};
  for (std::size_t i = 0; i < 5; ++i) handle.times[i] = 1000 * stages[i];
  handle.times[5] = std::max(0.0, stepped - start - 1000 * (after.total() - before.total()));
  handle.times[6] = end - stepped;
  handle.times[7] = end - start;
  return made;
}

View times(WorldHandle& handle) {
  return viewNumbers(handle.times.data(), handle.times.size());
}
Vec3 gravity(WorldHandle& handle) {
  return vectorOf(handle.world->bullet().getGravity());
}
void setGravity(WorldHandle& handle, Vec3 gravity) {
  handle.world->bullet().setGravity(toBullet(gravity, "gravity"));
}

View poses(WorldHandle& handle) {
  handle.poses.clear();
  for (const auto& rigid : handle.world->rigidBodies()) {
    const btTransform& pose = rigid->body->getWorldTransform();
    const btVector3& at = pose.getOrigin();
    const btQuaternion q = pose.getRotation();
    handle.poses.insert(handle.poses.end(), {at.x(), at.y(), at.z(), q.x(), q.y(), q.z(), q.w()});
  }
  return viewNumbers(handle.poses.data(), handle.poses.size());
}

std::size_t snapshotSize(WorldHandle& handle) {
  return take(saveSnapshot(handle.world->bullet(), nullptr, 0));
}
View save(WorldHandle& handle) {
  return lent(take(handle.world->save()));
}
void restore(WorldHandle& handle, std::uintptr_t bytes, std::size_t count) {
  check(handle.world->restore(reinterpret_cast<const void*>(bytes), count));
}
void shiftOrigin(WorldHandle& handle, Vec3 origin) {
  check(handle.world->shiftOrigin(toBullet(origin, "origin")));
}
std::string hashOfState(WorldHandle& handle) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(bullet_detail::stateHash(handle.world->bullet())));
  return text;
}

}  // namespace

EMSCRIPTEN_BINDINGS(worlds) {
  btAlignedAllocSetCustom(allocated, std::free);
  emscripten::value_array<Vec3>("Vec3")
      .element(emscripten::index<0>())
      .element(emscripten::index<1>())
      .element(emscripten::index<2>());
  emscripten::value_array<Quaternion>("Quaternion")
      .element(emscripten::index<0>())
      .element(emscripten::index<1>())
      .element(emscripten::index<2>())
      .element(emscripten::index<3>());
  emscripten::class_<WorldHandle>("World");
  expose<&createWorld>("createWorld");
  expose<&forcesOn>("forcesOn");
  expose<&step>("step");
  expose<&times>("times");
  expose<&gravity>("gravity");
  expose<&setGravity>("setGravity");
  expose<&poses>("poses");
  expose<&snapshotSize>("snapshotSize");
  expose<&save>("save");
  expose<&restore>("restore");
  expose<&shiftOrigin>("shiftOrigin");
  expose<&hashOfState>("hash");
}

}  // namespace tetskin::js
