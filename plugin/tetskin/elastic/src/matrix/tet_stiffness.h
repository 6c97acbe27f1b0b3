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
/// G = sum_n v_n a_n^T there, and node n gets (ratio tr(G) + spread G + G^T) a_n. Fibres have points of their own, in
/// layers after that of the tets, which is 0: those of odd layers get tr(G) a_n, of even ones G a_n.
struct StiffnessPoint {
  const std::uint32_t* slots = nullptr;      ///< of the tet's nodes
  const Eigen::Vector3d* vectors = nullptr;  ///< a, by node
  std::size_t nodes = 0, layer = 0;          ///< layer: 0 for the tet, 1 and more for its fibres
};

/// The data from which a matrix was assembled.
template <class S>
struct MatrixSource {
  const RestTets& rest;
  const S* corners;     ///< see CorotatedTets::cornersForMatrix
  double ratio;         ///< lambda / mu
  double spread = 1.0;  ///< see BlockMatrix::assemble
  kernels::FibreLayers<S> fibres = {};
};

class TetStiffness {
 public:
  /// slotOf  by node
  TetStiffness(const RestTets& rest, const std::vector<std::uint32_t>& slotOf);

  /// The tets must be the same as before. Cost O(T)
  template <class S>
  void take(const MatrixSource<S>& source);

  /// Adds alpha K times velocities to impulses, both 3 scalars per slot. Cost O(T)
  void addProduct(const std::vector<double>& velocities, std::vector<double>& impulses) const;
  /// The impulses per gradient G at a point of a layer: ratio tr(G) + spread G + G^T.
  Eigen::Matrix3d stress(const Eigen::Matrix3d& gradient, std::size_t layer = 0) const;

  /// Calls visit(point) for all points, layer by layer.
  template <class Visit>
  void forPoints(Visit&& visit) const {
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      const Eigen::Vector3d* const vectors = vectors_.data() + layer * perLayer_;
      for (std::size_t k = 0; k < counts_.size(); ++k) {
        visit(StiffnessPoint{&slots_[firstSlots_[k]], vectors + firstVectors_[k], counts_[k], layer});
      }
    }
  }

 private:
  void addFibres(const StiffnessPoint& at, const Eigen::Matrix3d& gradient, std::vector<double>& impulses) const;

  std::vector<std::uint32_t> slots_;                               ///< of all tets' nodes
  std::vector<std::uint32_t> firstSlots_, firstVectors_, counts_;  ///< by point
  std::vector<Eigen::Vector3d> vectors_;
  std::size_t perLayer_ = 0, layers_ = 1;  ///< vectors of a layer; the first layer is that of the tets
  double ratio_ = 0.0, spread_ = 1.0;
};

}  // namespace tetskin::elastic_detail
