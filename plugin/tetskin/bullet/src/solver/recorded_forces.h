// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ForceRecord: the impulses of a stepSimulation's rows, added up by pair of objects.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <tetskin/bullet/force_record.h>
#include <tetskin/bullet/src/solver/contact_row.h>
#include <tetskin/bullet/src/solver/solver_bodies.h>

#include <array>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tetskin {

/// In the world's actions, so that it is drawn.
class RecordedForces : public btActionInterface {
 public:
  explicit RecordedForces(btDeformableMultiBodyDynamicsWorld& world);
  ~RecordedForces() override;
  RecordedForces(const RecordedForces&) = delete;
  RecordedForces& operator=(const RecordedForces&) = delete;

  /// In each substep, when it has been solved.
  void record(const SolverBodies& bodies, const std::vector<ContactRow>& rows, btScalar seconds);
  /// other  null: of all
  AppliedForces on(const btCollisionObject& object, const btCollisionObject* other) const;

  void updateAction(btCollisionWorld* /*world*/, btScalar /*seconds*/) override {}
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  /// An object that may be gone, and another one at its address.
  struct Participant {
    const btCollisionObject* object = nullptr;  ///< null: points in space
    const btSoftBody* soft = nullptr;           ///< the same, if it is one
    int id = 0;                                 ///< Bullet's, of its proxy in the world
  };
  using Participants = std::array<Participant, 2>;
  struct Pair {
    Participants participants;
    std::array<AppliedForces, 2> impulses;  ///< of the stepSimulation, on each of the two
    std::array<AppliedForces, 2> before;    ///< forces, of the one before: they stay where both sleep on
    btScalar asleep = 0;                    ///< seconds of the stepSimulation in which both did
  };
  /// Of the last substep in which either was awake.
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
  void add(const SolverBodies& bodies, const ContactRow& row, btScalar seconds);
  Pair& pairOf(const Participants& participants);
  AppliedForces forcesOf(const Pair& pair, std::size_t side) const;
  btVector3 armOf(const RowEnd& end, const Participant& participant, const btVector3& position);
  const Weight& weightOf(const btSoftBody& body);
  btVector3 arrowOf(const btVector3& force, const btSoftBody& body);
  bool isPresent(const Participant& participant) const;

  btDeformableMultiBodyDynamicsWorld& world_;
  btScalar mark_ = 0;     ///< see stepBegins
  btScalar seconds_ = 0;  ///< of the stepSimulation, so far
  int objectCount_ = 0;   ///< of the world, when removed ones were last dropped
  std::vector<Pair> pairs_;
  std::map<std::pair<const void*, const void*>, std::size_t> places_;  ///< in `pairs_`
  std::vector<Point> points_;
  std::unordered_map<const btSoftBody*, Weight> weights_;  ///< in this substep
};

}  // namespace tetskin
