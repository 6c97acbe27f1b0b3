// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Lewis Fry Richardson, "The Deferred Approach to the Limit", Phil. Trans. A 226, 1927 (the extrapolation)
#include <tetskin/elastic/src/calibration/stiffness_fit.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// A response below this share of its limit is one that the refinements cannot represent.
constexpr double kMinResponse = 0.1;
/// Linear tets have order two: each refinement halves the size and leaves a quarter of the error.
constexpr double kErrorLeft = 0.25;
/// How often energies are spread to the tets around a tet's nodes: those of single tets are too uneven.
constexpr int kSpreadings = 2;
/// Largest ratio of a region's factor to that of the whole body: a part that moves freely and holds hardly anything
/// could get any factor.
constexpr double kMaxDifference = 1.4;
/// Factors by region must reduce the error for loads that they have not seen to this share of that of one factor.
constexpr double kBetter = 0.9;
/// Approximate fractions of a calibration's time at which its solves for the two kinds of loads end.
constexpr double kModesDone = 0.6, kSagsDone = 0.9;

/// A body's axes of inertia: the longest is the last.
struct Axes {
  Eigen::Vector3d centre, variances;  ///< of the mass along the axes
  Eigen::Matrix3d directions;         ///< by column

  Axes(const std::vector<Eigen::Vector3d>& nodes, const Eigen::VectorXd& masses);
  Eigen::Vector3d along(const Eigen::Vector3d& node) const { return directions.transpose() * (node - centre); }
};

Axes::Axes(const std::vector<Eigen::Vector3d>& nodes, const Eigen::VectorXd& masses) : centre(0, 0, 0) {
  assert(masses.size() == static_cast<Eigen::Index>(3 * nodes.size()));
  const auto massOf = [&](std::size_t n) { return masses[static_cast<Eigen::Index>(3 * n)]; };
  double mass = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    centre += massOf(n) * nodes[n];
    mass += massOf(n);
  }
  centre /= mass;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    covariance += massOf(n) / mass * (nodes[n] - centre) * (nodes[n] - centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(covariance);
  variances = principal.eigenvalues();
  directions = principal.eigenvectors();
}

/// Accelerations from acceleration(position along the axes, axes, column).
template <class Acceleration>
Fields accelerationsAlong(const RefinedBodies& bodies, Eigen::Index columns, Acceleration&& acceleration) {
  const std::vector<Eigen::Vector3d>& nodes = bodies.cage().mesh.nodes;
  const Axes axes(nodes, bodies.masses(0));
  Fields accelerations(bodies.masses(0).size(), columns);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Eigen::Vector3d along = axes.along(nodes[n]);
    for (Eigen::Index k = 0; k < columns; ++k) {
      accelerations.block<3, 1>(static_cast<Eigen::Index>(3 * n), k) = acceleration(along, axes, k);
    }
  }
  return accelerations;
}

/// Gravity in the directions of a body's axes, proportional to the square of the position along the two longest of
/// them.
Eigen::Vector3d sagAcceleration(const Eigen::Vector3d& along, const Axes& axes, Eigen::Index k) {
  const double square = along[2 - k / 3] * along[2 - k / 3] / axes.variances[2];
  return square * axes.directions.col(k % 3);
}

/// Away from the middle, along one axis in each column, proportional to the position on it.
Eigen::Vector3d stretchAcceleration(const Eigen::Vector3d& along, const Axes& axes, Eigen::Index k) {
  return along[k] * axes.directions.col(k);
}

/// Share of the mass that takes part in a vibration: 1 if all of it moves alike, 1/N if one node of N moves.
double participation(const Eigen::VectorXd& mode, const Eigen::VectorXd& masses) {
  assert(mode.size() == masses.size() && mode.size() % 3 == 0);
  double second = 0.0, fourth = 0.0, mass = 0.0;
  for (Eigen::Index n = 0; n < mode.size(); n += 3) {
    const double squared = mode.segment<3>(n).squaredNorm();
    second += masses[n] * squared;
    fourth += masses[n] * squared * squared;
    mass += masses[n];
  }
  return second * second / (mass * fourth);
}

/// The value in the limit, from the last two levels.
template <class Value>
Value limitOf(const Value& before, const Value& last) {
  return last + kErrorLeft / (1.0 - kErrorLeft) * (last - before);
}

/// Solves for the same loads on all levels.
LoadSet applied(const RefinedBodies& bodies, const Fields& accelerations) {
  const std::size_t last = bodies.levelCount() - 1;
  assert(last >= 1);
  LoadSet set;
  set.accelerations = accelerations;
  Fields finest = accelerations;
  for (std::size_t level = 0; level < last; ++level) finest = bodies.refined(level, finest);
  std::vector<Fields> loads(last + 1);
  loads[last] = bodies.masses(last).asDiagonal() * finest;
  bodies.balance(last, loads[last]);
  set.reach = products(loads[last], finest);
  for (std::size_t level = last; level > 0; --level) loads[level - 1] = bodies.coarsened(level, loads[level]);
  set.loads = loads[0];
  Fields displacements;
  std::vector<Eigen::MatrixXd> energies;
  for (std::size_t level = 0; level <= last; ++level) {
    Progress::goOnWithRound();
    displacements = level == 0 ? bodies.direct().solve(loads[0])
                               : bodies.solve(level, loads[level], bodies.refined(level - 1, displacements));
    set.works.push_back(products(loads[level], displacements));
    if (last == 2) energies.push_back(bodies.energies(level, displacements));
  }
  set.limits = last == 2 ? limitOf(set.works[1], set.works[2]) : set.works[1];
  // The error of what hardly moves does not matter.
  set.weights = set.limits.cwiseQuotient(set.reach);
  // If parts rotate freely about a node or an edge, only rounding determines their responses and signs.
  for (Eigen::Index k = 0; k < set.limits.size(); ++k) {
    if (!(set.limits[k] > 0.0 && set.works[0][k] > kMinResponse * kMinResponse * set.limits[k])) set.weights[k] = 0.0;
  }
  if (energies.empty()) return set;
  const Eigen::VectorXd shares = (set.weights.array() > 0.0).select(set.limits.cwiseInverse(), 0.0).transpose();
  set.energies = energies[0] * shares;
  set.limitEnergies = limitOf(energies[1], energies[2]).cwiseMax(kMinResponse * energies[2]) * shares;
  return set;
}

/// The weighted geometric mean; 1 if nothing has a weight.
double geometricMean(const Eigen::RowVectorXd& values, const Eigen::RowVectorXd& weights) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (weights[k] > 0.0) sum += weights[k] * std::log(values[k]);
  }
  return weights.sum() > 0.0 ? std::exp(sum / weights.sum()) : 1.0;
}

double rootMeanSquare(const Eigen::RowVectorXd& values, const Eigen::RowVectorXd& weights) {
  if (!(weights.sum() > 0.0)) return 0.0;
  return std::sqrt((weights.array() > 0.0).select(weights.array() * values.array().square(), 0.0).sum() /
                   weights.sum());
}

/// Spreads each tet's value evenly to the tets around its nodes, several times.
Eigen::VectorXd spread(const TetMesh& mesh, Eigen::VectorXd values) {
  std::vector<double> count(mesh.nodeCount(), 0.0);
  for (const Tet& tet : mesh.tets) {
    for (const int n : tet) ++count[n];
  }
  for (int k = 0; k < kSpreadings; ++k) {
    std::vector<double> ofNode(mesh.nodeCount(), 0.0);
    for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
      for (const int n : mesh.tets[t]) ofNode[n] += 0.25 * values[static_cast<Eigen::Index>(t)] / count[n];
    }
    values.setZero();
    for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
      for (const int n : mesh.tets[t]) values[static_cast<Eigen::Index>(t)] += ofNode[n];
    }
  }
  return values;
}

/// Averages the values over the eight tets of each quadratic one.
Eigen::VectorXd shared(const Cage& cage, Eigen::VectorXd values) {
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage);
  assert(tets.ok());
  for (const QuadraticTet& tet : tets.value()) {
    double sum = 0.0;
    for (const int t : tet.tets) sum += values[t];
    for (const int t : tet.tets) values[t] = sum / static_cast<double>(kSubTets);
  }
  return values;
}

/// Which tets are quadratic and full; empty: none.
std::vector<bool> exactTets(const Cage& cage) {
  std::vector<bool> exact;
  for (std::size_t t = 0; t < cage.quadraticTet.size(); ++t) {
    const bool isFull = cage.volumeFraction.empty() || cage.volumeFraction[t] == 1.0;
    exact.push_back(cage.quadraticTet[t] >= 0 && isFull);
  }
  return std::find(exact.begin(), exact.end(), true) == exact.end() ? std::vector<bool>() : exact;
}

Cage withFactors(Cage cage, const std::vector<double>& factors) {
  cage.stiffnessFactor = factors;
  return cage;
}

/// The cage with other stiffness factors.
struct CageWith {
  RestBody body;
  DirectSolver solver;

  CageWith(const RefinedBodies& bodies, const std::vector<double>& factors)
      : body(withFactors(bodies.cage(), factors), bodies.poissonRatio(), {}, bodies.masses(0)), solver(body) {}
  /// Loads times their displacements.
  Eigen::RowVectorXd works(const Fields& loads) const { return products(loads, solver.solve(loads)); }
};

/// Passes to find one factor for only some of the tets.
constexpr int kFactorPasses = 4;

}  // namespace

StiffnessFit::StiffnessFit(const RefinedBodies& bodies, int modeCount, Progress& progress)
    : bodies_(bodies), exact_(exactTets(bodies.cage())) {
  const Eigen::VectorXd& masses = bodies.masses(0);
  modes_ = applied(bodies, softestModes(bodies.coarsest(), bodies.direct(), modeCount));
  for (Eigen::Index k = 0; k < modes_.weights.size(); ++k) {
    const bool lacks = !(modes_.ratios(0)[k] > kMinResponse);
    modes_.weights[k] *= lacks ? 0.0 : participation(modes_.accelerations.col(k), masses);
  }
  if (!progress.reach(kModesDone)) return;
  sags_ = applied(bodies, accelerationsAlong(bodies, 6, sagAcceleration));

  if (!progress.reach(kSagsDone)) return;
  fitOneFactor();
  byRegion_ = regionsPredict();
  if (byRegion_) {
    factors_ = regional(modes_.energies + sags_.energies, modes_.limitEnergies + sags_.limitEnergies);
    factors_ = scaled(factors_, meanOf(ratiosWith(factors_)));
  }
  const Ratios ratios = ratiosWith(factors_);
  modeError_ = rootMeanSquare(ratios.modes.array() - 1.0, modes_.weights);
  sagError_ = rootMeanSquare(ratios.sags.array() - 1.0, sags_.weights);
  measureStretch();
}

std::vector<double> StiffnessFit::scaled(std::vector<double> values, double factor) const {
  for (std::size_t t = 0; t < values.size(); ++t) {
    values[t] = !exact_.empty() && exact_[t] ? 1.0 : std::min(values[t] * factor, 1.0);
  }
  return values;
}

/// If all tets have the factor, displacements are inverse to it; if only some have it, several passes are needed.
void StiffnessFit::fitOneFactor() {
  const std::vector<double> ones(bodies_.cage().mesh.tetCount(), 1.0);
  factors_ = ones;
  for (int pass = 0; pass < (exact_.empty() ? 1 : kFactorPasses); ++pass) {
    factor_ = std::min(factor_ * meanOf(ratiosWith(factors_)), 1.0);
    factors_ = scaled(ones, factor_);
  }
}

void StiffnessFit::measureStretch() {
  const Fields accelerations = accelerationsAlong(bodies_, 3, stretchAcceleration);
  const Fields finer = bodies_.refined(0, accelerations);
  Fields fineLoads = bodies_.masses(1).asDiagonal() * finer;
  bodies_.balance(1, fineLoads);
  const Fields loads = bodies_.coarsened(1, fineLoads), plain = bodies_.direct().solve(loads);
  const Eigen::RowVectorXd works = products(loads, plain);
  const Eigen::RowVectorXd finest = products(fineLoads, bodies_.solve(1, fineLoads, bodies_.refined(0, plain)));
  const Eigen::RowVectorXd limit = bodies_.levelCount() > 2 ? limitOf(works, finest) : finest;
  const Eigen::RowVectorXd weights = limit.cwiseQuotient(products(fineLoads, finer)).cwiseMax(0.0);
  const auto errorOf = [&](const Eigen::RowVectorXd& found) {
    return geometricMean(found.cwiseQuotient(limit), weights) - 1.0;
  };
  plainStretchError_ = errorOf(works);
  stretchError_ = errorOf(CageWith(bodies_, factors_).works(loads));
}

/// Factors by region, near the factor of the whole body.
std::vector<double> StiffnessFit::regional(const Eigen::VectorXd& energies,
                                           const Eigen::VectorXd& limitEnergies) const {
  const Cage& cage = bodies_.cage();
  const Eigen::VectorXd found = shared(cage, spread(cage.mesh, energies));
  const Eigen::VectorXd limit = shared(cage, spread(cage.mesh, limitEnergies));
  std::vector<double> factors(cage.mesh.tetCount(), factor_);
  for (std::size_t t = 0; t < factors.size(); ++t) {
    const auto k = static_cast<Eigen::Index>(t);
    if (!(found[k] > 0.0 && limit[k] > 0.0)) continue;
    factors[t] = std::clamp(found[k] / limit[k], factor_ / kMaxDifference, std::min(factor_ * kMaxDifference, 1.0));
  }
  return factors;
}

/// Factors found from one kind of loads are judged by the other kind.
bool StiffnessFit::regionsPredict() const {
  if (modes_.energies.size() == 0 || !(modes_.weights.sum() > 0.0 && sags_.weights.sum() > 0.0)) return false;
  const double alike = std::hypot(spreadWith({}, sags_), spreadWith({}, modes_));
  const double regions = std::hypot(spreadWith(regional(modes_.energies, modes_.limitEnergies), sags_),
                                    spreadWith(regional(sags_.energies, sags_.limitEnergies), modes_));
  return regions < kBetter * alike;
}

/// How unevenly the works under different loads deviate from their limits: an error that no common factor corrects.
/// factors  by tet; empty: one factor
double StiffnessFit::spreadWith(const std::vector<double>& factors, const LoadSet& loads) const {
  Eigen::RowVectorXd ratios = loads.ratios(0);
  if (!factors.empty()) {
    Progress::goOnWithRound();
    const CageWith cage(bodies_, factors);
    if (!cage.solver.ok()) return HUGE_VAL;
    ratios = cage.works(loads.loads).cwiseQuotient(loads.limits);
  }
  return rootMeanSquare(ratios.array() / geometricMean(ratios, loads.weights) - 1.0, loads.weights);
}

StiffnessFit::Ratios StiffnessFit::ratiosWith(const std::vector<double>& factors) const {
  Progress::goOnWithRound();
  const CageWith cage(bodies_, factors);
  Fields own = bodies_.masses(0).asDiagonal() * modes_.accelerations;
  bodies_.balance(0, own);
  const Eigen::RowVectorXd response = cage.works(own).cwiseQuotient(products(own, modes_.accelerations));
  return {response.cwiseQuotient(modes_.limits.cwiseQuotient(modes_.reach)),
          cage.works(sags_.loads).cwiseQuotient(sags_.limits)};
}

/// Vibrations and sags count equally.
double StiffnessFit::meanOf(const Ratios& ratios) const {
  return std::sqrt(geometricMean(ratios.modes, modes_.weights) * geometricMean(ratios.sags, sags_.weights));
}

int StiffnessFit::skippedModes() const {
  return static_cast<int>((modes_.weights.array() == 0.0).count());
}

std::vector<double> StiffnessFit::responses() const {
  std::vector<double> responses;
  for (std::size_t level = 0; level < bodies_.levelCount(); ++level) {
    responses.push_back(std::sqrt(geometricMean(modes_.ratios(level), modes_.weights) *
                                  geometricMean(sags_.ratios(level), sags_.weights)));
  }
  return responses;
}

}  // namespace tetskin::elastic_detail
