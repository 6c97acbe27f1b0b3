// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the bodies of a step, numbered, and which of them are solved for together.
#pragma once

#include <tetskin/bullet/src/forces/elastic_force.h>
#include <tetskin/bullet/src/solver/contact_row.h>
#include <tetskin/bullet/src/solver/padded_trees.h>

#include <memory>
#include <unordered_map>
#include <vector>

class btDeformableBackwardEulerObjective;

namespace tetskin {

using VectorStack = btAlignedObjectArray<btVector3>;

/// A node that Bullet's constraints let move nowhere, in all directions but one, or in one alone.
struct FixedNode {
  enum Kind { Fixed, AlongDirection, AllButDirection } kind = Fixed;
  std::size_t node = 0;
  btVector3 direction{0, 0, 0};
};

/// A body awake in this step.
struct SolvedBody {
  btSoftBody* body = nullptr;
  int first = 0;                  ///< the number of its first node in Bullet's vectors
  ForcedBody* elastic = nullptr;  ///< null: only Bullet's forces act on it
  const SolverLimits* limits = nullptr;
  Dynamics* dynamics = nullptr;
  bool needsDeformation = false;              ///< Bullet's own gradients
  std::vector<Sticking>* sticking = nullptr;  ///< of the step before, by number of the point; elastic ones only
  PointContacts* bulletsContacts = nullptr;   ///< of this step, as Bullet has found them
  PaddedTrees* paddedTrees = nullptr;
  elastic_detail::ConjugateGradient<btScalar>* solve = nullptr;
  int iterations = 0;            ///< in this step; of bodies that are coupled, the first one's are for all
  int rowCount = 0;              ///< of contacts and anchors
  bool* touches = nullptr;       ///< for the next step
  bool wasTouched = false;       ///< in the step before
  bool waits = false;            ///< it is solved for when contacts are known, and not before
  std::vector<FixedNode> fixed;  ///< but held ones
  bool solvedAgain = false;      ///< with what contacts and other forces do
  bool touched = false;          ///< something beside elasticity has changed velocities, or shall

  /// Of a node of the body, by its number.
  std::size_t placeOf(int number) const { return static_cast<std::size_t>(number - first); }
};

/// Bodies that forces couple, and these forces; most are alone.
struct SolvedSystem {
  std::vector<std::size_t> bodies;
  std::vector<btDeformableLagrangianForce*> forces;  ///< but elastic ones
  std::vector<ContactRow*> rows;                     ///< that act on them, or on the rigid ones
  std::vector<std::size_t> rigids;                   ///< in RigidUnknowns: solved for with them
  int passes = 0;                                    ///< of the solve
  bool converged = true;                             ///< likewise
};

class SolverBodies {
 public:
  /// The bodies of the world that are awake; `everyone`: all of them. Returns whether they, or their nodes, are others
  /// than before, or stand elsewhere.
  bool collect(const btAlignedObjectArray<btSoftBody*>& all, bool everyone, btAlignedObjectArray<btSoftBody*>& awake);
  /// Gives all nodes, and all faces, of awake bodies and then of sleeping ones, the numbers they have in Bullet's
  /// vectors: forces may name nodes of sleeping bodies.
  void number(btDeformableBackwardEulerObjective& objective);
  int nodeCount() const { return nodeCount_; }
  int awakeCount() const { return awakeCount_; }

  /// Which forces act on which bodies; before each step.
  void assign(const ForceList& forces);
  /// Makes one system of those that bodies are in.
  /// places  in `bodies`; not empty
  SolvedSystem& join(const std::vector<std::size_t>& places);
  /// No body is solved for here.
  void clear();

  std::vector<SolvedBody>& bodies() { return bodies_; }
  const std::vector<SolvedBody>& bodies() const { return bodies_; }
  std::vector<SolvedSystem>& systems() { return systems_; }
  /// The body of a node, by its number.
  SolvedBody& bodyOf(int node);
  /// In `bodies`; as many as there are if it is not awake.
  std::size_t placeOf(const btSoftBody* body) const;

 private:
  void listAwake();
  void takeElastic(const ForceList& forces);
  void lendKept();
  void makeSystems(const ForceList& forces);
  /// The places of the awake bodies that a force may act on, and couples.
  std::vector<std::size_t> actedOnBy(const btDeformableLagrangianForce& force) const;

  struct Kept {
    std::unique_ptr<Dynamics> masses;  ///< of a body without elastic force
    std::vector<Sticking> sticking;
    bool touches = false;  ///< any row acts on it
    PointContacts bulletsContacts;
    PaddedTrees paddedTrees;
    elastic_detail::ConjugateGradient<btScalar> solve;
  };

  std::vector<btSoftBody*> awake_, asleep_;
  std::vector<int> nodeCounts_;  ///< of all, as numbered
  int nodeCount_ = 0, awakeCount_ = 0;
  std::vector<SolvedBody> bodies_;
  std::unordered_map<const btSoftBody*, std::size_t> places_;  ///< in `bodies_`
  std::vector<SolvedSystem> systems_;
  std::unordered_map<const btSoftBody*, Kept> kept_;
};

}  // namespace tetskin
