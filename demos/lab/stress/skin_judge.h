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

/// The results of one case.
struct Verdict {
  bool simulationFinite = true;
  /// The body is finite, and never larger than kBounded times the size that the event itself gives it.
  bool simulationBounded = true;
  double extentMax = 1.0;  ///< largest side of the nodes' box, relative to that at rest
  /// RMS distance of the surface from its rest shape, regardless of its position, when the event was over, in diagonals
  /// of the mesh's box: it tells whether the body has recovered.
  double shapeError = 0.0;
  double lowest = 0.0;     ///< height of the surface over the floor at the end, over the body's size; 0 without a floor
  double restSpeed = 0.0;  ///< RMS speed of nodes in the last half second, in body lengths per second
  bool skinFinite = true;  ///< finite at every update
  std::string status;      ///< the worst status that `update` returned, or why there is no skin
  /// The largest value over all updates of: the largest displacement of a vertex since bind, over the largest
  /// displacement of a node. Updates in which no node has moved by a thousandth of the body's size do not count.
  double amplification = 0.0;
  double restError = 0.0;  ///< RMS error with all nodes back at their initial positions, in diagonals of the mesh's box
  double normalError = 0.0;  ///< largest deviation of a normal's length from 1
  double weightError = 0.0;  ///< largest deviation of the sum of a vertex's weights from 1, over the largest weight
  std::uint64_t hash = scenes::kNoHash;  ///< of all bodies' nodes after each checked step
  scenes::SolveTotals solve;
  std::vector<std::string> broken;  ///< the expectations that were not met, in words

  void expect(bool condition, const std::string& what);
};

/// Updates a skin, and compares its status and surface with the body's nodes each time:
/// - if nodes are finite and below Limits::kMaxCoordinate: the status is `Ok`, the surface is finite, normals are
/// finite unit vectors, and no vertex has moved farther than the nodes can have carried it: the largest displacement of
/// a node times the sum of the vertex's absolute weights (1 inside the cage), and for quadratic surfaces what their
/// edge vectors may add;
/// - otherwise: the status is `NonFinite`, the first such node is reported, and the surface is bit-identical to the
/// previous one.
class SkinJudge {
 public:
  /// skin  bound to the body, which is at rest
  SkinJudge(const StressCase& stressCase, const StressModel& model, const scenes::Scene& scene, SoftBodySkin& skin,
            Verdict& verdict);

  void update();
  /// Judges the shape of the last valid surface.
  void judgeShape();
  /// Judges the surface with all nodes back at their initial positions.
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
  double diagonal_;            ///< diagonal of the mesh's box
  double longestEdge_;         ///< longest edge of the cage at rest
  std::vector<bool> inside_;   ///< by vertex
  std::vector<double> reach_;  ///< by vertex: sum of its absolute weights, 1 inside
};

}  // namespace tetskin::stress
