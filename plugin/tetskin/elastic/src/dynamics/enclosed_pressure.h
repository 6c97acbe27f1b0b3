// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The pressure in a body as its steps see it: forces on the nodes of a surface, the stiffness of a gas, and the tension
// of thin walls, which is a part of the matrix.
#pragma once

#include <tetskin/elastic/src/dynamics/node_places.h>
#include <tetskin/elastic/src/dynamics/pressure_law.h>
#include <tetskin/elastic/src/dynamics/pressure_surface.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace tetskin::elastic_detail {

template <class S>
class EnclosedPressure {
 public:
  /// surface  null: there is no pressure
  void set(const PressureLaw& law, std::shared_ptr<PressureSurface> surface, BlockMatrix<S>& matrix);
  bool acts() const { return surface_ != nullptr; }

  /// The volume that a surface encloses at these points, 4 scalars per slot. Positions that are still the nodes' own
  /// get all of their digits.
  static double volumeAt(const AlignedVector<S>& points, PressureSurface& surface, const BlockMatrix<S>& matrix,
                         const NodePlaces<S>& places);
  /// The potential energy at these points; 0 without a pressure.
  double energyAt(const AlignedVector<S>& points, const BlockMatrix<S>& matrix, const NodePlaces<S>& places) const;
  /// Adds the forces at these points, 4 scalars per slot. Does not change what a step knows.
  void addForcesAt(const AlignedVector<S>& points, const BlockMatrix<S>& matrix, const NodePlaces<S>& places,
                   AlignedVector<S>& forces) const;

  /// Begins a step: adds the forces at displaced nodes, and finds what follows.
  /// moved     displacements, see NodePlaces
  void addForces(const AlignedVector<S>& moved, double shearModulus, double materialVolume,
                 const BlockMatrix<S>& matrix, const NodePlaces<S>& places, AlignedVector<S>& forces,
                 ParallelFor* threads);
  /// The factor by which tension stretches the matrix: see BlockMatrix::assemble. 1: there is none.
  double stretch() const { return stretch_; }
  /// The square of the frequency of the gas alone, 1 / s^2.
  double gasFrequency() const { return gasFrequency_; }
  /// Gives the stiffness of the gas to the matrix, times alpha.
  void stiffen(BlockMatrix<S>& matrix, double alpha) const;

 private:
  PressureLaw law_;
  std::shared_ptr<PressureSurface> surface_;
  std::vector<std::uint32_t> slots_;  ///< by node of the surface
  std::vector<double> gasStiffness_;  ///< u of BlockMatrix::setOuter over the root of alpha
  double gasFrequency_ = 0.0, stretch_ = 1.0;
};

}  // namespace tetskin::elastic_detail
