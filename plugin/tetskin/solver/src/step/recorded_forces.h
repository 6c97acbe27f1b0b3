// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ForceRecord: the impulses of the rows, and what impacts give back, summed per stepSimulation and pair of
// objects.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/rows/impacts.h>
#include <tetskin/solver/src/rows/solver_bodies.h>

#include <array>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class RecordedForces {
 public:
  explicit RecordedForces(btDeformableMultiBodyDynamicsWorld& world) : world_(world) {}
  RecordedForces(const RecordedForces&) = delete;
  RecordedForces& operator=(const RecordedForces&) = delete;

  /// Call it in each substep after the solve.
  void record(const SolverBodies& bodies, const ContactRows& rows, const std::vector<GivenImpulse>& given,
              btScalar seconds);
  /// other  null: the sum over all objects
  AppliedForces on(const btCollisionObject& object, const btCollisionObject* other) const;

  void debugDraw(btIDebugDraw& drawer) const;

  /// Forgets everything.
  void clear();
  /// Moves the drawn points.
  void shift(const btVector3& by) {
    for (Point& point : points_) point.position += by;
  }
  /// Writes or reads the forces, but not the drawn points.
  void serialize(WorldStream& stream);

 private:
  /// An object that may have been destroyed; the id tells it from a later object at the same address.
  struct Participant {
    const btCollisionObject* object = nullptr;  ///< null: a point in space
    const btSoftBody* soft = nullptr;           ///< the object if it is soft, or null
    int id = 0;                                 ///< the id of its proxy in Bullet's broadphase
  };
  using Participants = std::array<Participant, 2>;
  struct Pair {
    Participants participants;
    std::array<AppliedForces, 2> impulses;  ///< on each of the two objects, in this stepSimulation
    std::array<AppliedForces, 2> before;    ///< forces of the last stepSimulation, valid as long as both sleep
    btScalar asleep = 0;                    ///< seconds of this stepSimulation in which both slept
    bool sleeps = false;                    ///< both slept in the last substep
  };
  /// A point of the last substep in which either was awake.
  struct Point {
    Participants participants;
    btVector3 position, normal, arrow;
  };
  struct Weight {
    btVector3 centroid{0, 0, 0};
    btScalar mass = 0;
  };

  bool stepBegins();
  void beginStep();
  void dropRemoved();
  void listPairs();
  void add(const SolverBodies& bodies, const ContactRow& row, const RowOrigin& origin, btScalar seconds);
  void add(const GivenImpulse& given);
  Pair& pairOf(const Participants& participants);
  AppliedForces forcesOf(const Pair& pair, std::size_t side) const;
  btVector3 armOf(const CarriedPoint& point, const Participant& participant, const btVector3& position);
  const Weight& weightOf(const btSoftBody& body);
  btVector3 arrowOf(const btVector3& force, const btSoftBody& body);
  bool isPresent(const Participant& participant) const;

  btDeformableMultiBodyDynamicsWorld& world_;
  btScalar mark_ = 0;           ///< the value left in m_fixedTimeStep, see stepBegins
  btScalar seconds_ = 0;        ///< of this stepSimulation so far
  btScalar secondsBefore_ = 0;  ///< of the stepSimulation before
  int objectCount_ = 0;         ///< objects in the world when removed ones were last dropped
  std::vector<Pair> pairs_;
  std::map<std::pair<const void*, const void*>, std::size_t> indices_;  ///< index in `pairs_`
  std::vector<Point> points_;
  std::unordered_map<const btSoftBody*, Weight> weights_;  ///< of this substep
};

/// One of the world's actions, so that the world's debug drawing draws the record, if there is one. Belongs to the
/// solver, and stays in the world until the solver is destroyed: a world does not report its own destruction.
class RecordDrawing : public btActionInterface {
 public:
  /// Adds itself to the world, unless it is already there.
  void draw(std::weak_ptr<RecordedForces> recorded, btDeformableMultiBodyDynamicsWorld& world);

  void updateAction(btCollisionWorld* /*world*/, btScalar /*seconds*/) override {}
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  std::weak_ptr<RecordedForces> recorded_;
};

}  // namespace tetskin::bullet_detail
