// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: a body, and its positions in this step.
#pragma once

#include <tetskin/contact/src/soft/shape_data.h>

#include <cassert>
#include <memory>
#include <vector>

namespace tetskin::contact_detail {

/// The map from a position in the world to its weights in a deformed tet: weight i is rows[i] . (p - origin), i < 3.
struct DeformedTet {
  btVector3 origin{0, 0, 0};
  btVector3 rows[3];
  btScalar steepest = 0;      ///< the largest change of a weight per unit of length
  btScalar restPerWorld = 0;  ///< an upper bound of the ratio of rest lengths to world lengths
  bool flat = true;

  void weightsAt(const btVector3& p, btScalar weights[4]) const;
};

/// Least weight with which a point counts as inside a tet: rounding must lose no point between two tets, and just
/// outside of the cage the surface is near.
constexpr btScalar kMinWeight = btScalar(-0.02);
/// A lower bound of the distance between a box and the points that count as inside the tet; below 0 if they may
/// overlap. The tet is not flat.
btScalar gapTo(const ContactBox& box, const DeformedTet& tet);

class ContactBody {
 public:
  ContactBody(btSoftBody& solved, std::shared_ptr<const ContactShape> ofShape, bool meetsItself, int number)
      : body(&solved), shape(std::move(ofShape)), self(meetsItself), id(number) {}

  const ShapeData& data() const { return dataOf(*shape); }
  /// True if the body has the nodes and tets that the shape was made for.
  bool fits() const;

  /// Reads the positions of the nodes, and computes their box. Cost O(nodes)
  void read();
  /// Fits the trees to the current positions; at most once after `read`. Cost O(tets + samples)
  void fit();
  /// Computed at the first call in a step, as are the samples of a run.
  const DeformedTet& deformed(int tet);
  /// The box around the tet's filled part, computed at the first call in a step.
  const ContactBox& around(int tet);
  const ContactBox& carry(int run);
  /// The boxes that `carryRun` and `around` have computed; valid after `fit`.
  const ContactBox& runBox(int run) const {
    assert(run >= 0 && static_cast<std::size_t>(run) < runBoxes_.size());
    return runBoxes_[static_cast<std::size_t>(run)];
  }
  const ContactBox& tetBox(int tet) const {
    assert(tet >= 0 && static_cast<std::size_t>(tet) < boxes_.size());
    return boxes_[static_cast<std::size_t>(tet)];
  }

  /// The position of a sample whose run has been carried.
  btVector3 sampleAt(int sample) const {
    const auto s = static_cast<std::size_t>(sample);
    return {samples[0][s], samples[1][s], samples[2][s]};
  }
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
  btVector3 centroid{0, 0, 0};  ///< centroid of the nodes
  btVector3 drift{0, 0, 0};     ///< mean velocity of the nodes, and the largest speed relative to it
  btScalar fastest = 0;
  double travelled = 0;  ///< over all steps so far, relative to the centroid: an upper bound of the path of any node
  std::vector<btVector3> positions;                    ///< by node
  std::vector<ContactBox> runTreeBoxes, tetTreeBoxes;  ///< by node of the shape's trees, valid after `fit`
  std::vector<btScalar> samples[3];                    ///< x, y and z coordinates in separate arrays

 private:
  void measureTravel(const btVector3& newCentroid);
  void measureSpeed();
  void measure(DeformedTet& tet, const Tet& n) const;
  void carryRun(const SampleRun& run, ContactBox& around);
  ContactBox filledBox(int tet) const;

  bool fitted_ = false;
  std::vector<btVector3> read_;  ///< positions before any correction
  std::vector<ContactBox> boxes_, runBoxes_;
  std::vector<DeformedTet> deformed_;
  std::vector<char> isDeformed_, isBoxed_, isCarried_;
};

}  // namespace tetskin::contact_detail
