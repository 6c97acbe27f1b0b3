// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a body's owner has set to change its rest shapes, by tet of its cage, until it is given to the tets that are
// simulated. It outlives them: they are made anew when the body is reset or scaled.
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/elastic/material_changes.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <array>
#include <optional>
#include <vector>

namespace tetskin::elastic_detail {

class TETSKIN_ELASTIC_API MaterialChanges {
 public:
  MaterialChanges() = default;
  explicit MaterialChanges(std::size_t tets) : tetCount_(tets) {}

  // Errors: InvalidOption, SizeMismatch, IndexOutOfRange, NonFinite; nothing is changed then.
  Status setPlasticity(const Plasticity& plasticity);
  void endPlasticity() { plasticity_.reset(); }
  Status setGrowth(double length) { return setGrowth(std::vector<double>(tetCount_, length)); }
  Status setGrowth(const std::vector<double>& lengths);
  Status setGrowthTensors(const std::vector<std::array<double, 9>>& deformations);
  Status setStiffnessScale(const std::vector<double>& factors);
  /// By tet of the cage; empty: 1.
  const std::vector<double>& stiffnessScale() const { return stiffnessScale_; }
  Result<int> addMuscle(const Muscle& muscle);
  Status setActivation(int muscle, double activation);
  double activation(int muscle) const;  ///< 0 for one that does not exist
  std::size_t muscleCount() const { return muscles_.size(); }

  /// The largest factor of the stiffness; 1 without any.
  double largestScale() const;
  /// Gives the shapes at which they are at rest to tets of this material: growth and muscles.
  template <class S>
  void applyShapesTo(CorotatedTets<S>& tets, double poissonRatio, double youngsModulus) const;
  /// Gives all of it to tets of this material, but for the stiffness: see `CorotatedTets::setStiffnessScale`.
  template <class S>
  void applyTo(CorotatedTets<S>& tets, double poissonRatio, double youngsModulus) const;
  /// Writes or reads what may change from step to step: growth, stiffness, activations, the limits of flow.
  void serialize(StateStream& stream);

 private:
  struct Group {
    Muscle muscle;
    double activation = 0.0;
  };
  bool givesShapes() const;
  std::vector<std::array<double, 9>> givenShapes(double poissonRatio, double youngsModulus) const;

  std::size_t tetCount_ = 0;
  std::optional<Plasticity> plasticity_;
  std::vector<std::array<double, 9>> growth_;  ///< by tet; empty: none
  std::vector<double> stiffnessScale_;
  std::vector<Group> muscles_;
};

}  // namespace tetskin::elastic_detail
