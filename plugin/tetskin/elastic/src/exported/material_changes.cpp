// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/exported/material_changes.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace tetskin::elastic_detail {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The range of factors of length: beyond it, a tet's stiffness leaves that of its neighbours far behind.
constexpr double kLeastGrowth = 0.05, kLargestGrowth = 20.0;

constexpr std::uint32_t kNoMuscle = 0xffffffff;  ///< of a tet that no muscle has

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

/// The contraction w, see `contracted`, by which a muscle pulls with a tension beside its elasticity when it is
/// stretched by s. A tet that is free across its fibres has (1 + 2 nu w) (s (1 + w) - 1) E on its first area. Below a
/// stretch of 2 nu / (1 + 2 nu), that first falls with w. It gets less there: the exact w would jump where the tension
/// begins.
/// tension  over Young's modulus
double contraction(double tension, double poissonRatio, double stretch) {
  if (!(tension > 0.0)) return 0.0;
  const double slope = std::max(stretch + 2.0 * poissonRatio * (stretch - 1.0), 0.0);
  return std::min(2.0 * tension / (slope + std::sqrt(slope * slope + 8.0 * poissonRatio * stretch * tension)),
                  1.0 / kLeastGrowth - 1.0);
}

/// The shape at which a muscle's tet is at rest.
RowMatrix contracted(const Eigen::Vector3d& unit, double w, double poissonRatio) {
  const double along = 1.0 / (1.0 + w), across = std::sqrt(1.0 + 2.0 * poissonRatio * w);
  return across * RowMatrix::Identity() + (along - across) * unit * unit.transpose();
}

double valueOf(const std::vector<std::array<double, 2>>& curve, double at) {
  const auto next = std::find_if(curve.begin(), curve.end(), [at](const auto& point) { return point[0] > at; });
  if (next == curve.begin()) return curve.front()[1];
  if (next == curve.end()) return curve.back()[1];
  const auto& [x, y] = *(next - 1);
  return y + ((*next)[1] - y) * (at - x) / ((*next)[0] - x);
}

double steepestOf(const std::vector<std::array<double, 2>>& curve) {
  double steepest = 0.0;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    steepest = std::max(steepest, (curve[k][1] - curve[k - 1][1]) / (curve[k][0] - curve[k - 1][0]));
  }
  return steepest;
}

Status checkCurve(const std::vector<std::array<double, 2>>& curve) {
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const auto& [stretch, factor] = curve[k];
    const bool ascends = stretch > (k > 0 ? curve[k - 1][0] : 0.0) && std::isfinite(stretch);
    if (ascends && factor >= 0.0 && std::isfinite(factor)) continue;
    return invalidChange("muscle: point " + std::to_string(k) +
                         " of lengthFactors must have a larger stretch than the one before, above 0, and a factor of 0 "
                         "or more, both finite");
  }
  return {};
}

/// Tets of the cage, each once.
/// what  has them
Status checkTets(const std::string& what, const std::vector<int>& tets, std::size_t tetCount) {
  std::vector<char> used(tetCount, 0);
  for (const int tet : tets) {
    if (tet < 0 || static_cast<std::size_t>(tet) >= tetCount) {
      return Status{
          StatusCode::IndexOutOfRange,
          what + ": tet " + std::to_string(tet) + " does not exist in a cage of " + std::to_string(tetCount) + " tets"};
    }
    if (used[static_cast<std::size_t>(tet)]++) {
      return invalidChange(what + ": tet " + std::to_string(tet) + " is listed twice");
    }
  }
  return {};
}

/// Directions of tets of the cage.
Status checkFibres(const std::string& what, const std::vector<int>& tets,
                   const std::vector<Eigen::Vector3d>& directions, std::size_t tetCount) {
  if (tets.empty()) return invalidChange(what + ": needs at least one tet");
  if (Status status = checkTets(what, tets, tetCount); !status.ok()) return status;
  if (directions.size() != 1 && directions.size() != tets.size()) {
    return sizeMismatch("fibres", directions.size(), tets.size());
  }
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const double squared = directions[k].squaredNorm();
    if (!(squared > 0.0 && std::isfinite(squared))) {
      return invalidChange(what + ": fibre " + std::to_string(k) + " must be finite and longer than 0");
    }
  }
  return {};
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
  ++shapesNumber_;
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
  ++shapesNumber_;
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

Status MaterialChanges::setDampingScale(const std::vector<double>& factors) {
  if (factors.size() != tetCount_) return sizeMismatch("dampingScale", factors.size(), tetCount_);
  const auto bad =
      std::find_if_not(factors.begin(), factors.end(), [](double f) { return f >= 0.0 && std::isfinite(f); });
  if (bad != factors.end()) {
    return invalidChange("the damping scale of tet " + std::to_string(bad - factors.begin()) +
                         " must be finite, and 0 or more");
  }
  const bool none = std::all_of(factors.begin(), factors.end(), [](double factor) { return factor == 1.0; });
  dampingScale_ = none ? std::vector<double>() : factors;
  return {};
}

Status MaterialChanges::setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets) {
  if (Status status = checkElasticLaw(law); !status.ok()) return status;
  if (Status status = checkTets("an elastic law", tets, tetCount_); !status.ok()) return status;
  std::vector<ElasticLaw> laws = laws_;
  laws.resize(tetCount_);
  if (tets.empty()) laws.assign(tetCount_, law);
  for (const int tet : tets) laws[static_cast<std::size_t>(tet)] = law;
  const bool none = std::all_of(laws.begin(), laws.end(), [](const ElasticLaw& own) { return own == ElasticLaw(); });
  laws_ = none ? std::vector<ElasticLaw>() : std::move(laws);
  return {};
}

/// By tet of the cage; empty: 1.
std::vector<double> MaterialChanges::dampingFactors() const {
  if (paintedDamping_.empty() || dampingScale_.empty())
    return paintedDamping_.empty() ? dampingScale_ : paintedDamping_;
  std::vector<double> factors = paintedDamping_;
  for (std::size_t t = 0; t < factors.size(); ++t) factors[t] *= dampingScale_[t];
  return factors;
}

double MaterialChanges::largestDamping() const {
  const std::vector<double> factors = dampingFactors();
  return factors.empty() ? 1.0 : *std::max_element(factors.begin(), factors.end());
}

Status MaterialChanges::addFibres(const Fibres& fibres) {
  if (Status status = checkFibres("fibres", fibres.tets, fibres.directions, tetCount_); !status.ok()) return status;
  if (!(fibres.stiffness > 0.0 && std::isfinite(fibres.stiffness))) {
    return invalidChange("the stiffness of fibres must be finite and above 0");
  }
  fibres_.push_back(fibres);
  return {};
}

std::size_t MaterialChanges::fibreTetCount() const {
  std::size_t count = 0;
  for (const Fibres& fibres : fibres_) count += fibres.tets.size();
  return count;
}

double MaterialChanges::largestFibreStiffness() const {
  if (fibres_.empty()) return 0.0;
  std::vector<double> sums(tetCount_, 0.0);
  for (const Fibres& fibres : fibres_) {
    for (const int tet : fibres.tets) sums[static_cast<std::size_t>(tet)] += fibres.stiffness;
  }
  return *std::max_element(sums.begin(), sums.end());
}

template <class S>
Status MaterialChanges::checkStiffness(double youngsModulus, double damping, double mass, double volume) const {
  const double stiffest = std::max(largestScale(), 1.0) * (youngsModulus + largestFibreStiffness());
  return elastic_detail::checkStiffness<S>(stiffest, largestDamping() * damping, mass, volume, !fibres_.empty());
}

/// By the order of their calls, and tet of the cage, with the growth of now.
std::vector<std::vector<TetFibre>> MaterialChanges::fibresByTet() const {
  std::vector<std::vector<TetFibre>> families;
  for (const Fibres& fibres : fibres_) {
    std::vector<TetFibre>& family = families.emplace_back(tetCount_);
    for (std::size_t k = 0; k < fibres.tets.size(); ++k) {
      const auto tet = static_cast<std::size_t>(fibres.tets[k]);
      TetFibre& own = family[tet];
      own.along = fibres.directions[fibres.directions.size() == 1 ? 0 : k].normalized();
      own.stiffness = fibres.stiffness;
      own.tensionOnly = fibres.tensionOnly;
      if (growth_.empty()) continue;
      const Eigen::Map<const RowMatrix> growth(growth_[tet].data());
      own.along = (growth.inverse() * own.along).eval();
      own.stiffness *= growth.determinant();
    }
  }
  return families;
}

Result<int> MaterialChanges::addMuscle(const Muscle& muscle) {
  if (Status status = checkFibres("muscle", muscle.tets, muscle.fibres, tetCount_); !status.ok()) return status;
  if (!(muscle.stress > 0.0 && std::isfinite(muscle.stress))) {
    return invalidChange("the stress of a muscle must be finite and above 0");
  }
  if (Status status = checkCurve(muscle.lengthFactors); !status.ok()) return status;
  muscles_.push_back({muscle, 0.0, steepestOf(muscle.lengthFactors)});
  muscleTetAt_.resize(tetCount_, kNoMuscle);
  for (const int tet : muscle.tets) {
    std::uint32_t& at = muscleTetAt_[static_cast<std::size_t>(tet)];
    if (at != kNoMuscle) continue;
    at = static_cast<std::uint32_t>(muscleTets_.size());
    muscleTets_.push_back(tet);
  }
  ++shapesNumber_;
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

/// A muscle that is active pulls by its length.
bool MaterialChanges::dependsOnLengths() const {
  return std::any_of(muscles_.begin(), muscles_.end(),
                     [](const Group& group) { return group.activation > 0.0 && !group.muscle.lengthFactors.empty(); });
}

/// By tet of the cage; where several muscles share a tet, their tensions are summed by their axes. Forces of a muscle
/// whose tension grows with its length are stiffer than its tets by (1 + slope / E) over what these have along it.
/// stretches  null: no muscle depends on its length
/// ofAll      false: of `muscleTets_`, in their order
void MaterialChanges::findShapes(double poissonRatio, double youngsModulus, const TetStretches* stretches, bool ofAll,
                                 GivenShapes& given) const {
  if (!givesShapes()) return;
  const std::size_t count = ofAll ? tetCount_ : muscleTets_.size();
  given.shapes.assign(count, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  for (std::size_t k = 0; k < count && !growth_.empty(); ++k)
    given.shapes[k] = growth_[ofAll ? k : static_cast<std::size_t>(muscleTets_[k])];
  given.stiffer.assign(stretches ? count : 0, 1.0);
  for (const Group& group : muscles_) {
    if (!(group.activation > 0.0)) continue;
    const Muscle& muscle = group.muscle;
    const double tension = group.activation * muscle.stress / youngsModulus;
    for (std::size_t k = 0; k < muscle.tets.size(); ++k) {
      const auto tet = static_cast<std::size_t>(muscle.tets[k]);
      const std::size_t at = ofAll ? tet : muscleTetAt_[tet];
      Eigen::Map<RowMatrix> shape(given.shapes[at].data());
      const Eigen::Vector3d& fibre = muscle.fibres[muscle.fibres.size() == 1 ? 0 : k];
      const Eigen::Vector3d unit = fibre / std::sqrt(fibre.squaredNorm());
      double w = 0.0;
      if (muscle.lengthFactors.empty()) {
        w = contraction(tension, poissonRatio, 1.0);
      } else {
        // From its length when it has grown.
        const Eigen::Vector3d grown =
            growth_.empty() ? unit : Eigen::Vector3d(Eigen::Map<const RowMatrix>(growth_[tet].data()).inverse() * unit);
        const double stretch = std::clamp(stretches->length(tet, grown), kLeastGrowth, kLargestGrowth);
        w = contraction(tension * valueOf(muscle.lengthFactors, stretch), poissonRatio, stretch);
        const double own = (1.0 + w) * (1.0 + 2.0 * poissonRatio * w);
        given.stiffer[at] = std::max(given.stiffer[at], (1.0 + tension * group.steepest) / own);
      }
      shape = (contracted(unit, w, poissonRatio) * shape).eval();
    }
  }
}

double MaterialChanges::largestScale() const {
  return stiffnessScale_.empty() ? 1.0 : *std::max_element(stiffnessScale_.begin(), stiffnessScale_.end());
}

template <class S>
void MaterialChanges::applyShapesTo(BodyDynamics<S>& body, double poissonRatio, double youngsModulus) const {
  body.setFibres(fibresByTet());
  if (dependsOnLengths()) {
    return body.setShapeLaw(
        {[this, poissonRatio, youngsModulus](const TetStretches& stretches, bool ofAll, GivenShapes& given) {
           findShapes(poissonRatio, youngsModulus, &stretches, ofAll, given);
         },
         muscleTets_, shapesNumber_});
  }
  body.setShapeLaw({});
  GivenShapes given;
  findShapes(poissonRatio, youngsModulus, nullptr, true, given);
  body.tets()->setGiven(given);
}

template <class S>
void MaterialChanges::applyTo(BodyDynamics<S>& body, double poissonRatio, double youngsModulus, double damping) const {
  if (body.tets()->setStiffnessScale(stiffnessScale_)) body.setMaterial(lameOf(youngsModulus, poissonRatio));
  body.setDamping(damping, dampingFactors());
  body.setLaws(laws_);
  applyShapesTo(body, poissonRatio, youngsModulus);
  body.tets()->setPlasticity(plasticity_ ? &*plasticity_ : nullptr);
}

void MaterialChanges::serialize(StateStream& stream) {
  std::size_t count = growth_.size();
  stream(count);
  if (stream.restoring()) growth_.resize(count == tetCount_ ? count : 0);
  if (count != growth_.size()) return stream.fail();
  for (std::array<double, 9>& shape : growth_) stream.plain(shape.data(), shape.size());
  if (stream.restoring()) ++shapesNumber_;
  for (std::vector<double>* scale : {&stiffnessScale_, &dampingScale_}) {
    stream.array(*scale);
    if (scale->empty() || scale->size() == tetCount_) continue;
    scale->clear();
    return stream.fail();
  }
  serializeLaws(stream);
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

void MaterialChanges::serializeLaws(StateStream& stream) {
  std::size_t count = laws_.size();
  stream(count);
  if (stream.restoring()) laws_.resize(count == tetCount_ ? count : 0);
  if (count != laws_.size()) return stream.fail();
  for (ElasticLaw& law : laws_) {
    stream(law.kind, law.c2, law.c3);
    if (law.kind > ElasticLaw::Kind::Yeoh || !checkElasticLaw(law).ok()) law = {}, stream.fail();
  }
}

#define TETSKIN_INSTANTIATE(Scalar)                                                                  \
  template Status MaterialChanges::checkStiffness<Scalar>(double, double, double, double) const;     \
  template void MaterialChanges::applyShapesTo<Scalar>(BodyDynamics<Scalar>&, double, double) const; \
  template void MaterialChanges::applyTo<Scalar>(BodyDynamics<Scalar>&, double, double, double) const;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
