// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: a body, and its positions in this step.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/contact/src/soft/four.h>
#include <tetskin/contact/src/soft/shape_data.h>

#include <atomic>
#include <cassert>
#include <memory>
#include <mutex>
#include <vector>

namespace tetskin::contact_detail {

/// The map from a position in the world to its weights in a deformed tet: weight i is rows[i] . (p - origin), i < 3.
struct DeformedTet {
  btVector3 origin{0, 0, 0};
  btVector3 rows[3];
  /// The planes that bound its filled part: unit normals, inwards, and the distances of the origin from them.
  btVector3 normals[4];
  btScalar offsets[4] = {};
  btVector3 restOrigin{0, 0, 0}, toRest[3];  ///< rest position: restOrigin[i] + toRest[i] . (p - origin)
  btScalar restPerWorld = 0;                 ///< an upper bound of the ratio of rest lengths to world lengths
  btScalar steepness = 0;                    ///< sum of the lengths of the weights' gradients
  bool flat = true;

  void weightsAt(const btVector3& p, btScalar weights[4]) const;
  btVector3 restAt(const btVector3& p) const {
    const btVector3 r = p - origin;
    return restOrigin + btVector3(toRest[0].dot(r), toRest[1].dot(r), toRest[2].dot(r));
  }
  /// Sets the planes, from the rows.
  /// minimum  weights in the planes
  void setPlanes(const btScalar minimum[4]);
};

/// A lower bound of the distance between a box and the tet's filled part; negative if they may overlap. The tet must
/// not be flat.
btScalar gapTo(const ContactBox& box, const DeformedTet& tet);

static_assert(kLanes == 4, "one lane for each tet of a group");

/// The boxes of the tets of a group side by side: coordinates by axis. Unused lanes are empty boxes.
struct GroupBoxes {
  Four low[3], high[3];
};

/// The same box in each lane.
struct FourBoxes {
  Four low[3], high[3];
  explicit FourBoxes(const ContactBox& box)
      : low{four(box.low[0]), four(box.low[1]), four(box.low[2])},
        high{four(box.high[0]), four(box.high[1]), four(box.high[2])} {}
};

/// The distances between a box and those of a group; 0 or below if they overlap.
TETSKIN_INLINE Four gapsBetween(const FourBoxes& box, const GroupBoxes& boxes) {
  const Four x = larger(Four(box.low[0] - boxes.high[0]), Four(boxes.low[0] - box.high[0]));
  const Four y = larger(Four(box.low[1] - boxes.high[1]), Four(boxes.low[1] - box.high[1]));
  const Four z = larger(Four(box.low[2] - boxes.high[2]), Four(boxes.low[2] - box.high[2]));
  return larger(larger(x, y), z);
}

/// A computation that runs at most once per step, in the first thread that needs its result.
class OncePerStep {
 public:
  void reset() { done_.store(false, std::memory_order_relaxed); }
  template <class Compute>
  void make(Compute&& compute) {
    if (done_.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (done_.load(std::memory_order_relaxed)) return;
    compute();
    done_.store(true, std::memory_order_release);
  }

 private:
  std::atomic<bool> done_{false};
  std::mutex mutex_;
};

/// Several threads may search in a body at once, after one thread has read it.
class ContactBody {
 public:
  ContactBody(btSoftBody& solved, std::shared_ptr<const ContactShape> ofShape, bool meetsItself, int number);

  const ShapeData& data() const { return dataOf(*shape); }
  /// False if the body is known to have been deleted; for the application's own bodies this is unknown.
  bool lives() const { return !watched_ || !life_.expired(); }
  bool isWatched() const { return watched_; }
  /// True if the living body is in the world in which it was added.
  bool isInWorld() const { return body->getBroadphaseHandle() && body->getSoftBodySolver() == solver_; }
  /// True if the body has the nodes and tets for which the shape was made.
  bool fits() const;

  /// Reads the positions and velocities of the nodes, and computes their box. Cost O(nodes)
  void read();
  /// Computes the boxes of the tets, unless this has been done since `read`. Cost O(tets)
  void place();
  /// Fits the trees to the current positions, unless this has been done since `read`. Cost O(tets + runs)
  void fit();

  /// moves  whether its motion since the last step will be needed
  void serialize(bullet_detail::WorldStream& stream, bool moves);

  /// A box around the samples of a run, by the nodes of its tet.
  ContactBox runBox(int run) const {
    assert(run >= 0 && static_cast<std::size_t>(run) < data().runs.size());
    const auto r = static_cast<std::size_t>(run);
    return regionBox(data().tets[static_cast<std::size_t>(data().runs[r].tet)], data().runRegions[r]);
  }
  DeformedTet deformed(int tet) const;
  /// The velocity of a point of a tet.
  btVector3 velocityAt(int tet, const btScalar weights[4]) const;

  btSoftBody* body;
  std::shared_ptr<const ContactShape> shape;
  bool self;
  int id;
  // The state of the body in this step.
  bool awake = true;
  bool readable = false;  ///< all positions are finite
  ContactBox box;
  btVector3 centroid{0, 0, 0};      ///< of the nodes
  int reads = 0;                    ///< number of times that `read` has been called
  btScalar moved = 0, fastest = 0;  ///< largest displacement of a node since the last `read`, and largest speed
  btScalar farthest = 0;            ///< largest coordinate of any node: rounding grows with it
  std::vector<btVector3> positions, velocities;        ///< by node
  std::vector<btVector3> before;                       ///< positions by node at the `read` before
  std::vector<GroupBoxes> groupBoxes;                  ///< by group: around the tets' filled parts; valid after `place`
  std::vector<ContactBox> runTreeBoxes, tetTreeBoxes;  ///< by node of the shape's trees, valid after `fit`

 private:
  void measure(DeformedTet& tet, int t) const;
  ContactBox regionBox(const Tet& n, const TetSubregion& part) const;
  void placeGroup(const TetGroup& group, GroupBoxes& boxes) const;
  void fitTrees();

  const btSoftBodySolver* solver_;
  bool watched_ = false;
  std::weak_ptr<const void> life_;  ///< of a watched body
  OncePerStep placed_, fitted_;
};

}  // namespace tetskin::contact_detail
