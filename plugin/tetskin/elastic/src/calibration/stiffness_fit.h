// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/progress.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Loads on a cage and on its refinements, and the resulting displacements.
struct LoadSet {
  Fields accelerations;                   ///< of the cage's nodes; loads are the masses times these, balanced
  Fields loads;                           ///< on the cage: the loads on its finest refinement
  std::vector<Eigen::RowVectorXd> works;  ///< by level: loads times displacements
  Eigen::RowVectorXd limits;              ///< works in the limit of infinite refinement
  Eigen::RowVectorXd reach;               ///< the loads times the accelerations that cause them
  Eigen::RowVectorXd weights;             ///< the body's response in the limit; 0: left out
  /// By tet of the cage: strain energies in the cage and in the limit, relative to the works in the limit, summed over
  /// the loads. Empty unless there are two refinements.
  Eigen::VectorXd energies, limitEnergies;

  Eigen::RowVectorXd ratios(std::size_t level) const { return works[level].cwiseQuotient(limits); }
};

/// The factors of a cage's stiffness with which it moves as far as the limit of its refinements, under two kinds of
/// loads. The first are the accelerations of the softest vibrations, times each body's own masses. The second are sags:
/// gravity that grows with the squared distance from the middle, along the two longest axes of the body, in three
/// directions, so that the body bends without a support; the cage gets the loads of the refined body, because its own
/// masses are farther out. Neither assumes where a scene pins the body.
///
/// Factors by region come from strain energies. Where a load passes through a body like a current through resistors in
/// series, each region's energy is its compliance: its share in the cage, divided by that in the limit, is its
/// stiffness factor.
///
/// Full quadratic tets are not too stiff: their factor is 1. Nor are linear ones under loads that stretch or compress
/// the body; the error that the factors cause there is reported.
class StiffnessFit {
 public:
  /// bodies    must outlive this; at least one refinement
  /// progress  is told the progress; if the application cancels, the factors are not found
  StiffnessFit(const RefinedBodies& bodies, int modeCount, Progress& progress);

  const std::vector<double>& factors() const { return factors_; }  ///< by tet of the cage, at most 1
  bool byRegion() const { return byRegion_; }
  int skippedModes() const;
  std::vector<double> responses() const;  ///< by level: the mean of the works relative to their limits
  /// Root mean square errors of the cage with the factors: of the responses to its vibrations, and of its sags.
  double modeError() const { return modeError_; }
  double sagError() const { return sagError_; }
  /// How much farther than in the limit of its refinements the cage is stretched or compressed along its axes, as a
  /// fraction: without the factors, and with them.
  double plainStretchError() const { return plainStretchError_; }
  double stretchError() const { return stretchError_; }

 private:
  struct Ratios {
    Eigen::RowVectorXd modes, sags;  ///< responses relative to the limit
  };

  std::vector<double> scaled(std::vector<double> values, double factor) const;
  void fitOneFactor();
  void measureStretch();
  std::vector<double> regional(const Eigen::VectorXd& energies, const Eigen::VectorXd& limitEnergies) const;
  bool regionsPredict() const;
  double spreadWith(const std::vector<double>& factors, const LoadSet& loads) const;
  Ratios ratiosWith(const std::vector<double>& factors) const;
  double meanOf(const Ratios& ratios) const;

  const RefinedBodies& bodies_;
  std::vector<bool> exact_;  ///< by tet of the cage: quadratic and full; empty: none
  LoadSet modes_, sags_;
  double factor_ = 1.0;  ///< of all tets
  std::vector<double> factors_;
  bool byRegion_ = false;
  double modeError_ = 0.0, sagError_ = 0.0, plainStretchError_ = 0.0, stretchError_ = 0.0;
};

}  // namespace tetskin::elastic_detail
