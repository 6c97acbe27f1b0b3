// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: its members, and the stages of a step, in their order.
//
// A node has four numbers:
//   node            in its body, as the application sees it
//   number          first + node, in Bullet's vectors over all bodies; Bullet's forces and constraints use it
//   slot            in the body's matrix, sorted by colour, so that rows of one colour are processed side by side
//   wide            the location of a slot's three numbers, in groups of slots, one slot per lane of a register
// The last two belong to BlockMatrix alone (`slotOf`, `wideOf`): only renumbering the nodes of the application's body
// would make them unnecessary.
#pragma once

#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/solver/src/base/node_loads.h>
#include <tetskin/solver/src/motion/driven_nodes.h>
#include <tetskin/solver/src/motion/rigid_forces.h>
#include <tetskin/solver/src/motion/sleepers.h>
#include <tetskin/solver/src/motion/stillness.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/rows/impacts.h>
#include <tetskin/solver/src/rows/joint_impulses.h>
#include <tetskin/solver/src/search/obstacle_changes.h>
#include <tetskin/solver/src/step/hidden_bodies.h>
#include <tetskin/solver/src/step/recorded_forces.h>
#include <tetskin/solver/src/step/step_clock.h>
#include <tetskin/solver/src/step/step_objects.h>
#include <tetskin/solver/src/system/other_forces.h>

#include <memory>
#include <vector>

namespace tetskin {

using namespace bullet_detail;

struct DeformableSolver::Impl {
  explicit Impl(DeformableSolver& ofSolver) : solver(ofSolver) {}

  /// The stage that has begun last. Each of the calls below, except `gather` and `finishContacts`, asserts that it was
  /// the one before. A step that something has ended early stays where it was until `endStep`, or the next `gather`.
  enum class Stage { Between, Gather, Predict, Assemble, Solve, WriteBack };

  // The stages of a step that is solved here; implemented in step.cpp.
  /// seconds  above 0
  void gather(const btAlignedObjectArray<btSoftBody*>& world, btScalar seconds);
  void predict();
  void assemble();
  void solve();
  void finishContacts();
  void writeBack();

  // Parts of the integration of positions; implemented in step_positions.cpp.
  /// Before Bullet moves the nodes: the application may have moved some of them within the step.
  void listForeignNodes(SolvedBody& body) const;
  /// Gives nodes that Bullet has moved in its own precision the positions of the dynamics.
  void refinePositions(btScalar dt);
  /// Marks bodies whose contacts with a soft body are so far from the origin that rounding of positions shakes them.
  void findShaken();

  bool inStep() const { return stage != Stage::Between; }
  /// Goes on to a stage; solving here, from the one before it.
  void enter(Stage next);

  ForceList& forces() { return solver.m_objective->m_lf; }
  const btDeformableContactProjection& projection() const { return solver.m_objective->m_projection; }
  btScalar dt() const { return solver.m_dt; }

  // Parts of the stage `gather`.
  void fallAsleep();
  bool collect(const btAlignedObjectArray<btSoftBody*>& world);
  void assign();

  /// Restores the bodies to the application's view, wherever the step has stopped.
  void endStep(const btAlignedObjectArray<btSoftBody*>& world);

  /// Writes or reads the settings of Bullet's world that the last step was solved with.
  void serializeFlags(WorldStream& stream);

  // Into how many parts steps of this length are divided, at most 64; implemented in step_parts.cpp.
  /// ahead  seconds in which impacts may begin
  int partsOfSteps(const btDeformableMultiBodyDynamicsWorld& world, btScalar seconds, btScalar ahead);
  template <class Visit>
  void eachGravity(Visit&& visit);
  double partsForGravity(btScalar seconds);
  bool hitsSoon(const btDeformableMultiBodyDynamicsWorld& world, const btSoftBody& body, const btVector3& velocity,
                btScalar seconds, btScalar ahead);
  double partsForImpacts(const btDeformableMultiBodyDynamicsWorld& world, btScalar seconds, btScalar ahead,
                         double most);

  // What the application moves between steps.
  /// Forgets a body's contacts and its sleep history; implemented in step_placed.cpp.
  void forgetTouches(btSoftBody& body);
  /// Moves everything in a world of this solver; implemented in shift_origin.cpp.
  void shift(btDeformableMultiBodyDynamicsWorld& world, const btVector3& by);

  // What the application adds and removes in the middle of a step; implemented in step_changes.cpp.
  /// From now on, this is the world whose objects are known.
  void know(btDeformableMultiBodyDynamicsWorld& world);
  /// The world of these bodies, null if unknown. A solver may outlive its world, and be used by another one.
  btDeformableMultiBodyDynamicsWorld* worldOf(const btAlignedObjectArray<btSoftBody*>& softs) const;
  /// Drops the bodies that have left the world.
  void dropRemoved(const btAlignedObjectArray<btSoftBody*>& world);
  /// Drops what is stored under the addresses of objects that have left the world, because others may have been created
  /// there.
  void forgetRemovedObjects(const btDeformableMultiBodyDynamicsWorld* world);
  void numberAnew();
  /// Before Bullet detects contacts, and again if it has called the application since.
  void noteObjects();
  void dropRemovedObjects();
  void dropRemovedForces();
  bool takesPart(const btDeformableLagrangianForce& force) const;

  // Parts of the stage `predict`; those about forces are in step_forces.cpp.
  /// Sets the values that Bullet's code uses in a step that is solved here.
  void useOwnSettings();
  /// Applies the impulses of other forces.
  void applyOthers();
  void predictVelocities(SolvedBody& body, ParallelFor* inner);
  /// The velocity error that is not visible, whatever the unit of length: see step_rows.cpp.
  double unseenSpeed(const SolvedBody& body) const;
  /// maximum  bound of the iterations
  void solveAlone(SolvedBody& body, int maximum, ParallelFor* inner) const;
  void writePrediction(SolvedBody& body) const;
  void predictByBullet(SolvedBody& body);
  void predictPositions(SolvedBody& body);

  // Detection of contacts.
  void prepareSearch(SolvedBody& body) const;
  void searchWaiting();

  // Parts of the stage `assemble`; those about rows are in step_rows.cpp.
  void readContacts(SolvedBody& body);
  void addOthers();
  /// Collects the rows of contacts and anchors, and of the other constraints of rigid bodies, and adds each to the
  /// system on which it acts.
  void collectRows();
  std::vector<RowSource*> rowSources();
  void collectRigidRowsOfWorlds();
  void joinByRows();
  void reuseLastVelocity(SolvedBody& body);
  /// fastest  speed of the body's fastest node
  void speculate(const SolvedBody& body, btScalar fastest) const;

  // Parts of the stage `solve`.
  void solveSystem(SolvedSystem& system, ParallelFor* inner);
  void solveAgain(SolvedSystem& system, ParallelFor* inner);
  void finishAlone(SolvedSystem& system, ParallelFor* inner);

  // Parts of the stage `writeBack`.
  void writeVelocities(SolvedBody& body) const;

  DeformableSolver& solver;
  OwnObject registered{OwnObject::Kind::DeformableSolver, static_cast<const btSoftBodySolver*>(&solver)};
  SolverBodies bodies;
  DrivenNodes driven;
  NodeLoads loads;
  Sleepers sleepers;
  Stillness stillness;
  ObstacleChanges obstacleChanges;
  RigidUnknowns rigids;
  ContactRows rows;
  Impacts impacts;
  JointImpulses jointImpulses;  ///< of Bullet's own solve in this step
  OtherForces others;
  StepClock clock;
  HiddenBodies hidden;
  StepObjects objects;
  btDeformableMultiBodyDynamicsWorld* known = nullptr;  ///< the world; it may have been destroyed
  const btSoftBodyWorldInfo* knownInfo = nullptr;       ///< of this world
  RigidForces* rigidForces = nullptr;                   ///< only in a DeformableWorld, which owns them
  int impactParts = 1;                                  ///< see DeformableWorldOptions; 1 in any other world
  bool inSimulation = false;                            ///< within `stepSimulation`; only in a DeformableWorld
  Stage stage = Stage::Between;                         ///< until positions have been integrated
  std::weak_ptr<RecordedForces> recorded;               ///< null if there is no record
  RecordDrawing recordDrawing;
  ParallelFor* threads = nullptr;
  bool deterministic = false;
  bool nodeNormals = true;
  bool always = false;  ///< see DeformableSolver::requireOwnSolve
  bool solving = true;  ///< value for this step
  int iterations = 0, passes = 0, unconverged = 0;
  btAlignedObjectArray<btSoftBody*> all;
};

}  // namespace tetskin
