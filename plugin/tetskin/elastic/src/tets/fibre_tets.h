// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Fibres that run through tets: springs along a direction a of rest space, at the point of a linear tet and at the four
// of a quadratic one,
//   energy = V k / 2 e^2,  e = |F a| - 1,  force on node n = -V k e (g_n . a) d,  d = F a / |F a|
// It depends on the length of F a alone: it turns nothing, pushes nothing, and has no rotation to follow. The matrix
// has
//   V k (g_n . a) (g_m . a) (d d^T + t (1 - d d^T)),  t = e / |F a|, 0 for a fibre that is pressed
// with the first term also where a fibre is slack, which may be taut at the end of the step.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <array>
#include <vector>

namespace tetskin::elastic_detail {

/// Fibres of a tet.
struct TetFibre {
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< a, rest space; of length 1, less where they have grown
  double stiffness = 0.0;                           ///< k, pressure units, times what the volume has grown by; 0: none
  bool tensionOnly = false;

  bool operator==(const TetFibre& other) const {
    return along == other.along && stiffness == other.stiffness && tensionOnly == other.tensionOnly;
  }
};

template <class S>
class FibreTets {
 public:
  /// families      each by tet of the cage; some tet has fibres. A quadratic tet has the mean of its parts, of each
  /// shearModulus  of the tets, which resists sidewards, too
  FibreTets(const RestTets& rest, const std::vector<std::uint32_t>& slotOf,
            const std::vector<std::vector<TetFibre>>& families, double shearModulus);

  /// Adds their forces; see TetWork for points, frames and parts.
  /// keeps  false: a question, which changes nothing
  void addForces(const S* points, const S* frames, const std::uint32_t* partOf, bool keeps, S* out);
  double energy(const S* points, const S* frames, const std::uint32_t* partOf) const;
  /// How far the matrix is from the last `addForces` that kept: squared angles between directions, their mean and the
  /// largest; and whether some fibre has far more tension than the matrix counts.
  struct Outdated {
    double mean = 0.0, largest = 0.0;
    bool stiffer = false;
  };
  const Outdated& outdated() const { return outdated_; }
  /// V k over all fibres.
  double stiffness() const { return stiffness_; }
  /// Makes the layers for a matrix, by the last `addForces` that kept; `assembleAgain`: as they were.
  void assemble(double alpha);
  void assembleAgain(double alpha);
  kernels::FibreLayers<S> layers() const { return {corners_.data(), layerCount_, layerSize_}; }
  /// Writes or reads the directions of the matrix. Returns true if reading has changed them.
  bool serialize(StateStream& stream);

 private:
  void findOutdated();
  struct Direction {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    double t = 0.0;
  };
  /// At a point of a tet.
  struct Spring {
    std::array<std::uint32_t, kQuadraticNodes> slots{};
    std::array<double, kQuadraticNodes> weights{};  ///< g_n . a
    std::size_t nodes = 4;
    std::size_t corner = 0, toNode = 4, toComponent = 1;  ///< first scalar of its corners; from each to the next
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    double stiffness = 0.0, modulus = 0.0;  ///< V k, k
    bool tensionOnly = false;
    Direction now, assembled;
  };
  struct Stretch {
    Eigen::Vector3d carried;  ///< F a
    double length = 0.0, strain = 0.0;
  };
  Stretch stretchOf(const Spring& spring, const S* points, const S* frames, const std::uint32_t* partOf) const;
  Spring& add(const TetFibre& fibre, double volume);
  void addLinear(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t tet, const TetFibre& fibre,
                 std::size_t layer);
  void addQuadratic(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t number,
                    const TetFibre& fibre, std::size_t layer);

  std::vector<Spring> springs_;
  AlignedVector<S> corners_;
  std::size_t layerSize_ = 0, layerCount_ = 0;
  double shearModulus_ = 1.0, stiffness_ = 0.0;
  Outdated outdated_;
};

}  // namespace tetskin::elastic_detail
