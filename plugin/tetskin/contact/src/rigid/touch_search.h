// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: which points of a body's surface one rigid shape touches, and where.
#pragma once

#include <LinearMath/btTransform.h>
#include <tetskin/contact/src/rigid/contact_patches.h>
#include <tetskin/contact/src/rigid/shape_probe.h>

#include <array>
#include <vector>

namespace tetskin {

/// Where a rigid shape is when the step begins, and where it would go without contact.
struct ShapePath {
  btTransform now, predicted;
};

/// A point of the surface that goes through, if nothing stops it.
struct PointTouch {
  std::uint32_t patch = 0;  ///< in ContactPatches
  std::uint32_t point = 0;  ///< its number
  btVector3 position;       ///< now, world space
  btVector3 normal;         ///< of the shape where the point meets it, world space
  btScalar distance = 0;    ///< now, along the normal, less the margin
  btScalar predicted = 0;   ///< the same at the end of the step: one of the two is below 0, or hardly above
};

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

 private:
  btVector3 low_{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT};
  btVector3 high_{-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT};
};

/// What a search has found to be clear of a shape, so that it need not look there again until nodes have moved as far.
/// Shapes may change in place without a word: everything is looked at again after some steps.
struct ShapeMemory {
  std::vector<Ball> clusterBalls;      ///< shape space, as are all
  std::vector<btScalar> clusterClear;  ///< how far from everything, less the margin; 0: not known
  std::vector<btVector3> carriers;     ///< as ContactPatches::nodes
  std::vector<btScalar> clear;         ///< by patch, likewise
  std::vector<std::uint32_t> touched;  ///< points of the last step, ascending
  std::vector<btVector3> nodes;        ///< world space, from where on the whole body is clear of a shape that rests
  btTransform place = btTransform::getIdentity();  ///< of that shape
  btScalar speculation = 0;                        ///< of the step from which on it is
  unsigned clearUntil = 0;                         ///< step
  unsigned steps = 0;
};

/// Of one patch and one shape: as many as hold a tet, and more only where it is large.
constexpr std::size_t kMinTouches = 4, kMaxTouches = 64;
/// Where so many points touch already, patches that lie flat have no more than two each.
constexpr std::size_t kManyTouches = 64;

/// A point may pass a thin shape in one step: it touches what it meets first on its way.
class TouchSearch {
 public:
  /// slack  how far around what may touch it looks, to remember what is clear
  TouchSearch(ContactPatches patches, btScalar margin, btScalar slack);

  const ContactPatches& patches() const { return patches_; }
  btScalar margin() const { return margin_; }

  /// Where the nodes are in this step; valid until the next call.
  /// speculation  how far above the margin points still touch
  void begin(const std::vector<NodePath>& nodes, btScalar speculation);
  /// Of the body with these nodes and this shape, patch by patch; of each the deepest points, and others so far apart
  /// that none is missed, no more than kMaxTouches. Valid until the next call. memory  of the same shape, or an empty
  /// one
  const std::vector<PointTouch>& find(ShapeProbe& probe, const ShapePath& shape, ShapeMemory& memory);

 private:
  void readClusters();
  void prepare(ShapeMemory& memory) const;
  bool isAllClear() const;
  void rememberAllClear();
  Ball localBall(std::size_t cluster) const;
  btScalar clearance(std::size_t cluster, const Ball& ball) const;
  btScalar searchCluster(std::size_t cluster, const Ball& ball, bool again);
  void readCluster(const PatchCluster& cluster);
  void readPatch(const ContactPatch& patch);
  btScalar clearance(const ContactPatch& patch, btScalar known) const;
  void remember(std::size_t patch, btScalar clear);
  btScalar lowestHeight(const ContactPatch& patch, const ShapeBound& bound);
  btScalar searchPatch(const ContactPatch& patch, const ShapeBound& clusterBound);
  btScalar searchPoints(const ContactPatch& patch);
  NodePath pathOf(const ContactPatch& patch, std::uint32_t point) const;
  btScalar touch(const ContactPatch& patch, std::uint32_t point);
  void chooseTouches(std::size_t first);
  void rememberTouched();

  ContactPatches patches_;
  btScalar margin_, slack_;
  btScalar speculation_ = 0, reach_ = 0;  ///< of this step; with the margin
  btScalar spread_ = 1;                   ///< the largest of all clusters
  const std::vector<NodePath>* nodes_ = nullptr;
  bool clustersRead_ = false;
  std::vector<Ball> clusterBalls_;  ///< world space, with all that their points pass through
  // Of one call of `find`.
  ShapeProbe* probe_ = nullptr;
  ShapeMemory* memory_ = nullptr;
  ShapePath shape_, toShape_;
  btScalar turn_ = 0;  ///< how far a point at distance 1 moves by the shape's turning
  std::vector<PointTouch> touches_, chosen_;
  std::vector<btScalar> apart_;                     ///< by touch of a patch: how far from those that are chosen
  std::vector<NodePath> local_;                     ///< by node, of the cluster's; shape space
  std::array<NodePath, kMostCarriers> carriers_;    ///< of the patch
  std::array<btScalar, kMostCarriers> heights_[2];  ///< of these, above the bound, now and predicted
};

}  // namespace tetskin
