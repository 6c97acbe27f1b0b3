// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The pressure inside a closed surface as a function of its volume V: constant, or that of a gas at constant
// temperature. Its work -U(V) is bounded and its slope -dp/dV never below 0, so that an implicit step takes it with any
// stiffness.
#pragma once

#include <tetskin/core/src/base/arithmetic/logarithms.h>
#include <tetskin/core/src/base/state/state_stream.h>

#include <cmath>
#include <cstdint>

namespace tetskin::elastic_detail {

struct PressureLaw {
  enum class Kind : std::uint8_t { None, Constant, Gas };

  Kind kind = Kind::None;
  double pressure = 0.0;   ///< beside that outside: the constant one, or that of the gas at the volume `reference`
  double outside = 0.0;    ///< of the gas: the absolute pressure outside
  double reference = 1.0;  ///< volume, above 0: of the gas when it was set; of the surface at rest, before any growth

  bool operator==(const PressureLaw& other) const {
    return kind == other.kind && pressure == other.pressure && outside == other.outside && reference == other.reference;
  }
  bool operator!=(const PressureLaw& other) const { return !(*this == other); }

  /// Shares of `reference`. A constant pressure acts in full up to the first, and ends at the second: a body that it
  /// bursts would grow until its numbers overflow. A negative one ends at 0, and is whole from kDrawn on: it would turn
  /// the body inside out. A gas becomes stiffer down to kLeast, from where on its pressure grows in proportion to
  /// the volume that is lost: it stays finite in a body that is crushed flat or inside out.
  static constexpr double kFull = 64.0, kBurst = 125.0, kDrawn = 0.1, kLeast = 0.02;

  double at(double volume) const {
    const double v = volume / reference;
    if (kind == Kind::None) return 0.0;
    if (kind == Kind::Constant) return pressure * share(v);
    const double inside = pressure + outside;
    return (v > kLeast ? inside / v : inside / kLeast * (2.0 - v / kLeast)) - outside;
  }
  /// -dp/dV, 0 or more.
  double slope(double volume) const {
    const double v = volume / reference;
    if (kind == Kind::Constant) {
      if (pressure > 0.0) return v > kFull && v < kBurst ? pressure / ((kBurst - kFull) * reference) : 0.0;
      return v > 0.0 && v < kDrawn ? -pressure / (kDrawn * reference) : 0.0;
    }
    if (kind == Kind::None) return 0.0;
    const double inside = pressure + outside, at = v > kLeast ? v : kLeast;
    return inside / (at * at * reference);
  }
  /// The potential energy: minus the work done since the volume was `reference`.
  double energy(double volume) const {
    const double v = volume / reference;
    if (kind == Kind::None) return 0.0;
    if (kind == Kind::Constant) return -pressure * reference * sharedVolume(v);
    const double inside = pressure + outside;
    double work = outside * (1.0 - v);
    if (v > kLeast) {
      work += inside * portableLog(v);
    } else {
      const double lost = kLeast - v;
      work += inside * (portableLog(kLeast) - lost / kLeast * (1.0 + 0.5 * lost / kLeast));
    }
    return -work * reference;
  }

  void serialize(StateStream& stream) {
    stream(kind);
    if (kind > Kind::Gas) stream.fail(), kind = Kind::None;
    if (kind == Kind::None) return;
    stream(pressure, outside, reference);
    const bool finite = std::isfinite(pressure) && std::isfinite(outside) && std::isfinite(reference);
    if (!(finite && outside >= 0.0 && reference > 0.0)) stream.fail(), *this = {};
  }

 private:
  /// Of the constant pressure, at a share of the volume.
  double share(double v) const {
    if (pressure > 0.0) {
      const double size = std::abs(v);
      return size < kFull ? 1.0 : size < kBurst ? (kBurst - size) / (kBurst - kFull) : 0.0;
    }
    return v > kDrawn ? 1.0 : v > 0.0 ? v / kDrawn : 0.0;
  }
  /// The integral of `share` from 1 on.
  double sharedVolume(double v) const {
    if (pressure > 0.0) {
      const double size = std::abs(v);
      if (size < kFull) return v - 1.0;
      const double left = (size < kBurst ? kBurst - size : 0.0), width = kBurst - kFull;
      return std::copysign(kFull + 0.5 * (width - left * left / width), v) - 1.0;
    }
    if (v > kDrawn) return v - 1.0;
    return kDrawn - 1.0 - 0.5 * (kDrawn - (v > 0.0 ? v * v / kDrawn : 0.0));
  }
};

}  // namespace tetskin::elastic_detail
