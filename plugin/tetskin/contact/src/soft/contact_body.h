// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: a body, and where it is in this step.
#pragma once

#include <tetskin/contact/src/soft/shape_data.h>

#include <memory>
#include <vector>

namespace tetskin::contact_detail {

/// From a point in the world to its weights in a deformed tet: weight i is rows[i] . (p - origin), i < 3.
struct DeformedTet {
  btVector3 origin{0, 0, 0};
  btVector3 rows[3];
  btScalar steepest = 0;      ///< of the weights: by how much one changes, at most, over a unit of length
  btScalar restPerWorld = 0;  ///< no less than lengths at rest are over those in the world
  bool flat = true;

  void weightsAt(const btVector3& p, btScalar weights[4]) const;
};

/// A weight from which a point counts as in a tet: between two, rounding must lose none, and just outside of the cage
/// the surface is near.
constexpr btScalar kLeastWeight = btScalar(-0.02);
/// How far a box is from where points count as in the tet, no more than that; below 0 if they may meet. The tet is not
/// flat.
btScalar gapTo(const ContactBox& box, const DeformedTet& tet);

class ContactBody {
 public:
  ContactBody(btSoftBody& of, std::shared_ptr<const ContactShape> ofShape, bool meetsItself, int number)
      : body(&of), shape(std::move(ofShape)), self(meetsItself), id(number) {}

  const ShapeData& data() const { return shape->data(); }
  /// Whether the body has the nodes and tets that the shape was made for.
  bool fits() const;

  /// Where the nodes are, and the box around them. Cost O(nodes)
  void read();
  /// The trees for where it is; at most once after `read`. Cost O(tets + samples)
  void fit();
  /// Computed when it is first asked for in a step, as are the samples of a run; returns the box around these.
  const DeformedTet& deformed(int tet);
  /// Around the tet's filled part, likewise.
  const ContactBox& around(int tet);
  const ContactBox& carry(int run);
  /// The boxes that these return, after `fit`.
  const ContactBox& runBox(int run) const { return runBoxes_[static_cast<std::size_t>(run)]; }
  const ContactBox& tetBox(int tet) const { return boxes_[static_cast<std::size_t>(tet)]; }

  /// Of a run that has been carried.
  btVector3 sampleAt(int sample) const {
    const auto s = static_cast<std::size_t>(sample);
    return {samples[0][s], samples[1][s], samples[2][s]};
  }
  /// Of a point of a tet.
  btVector3 velocityAt(int tet, const btScalar weights[4]) const;

  btSoftBody* body;
  std::shared_ptr<const ContactShape> shape;
  bool self;
  int id;
  // In this step.
  bool awake = true;
  bool readable = false;  ///< all positions are finite
  ContactBox box;
  btVector3 middle{0, 0, 0};  ///< of the nodes
  btVector3 drift{0, 0, 0};   ///< mean velocity of the nodes, and how much faster than that the fastest is
  btScalar fastest = 0;
  double travelled = 0;  ///< in all steps so far, of the nodes against their middle: no less than the furthest has
  std::vector<btVector3> positions;                    ///< by node
  std::vector<ContactBox> runTreeBoxes, tetTreeBoxes;  ///< by node of the shape's trees, after `fit`
  std::vector<btScalar> samples[3];                    ///< coordinates, one after the other

 private:
  void measureTravel(const btVector3& newMiddle);
  void measureSpeed();
  void measure(DeformedTet& of, const Tet& n) const;
  void carryRun(const SampleRun& run, ContactBox& around);
  ContactBox filledBox(int tet) const;

  bool fitted_ = false;
  std::vector<btVector3> read_;  ///< positions, before anything has corrected them
  std::vector<ContactBox> boxes_, runBoxes_;
  std::vector<DeformedTet> deformed_;
  std::vector<char> isDeformed_, isBoxed_, isCarried_;
};

}  // namespace tetskin::contact_detail
