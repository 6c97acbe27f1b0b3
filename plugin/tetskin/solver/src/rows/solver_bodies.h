// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the bodies of a step, their node numbers, and which of them are solved for together.
#pragma once

#include <tetskin/solver/src/forces/elastic_force.h>
#include <tetskin/solver/src/rows/contact_row.h>
#include <tetskin/solver/src/search/padded_trees.h>

#include <cassert>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

class btDeformableBackwardEulerObjective;

namespace tetskin::bullet_detail {

using VectorStack = btAlignedObjectArray<btVector3>;

/// A node that Bullet's constraints fix in all directions, in all but one, or in one.
struct FixedNode {
  enum Kind { Fixed, AlongDirection, AllButDirection } kind = Fixed;
  std::size_t node = 0;
  btVector3 direction{0, 0, 0};
};

/// The longest side of the body's bounding box, in the world.
inline btScalar sizeOf(const btSoftBody& body) {
  const btVector3 size = body.m_bounds[1] - body.m_bounds[0];
  return size[size.maxAxis()];
}

/// Whether rows act on a body in a step, and whether some of them are contacts.
struct RowsOnBody {
  bool any = false, contacts = false;
};

/// What is kept of a body from step to step.
struct BodyMemory {
  std::unique_ptr<Dynamics> masses;             ///< of a body without an elastic force
  std::vector<FrictionAnchor> frictionAnchors;  ///< of the last step, by number of the point; of elastic bodies only
  RowsOnBody rows;                              ///< of the last step that has been solved
  PointContacts bulletsContacts;                ///< contacts of this step that Bullet has found
  PaddedTrees paddedTrees;                      ///< when Bullet's trees of the body were fitted, and by how much
  elastic_detail::ConjugateGradient<btScalar> gradient;  ///< of its own system
};

/// A body awake in this step. What it points to outlives the step: its owners are the world, the list of forces, and
/// SolverBodies.
struct SolvedBody {
  /// What the solve of a body is told, and what it tells.
  struct Solve {
    bool deferred = false;     ///< it begins only when contacts are known
    double unseenSpeed = 0.0;  ///< the error of velocities that is not visible
    std::size_t place = 0;     ///< in `SolvedSystem::bodies`, while its system is solved
    bool again = false;        ///< result: solved once more with the effects of contacts and other forces
    int iterations = 0;        ///< result, of this step; coupled bodies store them in the first one
  };
  /// What acts on it beside elasticity.
  struct Actions {
    int rowCount = 0;              ///< rows of contacts and anchors
    std::vector<FixedNode> fixed;  ///< without pinned ones
    bool changed = false;          ///< something has changed velocities, or will
  };
  /// How positions follow from velocities.
  struct Positions {
    std::vector<int> foreign;  ///< nodes that something else places: anchors of Bullet's, the application
    bool shaken = false;       ///< contacts found at rounded positions shake it: see DeformableSolver::Impl::findShaken
  };

  // What it is.
  btSoftBody* body = nullptr;
  int first = 0;                             ///< number of its first node in Bullet's vectors
  ForcedBody* elastic = nullptr;             ///< null: only Bullet's forces act on it
  const SolverSettings* settings = nullptr;  ///< of the elastic force; without one, Bullet's
  Dynamics* dynamics = nullptr;              ///< of the elastic force, or `BodyMemory::masses`
  BodyMemory* memory = nullptr;
  btVector3 gravity{0, 0, 0};     ///< the acceleration by its gravity, the world's or its own; of an elastic body alone
  bool needsDeformation = false;  ///< Bullet's own deformation gradients are needed
  bool byBullet = true;           ///< Bullet searches for its contacts with rigid objects, by its own trees
  RowsOnBody before;              ///< in the step before

  // Its step.
  elastic_detail::StepStart start;
  Solve solve;
  Actions acted;
  Positions positions;

  /// The index within the body of a node with this number.
  std::size_t indexOf(int number) const {
    assert(number >= first && number - first < body->m_nodes.size());
    return static_cast<std::size_t>(number - first);
  }
};

/// The force as one of gravity, Bullet's or of a body's own; null if it is another.
const btDeformableGravityForce* gravityForce(const btDeformableLagrangianForce* force);

/// Bodies that forces couple, and these forces; most systems have one body.
struct SolvedSystem {
  std::vector<std::size_t> bodies;
  std::vector<btDeformableLagrangianForce*> forces;  ///< without the elastic forces
  std::vector<ContactRow*> rows;                     ///< rows that act on these bodies, or on the rigid ones
  std::vector<std::size_t> rigids;  ///< indices in RigidUnknowns of the rigid bodies that are solved for with them
  int passes = 0;                   ///< passes of the solve
  bool converged = true;            ///< true if the solve has converged
};

class SolverBodies {
 public:
  /// Collects the bodies of the world that are awake; with `everyone`, all of them. Returns true if the list, its
  /// bodies' nodes or their numbers differ from before.
  bool collect(const btAlignedObjectArray<btSoftBody*>& all, bool everyone, btAlignedObjectArray<btSoftBody*>& awake);
  /// Numbers all nodes and faces in Bullet's vectors, those of awake bodies first and then those of sleeping ones:
  /// forces may refer to nodes of sleeping bodies.
  void number(btDeformableBackwardEulerObjective& objective);
  /// Drops bodies that have left the world. The others, which may be in the middle of a step, keep their state and
  /// their order; bodies that have been added since are not among them. Call `number` again before numbers are used.
  /// awake    becomes those of the awake bodies that are left
  /// Returns  the bodies dropped, which may be deleted from now on
  std::vector<const btSoftBody*> dropAllBut(const btAlignedObjectArray<btSoftBody*>& world,
                                            btAlignedObjectArray<btSoftBody*>& awake);
  int nodeCount() const { return nodeCount_; }
  int awakeCount() const { return awakeCount_; }

  /// Finds which forces act on which bodies; call it before each step.
  void assign(const ForceList& forces);
  /// Unites the systems of some bodies.
  /// indices  in `bodies`; not empty
  SolvedSystem& join(const std::vector<std::size_t>& indices);
  /// Removes all bodies.
  void clear();
  /// Call it between steps: what is known of a body from the step before, and of others that have touched it.
  void forget(const btSoftBody& body);
  /// The trees of all bodies must be fitted in the next step.
  void forgetTrees();

  std::vector<SolvedBody>& bodies() { return bodies_; }
  const std::vector<SolvedBody>& bodies() const { return bodies_; }
  std::vector<SolvedSystem>& systems() { return systems_; }
  /// The body to which the node with this number belongs.
  SolvedBody& bodyOf(int node);
  /// The worlds of the bodies on which elastic forces act, asleep or awake; nearly always one.
  static std::vector<btDiscreteDynamicsWorld*> worldsOf(const ForceList& forces);
  const std::vector<btDiscreteDynamicsWorld*>& worlds() const { return worlds_; }  ///< known after `assign`
  /// The body's index in `bodies`; the number of bodies if it is not awake.
  std::size_t indexOf(const btSoftBody* body) const;
  /// Null if it is not awake.
  SolvedBody* find(const btSoftBody* body);

  /// Forgets where points have stuck to objects that are gone.
  void forget(const std::unordered_set<const btCollisionObject*>& gone);
  /// Writes or reads what is known of bodies from the step before.
  void serialize(WorldStream& stream);

 private:
  void countNodes();
  template <class IsGone>
  void dropSolved(const IsGone& isGone);
  void listAwake();
  void takeElastic(const ForceList& forces);
  void takeGravity(const ForceList& forces);
  void attachMemories();
  void makeSystems(const ForceList& forces);
  /// Indices of the awake bodies that a force may act on, and couples.
  std::vector<std::size_t> actedOnBy(const btDeformableLagrangianForce& force) const;

  std::vector<btSoftBody*> awake_, asleep_;
  std::vector<int> nodeCounts_;  ///< of all bodies, in the order of their numbers
  int nodeCount_ = 0, awakeCount_ = 0;
  btAlignedObjectArray<btSoftBody*> seen_;  ///< the world's bodies, as last seen
  bool dropped_ = false;                    ///< bodies were dropped since the last `collect`
  std::vector<SolvedBody> bodies_;
  std::unordered_map<const btSoftBody*, std::size_t> indices_;  ///< index in `bodies_`
  std::vector<SolvedSystem> systems_;
  std::vector<btDiscreteDynamicsWorld*> worlds_;
  std::unordered_map<const btSoftBody*, BodyMemory> memories_;
};

}  // namespace tetskin::bullet_detail
