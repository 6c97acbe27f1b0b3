// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The matrix alpha K of a body as a sum over strains of tets, in double precision. In a matrix of floats, rounding
// resists rotations, more than bending does in a beam that is 50 times as long as thick; strains of a rotation are 0.
#pragma once

#include <tetskin/elastic/src/tets/rest_tets.h>

#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

/// An integration point of a tet: a linear tet has one, a quadratic tet four. A motion v of the nodes has the gradient
/// G = sum_n v_n a_n^T there, and node n gets (ratio tr(G) + spread G + G^T) a_n.
struct StiffnessPoint {
  const std::uint32_t* slots = nullptr;      ///< of the tet's nodes
  const Eigen::Vector3d* vectors = nullptr;  ///< a, by node
  std::size_t nodes = 0;
};

/// The data from which a matrix was assembled.
template <class S>
struct MatrixSource {
  const RestTets& rest;
  const S* corners;     ///< see CorotatedTets::cornersForMatrix
  double ratio;         ///< lambda / mu
  double spread = 1.0;  ///< see BlockMatrix::assemble
};

class TetStiffness {
 public:
  /// slotOf  by node
  TetStiffness(const RestTets& rest, const std::vector<std::uint32_t>& slotOf);

  /// The tets must be the same as before. Cost O(T)
  /// shares  by tet, linear ones first: factors of their stiffness, 0 or more; empty: 1
  template <class S>
  void take(const MatrixSource<S>& source, const std::vector<double>& shares = {});

  /// Adds alpha K times velocities to impulses, both 3 scalars per slot. Cost O(T)
  void addProduct(const std::vector<double>& velocities, std::vector<double>& impulses) const;
  /// The impulses per gradient G at a point: ratio tr(G) + spread G + G^T.
  Eigen::Matrix3d stress(const Eigen::Matrix3d& gradient) const;

  std::size_t pointCount() const { return counts_.size(); }
  StiffnessPoint point(std::size_t k) const {
    return {&slots_[firstSlots_[k]], &vectors_[firstVectors_[k]], counts_[k]};
  }

 private:
  std::vector<std::uint32_t> slots_;                               ///< of all tets' nodes
  std::vector<std::uint32_t> firstSlots_, firstVectors_, counts_;  ///< by point
  std::vector<Eigen::Vector3d> vectors_;
  double ratio_ = 0.0, spread_ = 1.0;
};

}  // namespace tetskin::elastic_detail
