// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a body's owner has set to change its rest shapes, by tet of its cage, until it is given to the tets that are
// simulated. It outlives them: they are made anew when the body is reset or scaled.
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/elastic/elastic_law.h>
#include <tetskin/elastic/material_changes.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace tetskin::elastic_detail {

class TETSKIN_ELASTIC_API MaterialChanges {
 public:
  MaterialChanges() = default;
  /// paintedDamping  see Cage
  explicit MaterialChanges(std::size_t tets, std::vector<double> paintedDamping = {})
      : tetCount_(tets), paintedDamping_(std::move(paintedDamping)) {}

  // Errors: InvalidOption, SizeMismatch, IndexOutOfRange, NonFinite; nothing is changed then.
  Status setPlasticity(const Plasticity& plasticity);
  void endPlasticity() { plasticity_.reset(); }
  Status setGrowth(double length) { return setGrowth(std::vector<double>(tetCount_, length)); }
  Status setGrowth(const std::vector<double>& lengths);
  Status setGrowthTensors(const std::vector<std::array<double, 9>>& deformations);
  Status setStiffnessScale(const std::vector<double>& factors);
  Status setDampingScale(const std::vector<double>& factors);
  /// tets  none: all
  Status setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets);
  Status addFibres(const Fibres& fibres);
  std::size_t fibresCount() const { return fibres_.size(); }
  std::size_t fibreTetCount() const;  ///< over all of them
  Result<int> addMuscle(const Muscle& muscle);
  Status setActivation(int muscle, double activation);
  double activation(int muscle) const;  ///< 0 for one that does not exist
  std::size_t muscleCount() const { return muscles_.size(); }

  /// Ok unless a body becomes too stiff, or too strongly damped, by them: see elastic_detail::checkStiffness.
  template <class S>
  Status checkStiffness(double youngsModulus, double damping, double mass, double volume) const;
  /// Makes change(these) if it succeeds, and check(these) after it; otherwise nothing is changed. Cost O(T)
  template <class Change, class Check>
  Status tryChange(Change&& change, Check&& check) {
    MaterialChanges changed = *this;
    Status status = change(changed);
    if (status.ok()) status = check(static_cast<const MaterialChanges&>(changed));
    if (status.ok()) *this = std::move(changed);
    return status;
  }
  /// Gives the shapes at which they are at rest to a body's tets: growth and muscles. The body refers to this while
  /// muscles depend on their length.
  template <class S>
  void applyShapesTo(BodyDynamics<S>& body, double poissonRatio, double youngsModulus) const;
  /// Gives all of it to a body with tets.
  template <class S>
  void applyTo(BodyDynamics<S>& body, double poissonRatio, double youngsModulus, double damping) const;
  /// Writes or reads what may change from step to step: growth, stiffness, damping, activations, limits of flow.
  void serialize(StateStream& stream);

 private:
  struct Group {
    Muscle muscle;
    double activation = 0.0;
    double steepest = 0.0;  ///< the largest slope of its curve of tension over length; at least 0
  };
  double largestScale() const;           ///< the largest factor of the stiffness; 1 without any
  double largestDamping() const;         ///< the same of the damping
  double largestFibreStiffness() const;  ///< the largest sum over the fibres of a tet
  std::vector<double> dampingFactors() const;
  std::vector<std::vector<TetFibre>> fibresByTet() const;
  void serializeLaws(StateStream& stream);
  bool givesShapes() const;
  bool dependsOnLengths() const;
  void findShapes(double poissonRatio, double youngsModulus, const TetStretches* stretches, bool ofAll,
                  GivenShapes& given) const;

  std::size_t tetCount_ = 0;
  std::optional<Plasticity> plasticity_;
  std::vector<std::array<double, 9>> growth_;  ///< by tet; empty: none
  std::vector<double> stiffnessScale_, paintedDamping_, dampingScale_;
  std::vector<Group> muscles_;
  std::vector<int> muscleTets_;             ///< those of all muscles, each once
  std::vector<std::uint32_t> muscleTetAt_;  ///< by tet: its place among them
  std::uint64_t shapesNumber_ = 1;          ///< of growth and muscles; activations do not count
  std::vector<Fibres> fibres_;
  std::vector<ElasticLaw> laws_;  ///< by tet; empty: all are corotated
};

}  // namespace tetskin::elastic_detail
