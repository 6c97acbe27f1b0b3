// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_skin.h>

#include <string>
#include <vector>

#include "scenes/files.h"
#include "scenes/scene.h"
#include "stress/models.h"

namespace tetskin::stress {

/// What one case showed.
struct Verdict {
  bool simulationFinite = true;
  /// Finite, and never larger than kBounded times what the event itself makes of it.
  bool simulationBounded = true;
  double extentMax = 1.0;  ///< largest side of the nodes' box, over that at rest
  /// RMS in diagonals of the mesh: how far the surface was from its rest shape, wherever it lay, when the event was
  /// over: whether the body has recovered.
  double shapeError = 0.0;
  double lowest = 0.0;        ///< of the surface at the end, over the scene's floor, in sizes; 0 where there is none
  double energy = 0.0;        ///< of a claim: the most there was, over what it began with and was given
  double energyStored = 0.0;  ///< the same of elastic energy alone, also in the steps of a landing
  double momentumLost = 0.0;  ///< likewise: the most of momentum and angular momentum, of a free body
  double restSpeed = 0.0;     ///< root mean square of the nodes' in the last half second, in sizes a second
  bool skinFinite = true;     ///< at every update
  std::string status;         ///< the worst that `update` said, or why there is no skin
  /// Largest over all updates of: the longest way of a vertex since bind, over the longest way of a node. Updates in
  /// which no node has gone a thousandth of the size do not count.
  double amplification = 0.0;
  double restError = 0.0;    ///< RMS in diagonals of the mesh, with all nodes back where they began
  double normalError = 0.0;  ///< largest difference of a normal's length from 1
  double weightError = 0.0;  ///< largest difference of a vertex' weights' sum from 1, over the largest weight
  std::uint64_t hash = scenes::kNoHash;  ///< of all bodies' nodes after each step that is looked at
  double milliseconds = 0.0;
  scenes::SolveTotals solve;
  std::vector<std::string> broken;  ///< the expectations that did not hold, in words

  bool held() const { return broken.empty(); }
  void expect(bool condition, const std::string& what);
};

/// Updates a skin, and compares what it says and shows with the body's nodes, each time:
/// - nodes finite and below kLargestCoordinate: `Updated`, the surface is finite, normals are finite unit vectors, and
///   no vertex has gone farther than the nodes can have carried it: the longest way of a node times the sum of the
///   vertex' absolute weights (1 inside the cage), and for quadratic surfaces what their edge vectors may add;
/// - otherwise: `NonFinite`, the first such node is named, and the surface is, to the bit, the one before.
class SkinJudge {
 public:
  /// skin  bound to the body, which is at rest
  SkinJudge(const StressCase& stressCase, const StressModel& model, const scenes::Scene& scene, SoftBodySkin& skin,
            Verdict& verdict);

  void update();
  /// Of the last good surface.
  void judgeShape();
  /// With all nodes back where they began.
  void judgeRest();

 private:
  void judgeWeights();
  void judgeNodes();
  void judgeFollowing();
  void judgeNormals();

  const StressCase& case_;
  const StressModel& model_;
  const scenes::Scene& scene_;
  const btSoftBody& body_;
  SoftBodySkin& skin_;
  Verdict& verdict_;
  std::vector<btScalar> startNodes_, startSurface_, lastSurface_;
  std::vector<float> lastNormals_;
  double diagonal_;            ///< of the mesh
  double longestEdge_;         ///< of the cage at rest
  std::vector<bool> inside_;   ///< by vertex
  std::vector<double> reach_;  ///< by vertex: sum of its absolute weights, 1 inside
};

}  // namespace tetskin::stress
