// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/exported/material_changes.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace tetskin::elastic_detail {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The range of factors of length: beyond it, a tet's stiffness leaves that of its neighbours far behind.
constexpr double kLeastGrowth = 0.05, kLargestGrowth = 20.0;

/// The least factor of stiffness, and the inverse of the largest.
constexpr double kLeastStiffness = 1e-6;

Status invalidChange(std::string message) {
  return {StatusCode::InvalidOption, std::move(message)};
}

Status sizeMismatch(const char* what, std::size_t given, std::size_t wanted) {
  return {StatusCode::SizeMismatch,
          std::string(what) + ": " + std::to_string(given) + " values for " + std::to_string(wanted) + " tets"};
}

bool isGrowth(double factor) {
  return factor >= kLeastGrowth && factor <= kLargestGrowth;
}

Status badGrowth(std::size_t tet) {
  return invalidChange("growth: tet " + std::to_string(tet) +
                       " must have a symmetric matrix, or a factor of length, from 0.05 to 20");
}

/// Its factors of length along its axes are in the range.
bool isGrowth(const RowMatrix& deformation) {
  if (!deformation.allFinite() || !deformation.isApprox(deformation.transpose(), 1e-6)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(deformation, Eigen::EigenvaluesOnly);
  return isGrowth(axes.eigenvalues().minCoeff()) && isGrowth(axes.eigenvalues().maxCoeff());
}

/// The shape at which a muscle's tet is at rest.
/// tension  over Young's modulus
RowMatrix contracted(const Eigen::Vector3d& fibre, double tension, double poissonRatio) {
  const double most = 1.0 / kLeastGrowth - 1.0;
  const double w = std::min(2.0 * tension / (1.0 + std::sqrt(1.0 + 8.0 * poissonRatio * tension)), most);
  const double along = 1.0 / (1.0 + w), across = std::sqrt(1.0 + 2.0 * poissonRatio * w);
  const Eigen::Vector3d unit = fibre / std::sqrt(fibre.squaredNorm());
  return across * RowMatrix::Identity() + (along - across) * unit * unit.transpose();
}

}  // namespace

Status MaterialChanges::setPlasticity(const Plasticity& plasticity) {
  const auto isStress = [](double value) { return value > 0.0 && std::isfinite(value); };
  const std::vector<double>& byTet = plasticity.yieldStresses;
  if (!byTet.empty() && byTet.size() != tetCount_) return sizeMismatch("yieldStresses", byTet.size(), tetCount_);
  const auto bad = std::find_if_not(byTet.begin(), byTet.end(), isStress);
  if (bad != byTet.end()) {
    return invalidChange("the yield stress of tet " + std::to_string(bad - byTet.begin()) +
                         " must be finite and above 0");
  }
  if (byTet.empty() && !isStress(plasticity.yieldStress)) {
    return invalidChange("the yield stress must be finite and above 0");
  }
  if (!(plasticity.hardening >= 0.0 && std::isfinite(plasticity.hardening))) {
    return invalidChange("hardening must be finite, and 0 or more");
  }
  if (!(plasticity.flowRate > 0.0)) return invalidChange("the rate of flow must be above 0; infinite: at once");
  if (!(plasticity.largestStrain > 0.0)) {
    return invalidChange("the largest plastic strain must be above 0; infinite: no limit");
  }
  plasticity_ = plasticity;
  return {};
}

Status MaterialChanges::setGrowth(const std::vector<double>& lengths) {
  if (lengths.size() != tetCount_) return sizeMismatch("growth", lengths.size(), tetCount_);
  for (std::size_t t = 0; t < tetCount_; ++t) {
    if (!isGrowth(lengths[t])) return badGrowth(t);
  }
  const bool none = std::all_of(lengths.begin(), lengths.end(), [](double length) { return length == 1.0; });
  growth_.clear();
  for (std::size_t t = 0; t < tetCount_ && !none; ++t) {
    const double length = lengths[t];
    growth_.push_back({length, 0.0, 0.0, 0.0, length, 0.0, 0.0, 0.0, length});
  }
  return {};
}

Status MaterialChanges::setGrowthTensors(const std::vector<std::array<double, 9>>& deformations) {
  if (deformations.size() != tetCount_) return sizeMismatch("growth", deformations.size(), tetCount_);
  for (std::size_t t = 0; t < tetCount_; ++t) {
    if (!isGrowth(Eigen::Map<const RowMatrix>(deformations[t].data()))) return badGrowth(t);
  }
  growth_ = deformations;
  return {};
}

Status MaterialChanges::setStiffnessScale(const std::vector<double>& factors) {
  if (factors.size() != tetCount_) return sizeMismatch("stiffnessScale", factors.size(), tetCount_);
  const auto bad = std::find_if_not(factors.begin(), factors.end(), [](double factor) {
    return factor >= kLeastStiffness && factor <= 1.0 / kLeastStiffness;
  });
  if (bad != factors.end()) {
    return invalidChange("the stiffness scale of tet " + std::to_string(bad - factors.begin()) +
                         " must be from 1e-6 to 1e6");
  }
  const bool none = std::all_of(factors.begin(), factors.end(), [](double factor) { return factor == 1.0; });
  stiffnessScale_ = none ? std::vector<double>() : factors;
  return {};
}

Result<int> MaterialChanges::addMuscle(const Muscle& muscle) {
  if (muscle.tets.empty()) return invalidChange("a muscle needs at least one tet");
  std::vector<char> used(tetCount_, 0);
  for (const int tet : muscle.tets) {
    if (tet < 0 || static_cast<std::size_t>(tet) >= tetCount_) {
      return Status{
          StatusCode::IndexOutOfRange,
          "muscle: tet " + std::to_string(tet) + " does not exist in a cage of " + std::to_string(tetCount_) + " tets"};
    }
    if (used[static_cast<std::size_t>(tet)]++) {
      return invalidChange("muscle: tet " + std::to_string(tet) + " is listed twice");
    }
  }
  if (muscle.fibres.size() != 1 && muscle.fibres.size() != muscle.tets.size()) {
    return sizeMismatch("fibres", muscle.fibres.size(), muscle.tets.size());
  }
  for (std::size_t k = 0; k < muscle.fibres.size(); ++k) {
    const double squared = muscle.fibres[k].squaredNorm();
    if (!(squared > 0.0 && std::isfinite(squared))) {
      return invalidChange("muscle: fibre " + std::to_string(k) + " must be finite and longer than 0");
    }
  }
  if (!(muscle.stress > 0.0 && std::isfinite(muscle.stress))) {
    return invalidChange("the stress of a muscle must be finite and above 0");
  }
  muscles_.push_back({muscle, 0.0});
  return static_cast<int>(muscles_.size()) - 1;
}

Status MaterialChanges::setActivation(int muscle, double activation) {
  if (muscle < 0 || static_cast<std::size_t>(muscle) >= muscles_.size()) {
    return {StatusCode::IndexOutOfRange,
            "muscle " + std::to_string(muscle) + " does not exist in a body with " + std::to_string(muscles_.size())};
  }
  if (!(activation >= 0.0 && activation <= 1.0)) return invalidChange("the activation of a muscle must be from 0 to 1");
  muscles_[static_cast<std::size_t>(muscle)].activation = activation;
  return {};
}

double MaterialChanges::activation(int muscle) const {
  const bool exists = muscle >= 0 && static_cast<std::size_t>(muscle) < muscles_.size();
  return exists ? muscles_[static_cast<std::size_t>(muscle)].activation : 0.0;
}

bool MaterialChanges::givesShapes() const {
  return !growth_.empty() ||
         std::any_of(muscles_.begin(), muscles_.end(), [](const Group& group) { return group.activation > 0.0; });
}

/// By tet of the cage; where several muscles share a tet, their tensions are summed by their axes.
std::vector<std::array<double, 9>> MaterialChanges::givenShapes(double poissonRatio, double youngsModulus) const {
  if (!givesShapes()) return {};
  std::vector<std::array<double, 9>> given = growth_;
  if (given.empty()) given.assign(tetCount_, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  for (const Group& group : muscles_) {
    if (!(group.activation > 0.0)) continue;
    const Muscle& muscle = group.muscle;
    for (std::size_t k = 0; k < muscle.tets.size(); ++k) {
      Eigen::Map<RowMatrix> shape(given[static_cast<std::size_t>(muscle.tets[k])].data());
      const double tension = group.activation * muscle.stress / youngsModulus;
      shape = (contracted(muscle.fibres[muscle.fibres.size() == 1 ? 0 : k], tension, poissonRatio) * shape).eval();
    }
  }
  return given;
}

double MaterialChanges::largestScale() const {
  return stiffnessScale_.empty() ? 1.0 : *std::max_element(stiffnessScale_.begin(), stiffnessScale_.end());
}

template <class S>
void MaterialChanges::applyShapesTo(CorotatedTets<S>& tets, double poissonRatio, double youngsModulus) const {
  tets.setGiven(givenShapes(poissonRatio, youngsModulus));
}

template <class S>
void MaterialChanges::applyTo(CorotatedTets<S>& tets, double poissonRatio, double youngsModulus) const {
  applyShapesTo(tets, poissonRatio, youngsModulus);
  tets.setPlasticity(plasticity_ ? &*plasticity_ : nullptr);
}

void MaterialChanges::serialize(StateStream& stream) {
  std::size_t count = growth_.size();
  stream(count);
  if (stream.restoring()) growth_.resize(count == tetCount_ ? count : 0);
  if (count != growth_.size()) return stream.fail();
  for (std::array<double, 9>& shape : growth_) stream.plain(shape.data(), shape.size());
  stream.array(stiffnessScale_);
  if (!stiffnessScale_.empty() && stiffnessScale_.size() != tetCount_) {
    stiffnessScale_.clear();
    return stream.fail();
  }
  for (Group& group : muscles_) {
    stream(group.activation);
    if (!(group.activation >= 0.0 && group.activation <= 1.0)) stream.fail();
  }
  bool flows = plasticity_.has_value();
  stream(flows);
  if (!flows) return plasticity_.reset();
  Plasticity now = plasticity_.value_or(Plasticity());
  stream(now.yieldStress);
  stream(now.hardening);
  stream(now.flowRate);
  stream(now.largestStrain);
  stream.array(now.yieldStresses);
  if (!now.yieldStresses.empty() && now.yieldStresses.size() != tetCount_) return stream.fail();
  if (stream.restoring()) plasticity_ = now;
}

#define TETSKIN_INSTANTIATE(Scalar)                                                                   \
  template void MaterialChanges::applyShapesTo<Scalar>(CorotatedTets<Scalar>&, double, double) const; \
  template void MaterialChanges::applyTo<Scalar>(CorotatedTets<Scalar>&, double, double) const;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
