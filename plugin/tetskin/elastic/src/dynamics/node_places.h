// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The positions of a body's nodes in double, whatever the precision of the caller's positions, which are their
// rounding. Far from the origin, or in a stiff body, a step moves a node by less than the last digit of a float.
//
// Forces follow from the displacements u of the nodes in a frame of their component, in which the component is at rest:
//   x = c + Q X + u
// with X the nodes at rest. A frame follows the rotation of its component, so that u is small if strains are: in float,
// u has the digits that x lacks. See corotation.h for the strains.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/core/types.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

template <class S>
class NodePlaces {
 public:
  /// rest    by node, rest space; empty: the tets' shapes at rest do not fit together. The nodes start there
  /// slotOf  by node
  /// partOf  by slot: its component
  NodePlaces(const std::vector<Eigen::Vector3d>& rest, const std::vector<std::uint32_t>& slotOf,
             const std::vector<std::uint32_t>& partOf, std::size_t parts);

  /// True if nodes at rest are known; otherwise displacements are positions relative to a point near the body.
  bool hasFrames() const { return !rest_.empty(); }
  /// The frames' rotations Q, quaternions w x y z by component, for TetWork.
  const S* frames() const { return quaternions_.data(); }

  /// Takes the caller's positions, 4 scalars per slot, for nodes where they are not the rounding of their own:
  /// something else has moved these nodes. If the whole body was moved rigidly, it keeps its shape to the last digit.
  void take(const AlignedVector<S>& points);
  /// A node's position.
  const double* at(std::size_t slot) const { return &places_[3 * slot]; }
  /// True if the caller's position is the node's, up to `near`; of two equally near roundings, either counts.
  bool isAt(std::size_t slot, const S* point, S near) const;
  /// Moves a node along a velocity.
  void advance(std::size_t slot, double seconds, const S* velocity) {
    for (std::size_t k = 0; k < 3; ++k) places_[3 * slot + k] += seconds * static_cast<double>(velocity[k]);
  }
  /// The node's position, rounded for the caller.
  void round(std::size_t slot, S* point) const {
    for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<S>(places_[3 * slot + k]);
  }

  /// Fits the frames to the nodes, and writes the displacements of all nodes, 4 scalars per slot.
  /// anchors  by component: the points to which positions are relative, without frames
  void displace(const std::vector<Eigen::Vector3d>& anchors, AlignedVector<S>& displacements);
  /// The largest component of these displacements.
  double largestDisplacement() const { return largest_; }
  /// Turns the frames with their components: displacements of nodes become those of the turned nodes.
  /// turns  by component
  void turnFrames(const std::vector<Eigen::Matrix3d>& turns);
  /// Moves nodes and frames along with a rigid motion: a rotation about the origin, then a translation.
  /// turns  false: no rotation
  void carry(bool turns, const Eigen::Matrix3d& turn, const Eigen::Vector3d& by);
  /// Replaces positions, 4 scalars per slot, by their displacements from the frames, up to a translation of each
  /// component. Changes nothing else.
  void displacePoints(AlignedVector<S>& points) const;
  /// The position of a displaced node, up to a translation of its component.
  /// T  float or double
  template <class T>
  void fromDisplacement(std::size_t slot, const S* displacement, T* position) const;

  /// Writes or reads the positions of nodes and frames.
  void serialize(StateStream& stream);

 private:
  struct Frame {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Eigen::Vector3d lag = Eigen::Vector3d::Zero();  ///< how far its rotation was behind, for the next step
  };
  /// A component at rest.
  struct Part {
    std::size_t first = 0;                                     ///< slot of a node with displacement 0
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();        ///< of its nodes
    Eigen::Matrix3d inverseInertia = Eigen::Matrix3d::Zero();  ///< of nodes with unit masses, about the centroid
  };

  Eigen::Map<const Eigen::Vector3d> placeAt(std::size_t slot) const {
    return Eigen::Map<const Eigen::Vector3d>(&places_[3 * slot]);
  }
  Eigen::Map<const Eigen::Vector3d> restAt(std::size_t slot) const {
    return Eigen::Map<const Eigen::Vector3d>(&rest_[3 * slot]);
  }
  void findParts();
  bool takeRigid(const AlignedVector<S>& points);
  void publish();

  std::vector<std::uint32_t> slotOf_, partOf_;
  std::vector<double> places_, rest_;  ///< 3 by slot; `rest_` may be empty
  std::vector<Part> parts_;
  double largest_ = 0.0;  ///< of the last `displace`
  std::vector<Frame> frames_;
  AlignedVector<S> quaternions_;  ///< of `frames_`
};

}  // namespace tetskin::elastic_detail
