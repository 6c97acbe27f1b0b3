// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/positive_values.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>
#include <tetskin/elastic/src/exported/body_pressure.h>
#include <tetskin/elastic/src/exported/material_changes.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin {
namespace {

using elastic_detail::BodyDynamics;
using kernels::kGroup;

/// The options, completed by the cage's values.
ElasticOptions withCageDefaults(const Cage& cage, ElasticOptions options) {
  if (options.stiffnessScale.empty()) options.stiffnessScale = cage.stiffnessScale();
  if (options.nodeMasses.empty()) {
    for (const double mass : cage.masses) options.nodeMasses.push_back(options.density * mass);
  }
  return options;
}

/// options  completed by the cage's values
template <class Scalar>
Status checkOptions(const Cage& cage, const ElasticOptions& options) {
  const TetMesh& mesh = cage.mesh;
  const auto held = [](double value) { return std::isfinite(static_cast<Scalar>(value)); };
  if (Status status =
          elastic_detail::checkMaterial<Scalar>(options.youngsModulus, options.poissonRatio, options.stiffnessDamping);
      !status.ok()) {
    return status;
  }
  if (!(options.density > 0.0 && held(options.density) && held(1.0 / options.density))) {
    return {StatusCode::InvalidOption, "the density must be finite and above 0"};
  }
  if (!(options.tolerance >= 0.0 && options.tolerance < 1.0) || options.maxIterations < 1) {
    return {StatusCode::InvalidOption,
            "the tolerance must be at least 0 and below 1, and the number of iterations at least 1"};
  }
  const elastic_detail::Lame lame = elastic_detail::lameOf(options.youngsModulus, options.poissonRatio);
  if (Status status = checkPositive<Scalar>(options.stiffnessScale, mesh.tetCount(), "stiffnessScale", "tet",
                                            lame.mu + lame.lambda);
      !status.ok()) {
    return status;
  }
  if (Status status = checkPositive<Scalar>(options.nodeMasses, mesh.nodeCount(), "nodeMasses", "node"); !status.ok()) {
    return status;
  }
  const double volume = totalVolume(mesh);
  const double mass = options.nodeMasses.empty()
                          ? options.density * volume
                          : std::accumulate(options.nodeMasses.begin(), options.nodeMasses.end(), 0.0);
  const elastic_detail::MaterialChanges painted(mesh.tetCount(), cage.paintedDamping);
  return painted.checkStiffness<Scalar>(options.youngsModulus, options.stiffnessDamping, mass, volume);
}

Status checkMesh(const TetMesh& cage, const TetMeshReport& report) {
  if (Status status = validate(cage, report); !status.ok()) return status;
  if (const std::size_t far = firstUnusable(viewOf(cage.nodes)); far < cage.nodeCount()) {
    return {StatusCode::NonFinite,
            "node " + std::to_string(far) + " of the cage is not finite, or too far from the origin to be simulated"};
  }
  const TetMeshReport::Fault& flat = report.zeroVolume.count > 0 ? report.zeroVolume : report.repeatedNode;
  if (flat.count == 0) return {};
  return {StatusCode::Degenerate, "tet " + std::to_string(flat.first) + " of the cage is flat; remove flat tets"};
}

}  // namespace

template <class Scalar>
struct ElasticBody<Scalar>::Impl {
  /// options  completed by the cage's values
  Impl(elastic_detail::RestTets rest, const TetMesh& cage, const std::vector<double>& paintedDamping,
       const ElasticOptions& options)
      : dynamics(std::move(rest), cage.nodeCount()),
        masses(options.nodeMasses),
        volume(totalVolume(cage)),
        changes(cage.tetCount(), paintedDamping),
        tetCount(cage.tetCount()),
        youngsModulus(options.youngsModulus),
        poissonRatio(options.poissonRatio),
        damping(options.stiffnessDamping) {
    for (const Eigen::Vector3d& p : cage.nodes) {
      for (int k = 0; k < 3; ++k) positions.push_back(static_cast<Scalar>(p[k]));
    }
    velocities.assign(positions.size(), Scalar(0));
    limits.tolerance = options.tolerance;
    limits.iterations = options.maxIterations;
    dynamics.setMaterial(elastic_detail::lameOf(options.youngsModulus, options.poissonRatio));
    dynamics.setDeterministic(options.deterministic);
    if (masses.empty()) {
      masses.assign(cage.nodeCount(), 0.0);
      double total = 0.0;
      for (const Tet& tet : cage.tets) {
        const double quarter = options.density * std::abs(signedVolume(cornersOf(cage, tet))) / 4.0;
        for (const int n : tet) masses[static_cast<std::size_t>(n)] += quarter;
        total += 4.0 * quarter;
      }
      // A node without tets is a point that falls.
      for (double& m : masses) m = m > 0.0 ? m : total / static_cast<double>(masses.size());
    }
    assert(masses.size() == cage.nodeCount());
    for (std::size_t n = 0; n < masses.size(); ++n) dynamics.setMass(n, static_cast<Scalar>(masses[n]));
    applyChanges();
  }

  void read(const std::array<double, 3>& push) {
    assert(positions.size() == 3 * masses.size() && velocities.size() == positions.size());
    for (std::size_t n = 0; n < masses.size(); ++n) {
      const bool pinned = dynamics.matrix().mass(n) == Scalar(0);
      for (std::size_t k = 0; k < 3; ++k) {
        dynamics.point(n)[k] = positions[3 * n + k];
        dynamics.velocity(n)[k] = velocities[3 * n + k] + (pinned ? Scalar(0) : static_cast<Scalar>(push[k]));
      }
    }
  }
  elastic_detail::BodyProbe<Scalar> probe() const {
    elastic_detail::BodyProbe<Scalar> probe(dynamics.matrix());
    for (std::size_t n = 0; n < masses.size(); ++n) std::copy_n(&positions[3 * n], 3, probe.point(n));
    return probe;
  }
  /// True unless the application has written positions or velocities since the last step.
  bool continues() const {
    for (std::size_t n = 0; dynamics.remembers() && n < masses.size(); ++n) {
      if (!dynamics.continues(n, &positions[3 * n], &velocities[3 * n])) return false;
    }
    return true;
  }
  void write(double seconds) {
    const Scalar* solution = dynamics.matrix().solution();
    for (std::size_t n = 0; n < masses.size(); ++n) {
      const std::size_t wide = dynamics.matrix().wideOf(n);
      const bool pinned = dynamics.matrix().mass(n) == Scalar(0);
      for (std::size_t k = 0; k < 3; ++k) {
        if (!pinned) velocities[3 * n + k] = dynamics.velocity(n)[k] + solution[wide + k * kGroup];
      }
      std::copy_n(dynamics.advance(n, seconds, &velocities[3 * n]), 3, &positions[3 * n]);
    }
  }

  double mass() const { return std::accumulate(masses.begin(), masses.end(), 0.0); }

  BodyDynamics<Scalar> dynamics;
  elastic_detail::BodyPressure<Scalar> inside;
  elastic_detail::ConjugateGradient<Scalar> solve;
  elastic_detail::SolveLimits limits;
  std::vector<double> masses;  ///< by node, before any is pinned
  double volume = 0.0;         ///< of the tets at rest
  std::vector<Scalar> positions, velocities;
  elastic_detail::MaterialChanges changes;
  std::size_t tetCount;
  double youngsModulus, poissonRatio, damping;

  /// Gives the tets what was set, if it is valid.
  Status change(Status status) {
    if (status.ok()) applyChanges();
    return status;
  }
  /// Makes a change by which the body must not become too stiff.
  template <class Change>
  Status changeStiffness(Change&& make) {
    return change(changes.tryChange(make, [this](const elastic_detail::MaterialChanges& changed) {
      return changed.template checkStiffness<Scalar>(youngsModulus, damping, mass(), volume);
    }));
  }
  void applyChanges() {
    if (dynamics.tets()) changes.applyTo(dynamics, poissonRatio, youngsModulus, damping);
  }
};

namespace {

const Status kNoNodes{StatusCode::InvalidOption, "the body has no nodes"};

}  // namespace

template <class Scalar>
Result<ElasticBody<Scalar>> ElasticBody<Scalar>::create(const Cage& cage, const ElasticOptions& options) {
  Cage positive = cage;
  if (Status status = checkMesh(cage.mesh, repairTetMesh(positive.mesh)); !status.ok()) return status;
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  const ElasticOptions all = withCageDefaults(cage, options);
  if (Status status = checkOptions<Scalar>(cage, all); !status.ok()) return status;
  const Result<std::vector<QuadraticTet>> quadratic = quadraticTets(positive);
  if (!quadratic.ok()) return quadratic.status();
  ElasticBody body;
  body.impl_ = std::make_shared<Impl>(elastic_detail::restTets(positive, quadratic.value(), options.stiffnessScale),
                                      positive.mesh, cage.paintedDamping, all);
  return body;
}

template <class Scalar>
std::size_t ElasticBody<Scalar>::nodeCount() const {
  return impl_ ? impl_->masses.size() : 0;
}
template <class Scalar>
PointView<Scalar> ElasticBody<Scalar>::positions() {
  if (!impl_) return {};
  return {impl_->positions.data(), nodeCount()};
}
template <class Scalar>
PointView<Scalar> ElasticBody<Scalar>::velocities() {
  if (!impl_) return {};
  return {impl_->velocities.data(), nodeCount()};
}

template <class Scalar>
void ElasticBody<Scalar>::setPinned(std::size_t node, bool pinned) {
  if (!impl_) return;
  assert(node < nodeCount());
  impl_->dynamics.setMass(node, pinned ? Scalar(0) : static_cast<Scalar>(impl_->masses[node]));
}

template <class Scalar>
Status ElasticBody<Scalar>::setPressure(double pressure) {
  if (!impl_) return {StatusCode::Empty, "the body is empty"};
  Status status = elastic_detail::checkPressure<Scalar>(pressure, impl_->mass(), impl_->volume);
  return status.ok() ? impl_->inside.setConstant(pressure, impl_->dynamics) : status;
}

template <class Scalar>
Status ElasticBody<Scalar>::setGas(double pressure, double outside) {
  if (!impl_) return {StatusCode::Empty, "the body is empty"};
  Status status = elastic_detail::checkGas<Scalar>(pressure, outside, impl_->mass(), impl_->volume);
  return status.ok() ? impl_->inside.setGas(pressure, outside, impl_->probe(), impl_->dynamics) : status;
}

template <class Scalar>
double ElasticBody<Scalar>::pressure() {
  return impl_ ? impl_->inside.pressure(impl_->probe(), impl_->dynamics) : 0.0;
}

template <class Scalar>
double ElasticBody<Scalar>::volume() {
  return impl_ ? impl_->inside.volume(impl_->probe(), impl_->dynamics) : 0.0;
}

template <class Scalar>
int ElasticBody<Scalar>::step(double seconds, const std::array<double, 3>& acceleration, ParallelFor* threads) {
  const bool finite = std::isfinite(acceleration[0] + acceleration[1] + acceleration[2]);
  if (!impl_ || !(seconds > 0.0 && std::isfinite(seconds) && finite)) return 0;
  Impl& p = *impl_;
  elastic_detail::StepStart start;
  start.seconds = seconds;
  start.continues = p.continues();
  start.staggered = true;
  const double pushed = seconds * p.dynamics.forceShare(seconds, start.staggered);
  p.read({pushed * acceleration[0], pushed * acceleration[1], pushed * acceleration[2]});
  p.dynamics.predict(start, threads);
  p.dynamics.findResidual(threads);
  elastic_detail::SolveLimits limits = p.limits;
  // At rest, less than this is left of the weight, and steps need no iterations.
  double squared = 0.0;
  for (const double a : acceleration) squared += a * a;
  const double unseen = std::min(1e-3, 0.2 * limits.tolerance) * pushed * std::sqrt(squared);
  limits.enough = p.dynamics.squaredImpulses(std::max(unseen, p.dynamics.roundingSpeed()));
  const int iterations = p.dynamics.solve(p.solve, limits, p.limits.iterations, threads);
  p.dynamics.remember(elastic_detail::SolvedWith::ElasticityAlone, threads);
  p.dynamics.removeMomentum();
  p.dynamics.shortenStep(elastic_detail::SolvedWith::ElasticityAlone, threads);
  p.write(seconds);
  return iterations;
}

template <class Scalar>
Status ElasticBody<Scalar>::setPlasticity(const Plasticity& plasticity) {
  return impl_ ? impl_->change(impl_->changes.setPlasticity(plasticity)) : kNoNodes;
}
template <class Scalar>
Status ElasticBody<Scalar>::endPlasticity() {
  if (!impl_) return kNoNodes;
  impl_->changes.endPlasticity();
  impl_->applyChanges();
  return {};
}
template <class Scalar>
Status ElasticBody<Scalar>::resetPlasticFlow() {
  if (!impl_) return kNoNodes;
  if (impl_->dynamics.tets()) impl_->dynamics.tets()->forgetFlow();
  return {};
}
template <class Scalar>
std::vector<double> ElasticBody<Scalar>::plasticStrains() const {
  if (!impl_ || !impl_->dynamics.tets()) return {};
  return impl_->dynamics.tets()->plasticStrains(impl_->tetCount);
}
template <class Scalar>
Status ElasticBody<Scalar>::setGrowth(double length) {
  return impl_ ? impl_->change(impl_->changes.setGrowth(length)) : kNoNodes;
}
template <class Scalar>
Status ElasticBody<Scalar>::setGrowth(const std::vector<double>& lengths) {
  return impl_ ? impl_->change(impl_->changes.setGrowth(lengths)) : kNoNodes;
}
template <class Scalar>
Status ElasticBody<Scalar>::setGrowthTensors(const std::vector<std::array<double, 9>>& deformations) {
  return impl_ ? impl_->change(impl_->changes.setGrowthTensors(deformations)) : kNoNodes;
}
template <class Scalar>
Status ElasticBody<Scalar>::setStiffnessScale(const std::vector<double>& factors) {
  if (!impl_) return kNoNodes;
  return impl_->changeStiffness([&](auto& changes) { return changes.setStiffnessScale(factors); });
}
template <class Scalar>
Status ElasticBody<Scalar>::setDampingScale(const std::vector<double>& factors) {
  if (!impl_) return kNoNodes;
  return impl_->changeStiffness([&](auto& changes) { return changes.setDampingScale(factors); });
}
template <class Scalar>
Status ElasticBody<Scalar>::setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets) {
  return impl_ ? impl_->change(impl_->changes.setElasticLaw(law, tets)) : kNoNodes;
}
template <class Scalar>
Status ElasticBody<Scalar>::addFibres(const Fibres& fibres) {
  if (!impl_) return kNoNodes;
  return impl_->changeStiffness([&](auto& changes) { return changes.addFibres(fibres); });
}
template <class Scalar>
Result<int> ElasticBody<Scalar>::addMuscle(const Muscle& muscle) {
  if (!impl_) return kNoNodes;
  return impl_->changes.addMuscle(muscle);
}
template <class Scalar>
Status ElasticBody<Scalar>::setActivation(int muscle, double activation) {
  return impl_ ? impl_->change(impl_->changes.setActivation(muscle, activation)) : kNoNodes;
}

template <class Scalar>
double ElasticBody<Scalar>::activation(int muscle) const {
  return impl_ ? impl_->changes.activation(muscle) : 0.0;
}

template <class Scalar>
std::vector<std::array<double, 3>> ElasticBody<Scalar>::forces() {
  if (!impl_) return {};
  elastic_detail::BodyProbe<Scalar> probe = impl_->probe();
  impl_->dynamics.findForces(probe, nullptr);
  std::vector<std::array<double, 3>> out(nodeCount());
  for (std::size_t n = 0; n < out.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) out[n][k] = static_cast<double>(probe.force(n)[k]);
  }
  return out;
}

template <class Scalar>
double ElasticBody<Scalar>::energy() {
  if (!impl_) return 0.0;
  return impl_->dynamics.energy(impl_->probe(), nullptr);
}

TETSKIN_INSTANTIATE_CLASS(ElasticBody)

}  // namespace tetskin
