// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_law.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>

namespace tetskin {
namespace {

Status badLaw(std::string message) {
  return {StatusCode::InvalidOption, std::move(message)};
}

/// See `largestDistortion`.
constexpr double kMostDistortion = 60.0;

/// The factor by which Yeoh's law is stiffer than the neo-Hookean one.
double yeohFactor(double c2, double c3, double k) {
  return 1.0 + 2.0 * c2 * k + 3.0 * c3 * k * k;
}

double leastFactor(double c2, double c3) {
  const double end = kMostDistortion, turn = c3 > 0.0 ? std::clamp(-c2 / (3.0 * c3), 0.0, end) : 0.0;
  return std::min({1.0, yeohFactor(c2, c3, end), yeohFactor(c2, c3, turn)});
}

/// Of an incompressible sample: I - 3, and the derivative of I / 2 by the stretch.
std::array<double, 2> distortionOf(Loading loading, double s) {
  switch (loading) {
    case Loading::Equibiaxial:
      return {2.0 * s * s + 1.0 / (s * s * s * s) - 3.0, s - 1.0 / (s * s * s * s * s)};
    case Loading::Planar:
      return {s * s + 1.0 / (s * s) - 2.0, s - 1.0 / (s * s * s)};
    default:
      return {s * s + 2.0 / s - 3.0, s - 1.0 / (s * s)};
  }
}

/// Of a linear law, over Young's modulus times the strain.
double linearFactor(Loading loading) {
  return loading == Loading::Equibiaxial ? 2.0 : loading == Loading::Planar ? 4.0 / 3.0 : 1.0;
}

/// What the three terms of Yeoh's law, or the only one of another, give for a modulus of 1.
/// most  bound of K
std::array<double, 3> termsOf(ElasticLaw::Kind kind, const StressPoint& point, double most) {
  if (kind == ElasticLaw::Kind::Corotated) return {linearFactor(point.loading) * (point.stretch - 1.0), 0.0, 0.0};
  const auto [k, slope] = distortionOf(point.loading, point.stretch);
  const double bounded = std::min(k, most);
  return {slope / 3.0, slope / 3.0 * 2.0 * bounded, slope * bounded * bounded};
}

/// The least squares of these terms, if they are a law.
std::optional<FittedLaw> fitOf(ElasticLaw::Kind kind, const std::vector<StressPoint>& points,
                               const std::vector<int>& terms) {
  Eigen::MatrixXd rows(points.size(), terms.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::array<double, 3> all = termsOf(kind, points[p], kMostDistortion);
    for (std::size_t k = 0; k < terms.size(); ++k) {
      rows(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k)) =
          all[static_cast<std::size_t>(terms[k])] / points[p].stress;
    }
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(points.size()));
  const Eigen::VectorXd found = rows.colPivHouseholderQr().solve(ones);
  std::array<double, 3> moduli{};
  for (std::size_t k = 0; k < terms.size(); ++k)
    moduli[static_cast<std::size_t>(terms[k])] = found[static_cast<Eigen::Index>(k)];
  if (!found.allFinite() || !(moduli[0] > 0.0)) return {};
  FittedLaw fit;
  fit.law = {kind, moduli[1] / moduli[0], moduli[2] / moduli[0]};
  fit.youngsModulus = moduli[0];
  if (!checkElasticLaw(fit.law).ok()) return {};
  double squares = 0.0;
  for (const auto& [stretch, stress, loading] : points) {
    const double relative = moduli[0] * nominalStress(fit.law, loading, stretch) / stress - 1.0;
    squares += relative * relative;
  }
  fit.error = std::sqrt(squares / static_cast<double>(points.size()));
  return fit;
}

}  // namespace

Status checkElasticLaw(const ElasticLaw& law) {
  constexpr double kLeast = 0.05;  // of the factor
  if (!(std::isfinite(law.c2) && std::isfinite(law.c3))) return badLaw("the coefficients of a law must be finite");
  if (law.kind != ElasticLaw::Kind::Yeoh) {
    const bool none = law.c2 == 0.0 && law.c3 == 0.0;
    return none ? Status() : badLaw("only Yeoh's law has the coefficients c2 and c3");
  }
  if (!(leastFactor(law.c2, law.c3) >= kLeast)) {
    return badLaw(
        "Yeoh's law: 1 + 2 c2 K + 3 c3 K^2 must be at least 0.05 for all K from 0 to 60: a material that is "
        "pulled would give way");
  }
  return {};
}

/// The least K at which the factor is kStiffest.
double largestDistortion(const ElasticLaw& law) {
  constexpr double kStiffest = 100.0;
  if (law.kind != ElasticLaw::Kind::Yeoh) return kMostDistortion;
  // (kStiffest - 1) / K = c2 + sqrt(c2^2 + 3 c3 (kStiffest - 1))
  const double inside = law.c2 * law.c2 + 3.0 * law.c3 * (kStiffest - 1.0);
  const double slope = inside >= 0.0 ? law.c2 + std::sqrt(inside) : 0.0;
  return slope > 0.0 ? std::min((kStiffest - 1.0) / slope, kMostDistortion) : kMostDistortion;
}

double nominalStress(const ElasticLaw& law, Loading loading, double stretch) {
  assert(stretch > 0.0);
  const std::array<double, 3> terms = termsOf(law.kind, {stretch, 0.0, loading}, largestDistortion(law));
  return terms[0] + law.c2 * terms[1] + law.c3 * terms[2];
}

Result<FittedLaw> fitElasticLaw(ElasticLaw::Kind kind, const std::vector<StressPoint>& points) {
  const bool isYeoh = kind == ElasticLaw::Kind::Yeoh;
  if (points.size() < (isYeoh ? 3U : 1U))
    return badLaw(isYeoh ? "a fit of Yeoh's law needs at least three points" : "a fit needs a point");
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& [stretch, stress, loading] = points[p];
    if (stretch > 0.0 && std::isfinite(stretch) && std::isfinite(stress) && stress * (stretch - 1.0) > 0.0) continue;
    return badLaw("point " + std::to_string(p) +
                  " of the curve must have a stretch above 0 other than 1, and a stress " +
                  "above 0 where it is pulled, below 0 where it is pressed");
  }
  std::optional<FittedLaw> best;
  const std::vector<std::vector<int>> choices =
      isYeoh ? std::vector<std::vector<int>>{{0, 1, 2}, {0, 1}, {0, 2}, {0}} : std::vector<std::vector<int>>{{0}};
  for (const std::vector<int>& terms : choices) {
    const std::optional<FittedLaw> fit = fitOf(kind, points, terms);
    if (fit && (!best || fit->error < best->error)) best = fit;
  }
  if (!best) return badLaw("no law of this kind meets these points");
  return *best;
}

}  // namespace tetskin
