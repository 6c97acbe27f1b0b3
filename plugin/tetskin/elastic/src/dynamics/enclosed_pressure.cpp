// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/enclosed_pressure.h>

#include <cassert>
#include <cmath>
#include <utility>

namespace tetskin::elastic_detail {
namespace {

/// Tension in the material of a body under pressure p in a volume V is p V over the material's, on the average of all
/// directions, and up to half as much again along thin walls. It resists bending of thin walls more than the material
/// does; without it in the matrix, those of light balloons would flutter. In the matrix it resists rotations of the
/// whole body, too, which the pressure in fact undoes: see BodyDynamics::isStretched.
constexpr double kTension = 2.0;

template <class S>
void add(double by, S& to) {
  to = static_cast<S>(static_cast<double>(to) + by);
}

}  // namespace

template <class S>
void EnclosedPressure<S>::set(const PressureLaw& law, std::shared_ptr<PressureSurface> surface,
                              BlockMatrix<S>& matrix) {
  law_ = law;
  if (surface != surface_) {
    slots_.clear();
    matrix.setOuter({}, {});
    if (surface) {
      for (const std::uint32_t n : surface->nodes()) slots_.push_back(static_cast<std::uint32_t>(matrix.slotOf(n)));
    }
  }
  surface_ = std::move(surface);
}

template <class S>
double EnclosedPressure<S>::volumeAt(const AlignedVector<S>& points, PressureSurface& surface,
                                     const BlockMatrix<S>& matrix, const NodePlaces<S>& places) {
  double* to = surface.positions();
  for (const std::uint32_t n : surface.nodes()) {
    const std::size_t slot = matrix.slotOf(n);
    const S* x = &points[4 * slot];
    const bool own = places.isAt(slot, x, S(0));
    for (std::size_t k = 0; k < 3; ++k) *to++ = own ? places.at(slot)[k] : static_cast<double>(x[k]);
  }
  return surface.evaluate(true, nullptr);
}

template <class S>
double EnclosedPressure<S>::energyAt(const AlignedVector<S>& points, const BlockMatrix<S>& matrix,
                                     const NodePlaces<S>& places) const {
  return surface_ ? law_.energy(volumeAt(points, *surface_, matrix, places)) : 0.0;
}

template <class S>
void EnclosedPressure<S>::addForcesAt(const AlignedVector<S>& points, const BlockMatrix<S>& matrix,
                                      const NodePlaces<S>& places, AlignedVector<S>& forces) const {
  if (!surface_) return;
  const double pressure = law_.at(volumeAt(points, *surface_, matrix, places));
  const double* by = surface_->derivative();
  for (const std::uint32_t slot : slots_) {
    for (std::size_t k = 0; k < 3; ++k) add(pressure * *by++, forces[4 * slot + k]);
  }
}

template <class S>
void EnclosedPressure<S>::addForces(const AlignedVector<S>& moved, double shearModulus, double materialVolume,
                                    const BlockMatrix<S>& matrix, const NodePlaces<S>& places, AlignedVector<S>& forces,
                                    ParallelFor* threads) {
  gasStiffness_.clear();
  gasFrequency_ = 0.0;
  stretch_ = 1.0;
  if (!surface_) return;
  assert(shearModulus > 0.0 && materialVolume > 0.0);
  double* to = surface_->positions();
  for (const std::uint32_t slot : slots_) {
    places.fromDisplacement(slot, &moved[4 * slot], to);
    to += 3;
  }
  const double volume = surface_->evaluate(true, threads), pressure = law_.at(volume);
  const double slope = law_.slope(volume), root = std::sqrt(slope);
  const double tension = kTension * std::abs(pressure * volume) / materialVolume;
  if (pressure > 0.0 && surface_->isHollow()) stretch_ += tension / shearModulus;
  const double* by = surface_->derivative();
  for (const std::uint32_t slot : slots_) {
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = *by++;
      add(pressure * d, forces[4 * slot + k]);
      squared += d * d;
      if (slope > 0.0) gasStiffness_.push_back(root * d);
    }
    const auto mass = static_cast<double>(matrix.massAt(slot));
    if (mass > 0.0) gasFrequency_ += slope * squared / mass;
  }
}

template <class S>
void EnclosedPressure<S>::stiffen(BlockMatrix<S>& matrix, double alpha) const {
  if (gasStiffness_.empty()) return matrix.setOuter({}, {});
  std::vector<double> u = gasStiffness_;
  const double root = std::sqrt(alpha);
  for (double& value : u) value *= root;
  matrix.setOuter(slots_, u);
}

TETSKIN_INSTANTIATE_CLASS(EnclosedPressure)

}  // namespace tetskin::elastic_detail
