// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: finds which points of a body's surface one rigid shape touches, and where.
#pragma once

#include <LinearMath/btTransform.h>
#include <tetskin/core/src/base/bvh/bvh_box.h>
#include <tetskin/solver/src/base/contact_patches.h>
#include <tetskin/solver/src/search/shape_probe.h>

#include <array>
#include <vector>

namespace tetskin::bullet_detail {

/// The transform of a rigid shape at the beginning of the step, and the one that it would reach without contact.
struct ShapePath {
  btTransform now, predicted;
};

/// An upper bound of the change of a unit vector between two rotations.
btScalar turnBetween(const btMatrix3x3& a, const btMatrix3x3& b);

using WorldBox = BvhBox<btScalar>;

class BoxOfPaths {
 public:
  void add(const NodePath& path) {
    low_.setMin(path.now);
    low_.setMin(path.predicted);
    high_.setMax(path.now);
    high_.setMax(path.predicted);
  }
  Ball ball(btScalar spread) const {
    return {(low_ + high_) * btScalar(0.5), (high_ - low_).length() * btScalar(0.5) * spread};
  }
  WorldBox box(btScalar spread) const {
    const btVector3 beyond = (high_ - low_) * (btScalar(0.5) * (spread - 1));
    WorldBox box;
    const btVector3 low = low_ - beyond, high = high_ + beyond;
    box.extend(low.m_floats, high.m_floats);
    return box;
  }

 private:
  btVector3 low_{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT};
  btVector3 high_{-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT};
};

/// Regions found clear of a shape, which need no new search until nodes have moved as far.
/// Shapes may be changed in place without notice: everything is searched again after some steps. What touches and
/// hardly moves is followed, if the box reveals such changes: the points that touched are looked at, and no others.
struct ShapeMemory {
  std::vector<Ball> clusterBalls;      ///< shape space, like all positions here
  std::vector<btScalar> clusterClear;  ///< distance from everything, minus the margin; 0: unknown
  std::vector<btVector3> carriers;     ///< positions of ContactPatches::nodes
  /// By patch: distance from everything, minus the margin; 0: unknown. Below 0: it touched when it was searched where
  /// `carriers` are, with a reach of the opposite.
  std::vector<btScalar> clear;
  std::vector<unsigned> followed;  ///< by patch: last step in which that held; later, its touched points are unknown
  std::vector<std::uint32_t> touched;  ///< points that touched in the last step, ascending
  std::vector<btVector3> nodes;        ///< world space, when the whole body was found clear of a resting shape
  btTransform position = btTransform::getIdentity();  ///< transform of that shape
  btScalar speculation = 0;                           ///< of the step in which it was found clear
  unsigned clearUntil = 0;                            ///< last step for which this holds
  unsigned steps = 0;
};

/// Bounds of the number of contact points per patch and shape: enough to constrain a tet, and more only if it is large.
constexpr std::size_t kMinTouches = 4, kMaxTouches = 64;
/// Bound for the samples on a triangle: it stays flat between its corners, so more would change nothing. Two more than
/// a tet's, for the points of a concave shape that it meets next.
constexpr std::size_t kTriangleTouches = 6;
/// Largest motion towards a plane in a step that counts as resting, in units of the slack.
constexpr btScalar kMaxApproach = btScalar(0.25);
/// If this many points touch already, flat patches get at most two each.
constexpr std::size_t kManyTouches = 64;

/// A point may pass through a thin shape in one step: it touches what it meets first on its path.
class PointCollider {
 public:
  /// slack  distance beyond the reach up to which clearances are computed and kept
  PointCollider(ContactPatches patches, btScalar slack);

  const ContactPatches& patches() const { return patches_; }

  /// Sets the nodes' paths in this step; they must stay valid until the next call.
  /// margin       kept from shapes
  /// speculation  height above the margin up to which points still touch
  void begin(const std::vector<NodePath>& nodes, btScalar margin, btScalar speculation);
  /// The points of the body that would penetrate this shape if nothing stopped them, patch by patch, with `object` not
  /// set: the deepest points of each patch, and others far enough apart that none is missed; at most kMaxTouches, or
  /// kTriangleTouches. Where a face lies on the shape, hardly more samples than nodes. Valid until the next call.
  /// memory  of the same shape, or an empty one
  /// around  a box around the shape's path, world space; null: it may be anywhere
  const PointContacts& find(ShapeProbe& probe, const ShapePath& shape, ShapeMemory& memory,
                            const WorldBox* around = nullptr);
  /// Makes room in the memory for what the search stores.
  void prepare(ShapeMemory& memory) const;

 private:
  void readClusters();
  bool isAllClear() const;
  void rememberAllClear();
  Ball localBall(std::size_t cluster) const;
  btScalar clearance(std::size_t cluster, const Ball& ball) const;
  bool searchNode(std::size_t node, const WorldBox* near);
  btScalar searchCluster(std::size_t cluster, const Ball& ball, bool again);
  void readCluster(const PatchCluster& cluster);
  void readPatch(const ContactPatch& patch);
  btScalar clearance(const ContactPatch& patch, btScalar known) const;
  void startFollowing(std::size_t patch);
  bool isFollowed(std::size_t patch) const;
  void follow(std::size_t patch);
  /// By how much a point at rest comes nearer in a step, at most: gravity alone moves it by half of the speculation.
  btScalar restingApproach() const { return kMaxApproach * slack_ + btScalar(0.5) * speculation_; }
  void remember(std::size_t patch, btScalar clear);
  btScalar lowestHeight(const ContactPatch& patch, const ShapeBound& bound);
  btScalar searchPatch(const ContactPatch& patch, const ShapeBound& clusterBound);
  btScalar searchPoints(const ContactPatch& patch);
  struct TrianglePart;
  btScalar searchTriangle(const ContactPatch& patch, const ShapeBound& clusterBound);
  void readCorners(const ContactPatch& patch);
  btScalar searchPart(const ContactPatch& patch, const TrianglePart& part, const ShapeBound& around);
  btScalar touchCorners(const ContactPatch& patch, const TrianglePart& part);
  bool isFlat(const CarrierPaths& corners, const ShapeBound& bound) const;
  NodePath sampleAt(const ContactPatch& patch, int i, int j) const;
  NodePath pathOf(const ContactPatch& patch, std::uint32_t point) const;
  btScalar touch(const ContactPatch& patch, std::uint32_t point);
  void finishPatch(const ContactPatch& patch, std::size_t first);
  void setCarried(const ContactPatch& patch, std::size_t first);
  void chooseTouches(const ContactPatch& patch, std::size_t first);
  void listFace();
  void thinOutFace();
  void keepForNodes();
  bool keepOutline();
  bool isKnown(const PointContact& touch) const;
  void rememberTouched();

  /// The touch that presses on a node with the largest weight.
  struct Pressing {
    std::size_t touch = 0;
    btScalar weight = 0;
  };

  ContactPatches patches_;
  btScalar slack_;
  btScalar margin_ = 0, speculation_ = 0, reach_ = 0;  ///< of this step; the reach includes the margin
  btScalar spread_ = 1;                                ///< the largest spread of all clusters
  const std::vector<NodePath>* nodes_ = nullptr;
  bool clustersRead_ = false;
  std::vector<Ball> clusterBalls_;   ///< world space, around the paths of all their points
  std::vector<WorldBox> nodeBoxes_;  ///< by node of the patches' tree: around the same paths
  // State during one call of `find`.
  ShapeProbe* probe_ = nullptr;
  ShapeMemory* memory_ = nullptr;
  ShapePath shape_, toShape_;
  btScalar turn_ = 0;      ///< by how much the shape's rotation moves a point at distance 1
  bool searched_ = false;  ///< some patch in touch has been searched, not followed
  PointContacts touches_, chosen_;
  std::vector<std::size_t> face_;                  ///< indices of touches in one plane
  std::vector<char> areSamples_;                   ///< by touch: on a triangle; otherwise it is a vertex
  std::vector<char> stays_;                        ///< by touch
  std::vector<Pressing> mostPressing_;             ///< by node
  std::vector<btScalar> apart_;                    ///< by touching point of a patch: distance from the chosen ones
  std::vector<NodePath> local_;                    ///< by node of the cluster; shape space
  std::array<NodePath, kMaxCarriers> carriers_;    ///< of the patch
  std::array<NodePath, 3> corners_;                ///< of the triangle
  std::array<btScalar, kMaxCarriers> heights_[2];  ///< of the carriers above the bound, current and predicted
};

}  // namespace tetskin::bullet_detail
