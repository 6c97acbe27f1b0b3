// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The pressure in a body, as the application sets it.
#pragma once

#include <tetskin/elastic/src/exported/body_dynamics.h>
#include <tetskin/elastic/src/tets/material.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>

namespace tetskin::elastic_detail {

/// Ok, or says what is wrong. Neighbouring nodes feel the pressure as they do stress, so its bound is that of Young's
/// modulus.
/// mass, volume  of the body's material
template <class Scalar>
Status checkPressure(double pressure, double mass, double volume) {
  if (!std::isfinite(pressure)) return {StatusCode::NonFinite, "the pressure is not finite"};
  const double size = cubeRoot(volume), maximum = kMaxStiffness<Scalar> * mass / volume * size * size;
  if (!(mass > 0.0 && volume > 0.0) || std::abs(pressure) <= maximum) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "a pressure of %.3g is too large for a mass of %.3g in a volume of %.3g: at most %.3g", pressure, mass,
                volume, maximum);
  return {StatusCode::InvalidOption, text};
}

/// The same for a gas. Each number has the bound: that of their sum would let huge ones of opposite signs pass.
template <class Scalar>
Status checkGas(double pressure, double outside, double mass, double volume) {
  for (const double p : {pressure, outside, pressure + outside}) {
    if (Status status = checkPressure<Scalar>(p, mass, volume); !status.ok()) return status;
  }
  return {};
}

template <class Scalar>
class BodyPressure {
 public:
  const PressureLaw& law() const { return law_; }
  bool acts() const { return law_.kind != PressureLaw::Kind::None; }

  /// pressure  checked; 0 ends it
  Status setConstant(double pressure, BodyDynamics<Scalar>& of) {
    if (pressure == 0.0) return end(of);
    if (Status status = findSurface(of); !status.ok()) return status;
    law_ = {PressureLaw::Kind::Constant, pressure, 0.0, surface_->restVolume()};
    of.setPressure(law_, surface_);
    return {};
  }
  /// pressure, outside  checked;  now  the nodes' positions
  Status setGas(double pressure, double outside, const BodyProbe<Scalar>& now, BodyDynamics<Scalar>& of) {
    if (!(outside >= 0.0 && std::isfinite(outside))) {
      return {StatusCode::InvalidOption, "the pressure outside must be finite and at least 0"};
    }
    if (pressure == 0.0 && outside == 0.0) return end(of);
    if (!(pressure + outside > 0.0)) {
      return {StatusCode::InvalidOption,
              "a gas presses outwards: its pressure plus that outside must be above 0; see setPressure for suction"};
    }
    if (Status status = findSurface(of); !status.ok()) return status;
    const double volume = of.volumeIn(*surface_, now);
    if (!(volume > kLeastVolume * surface_->restVolume())) {
      return {StatusCode::InvalidOption, "the body is crushed: there is no volume for the gas"};
    }
    law_ = {PressureLaw::Kind::Gas, pressure, outside, volume};
    of.setPressure(law_, surface_);
    return {};
  }
  /// The pressure is to act on this surface from now on; null: on the boundary of the tets. One that was prepared is
  /// forgotten. A gas keeps its present pressure, and the bounds of a constant one become those of the new surface.
  /// now  the nodes' positions
  Status setSurface(std::shared_ptr<PressureSurface> surface, const BodyProbe<Scalar>& now, BodyDynamics<Scalar>& of) {
    std::shared_ptr<PressureSurface> before = std::exchange(surface_, std::move(surface));
    const bool given = std::exchange(given_, surface_ != nullptr);
    auto make = std::exchange(make_, nullptr);
    fault_ = {};
    if (given_) findRest(of);
    if (!acts()) return {};
    if (Status status = findSurface(of); !status.ok()) {
      surface_ = std::move(before);
      given_ = given;
      make_ = std::move(make);
      return status;
    }
    law_.reference = referenceAfter(*before, now, of);
    of.setPressure(law_, surface_);
    return {};
  }
  /// Prepares a surface that is made when it is needed; where that fails, pressure acts on the boundary of the tets.
  void offerSurface(std::function<Result<PressureSurface>()> make) {
    if (given_ || acts()) return;
    surface_.reset();
    fault_ = {};
    make_ = std::move(make);
  }
  /// The volume of the surface, and the pressure in it; 0 without a surface.
  double volume(const BodyProbe<Scalar>& now, BodyDynamics<Scalar>& of) {
    return findSurface(of).ok() ? of.volumeIn(*surface_, now) : 0.0;
  }
  double pressure(const BodyProbe<Scalar>& now, BodyDynamics<Scalar>& of) {
    return acts() ? law_.at(volume(now, of)) : 0.0;
  }

  /// Sets what has been read: the surface is the body's.
  Status restore(const PressureLaw& law, BodyDynamics<Scalar>& of) {
    if (law.kind == PressureLaw::Kind::None) return end(of);
    if (Status status = findSurface(of); !status.ok()) return status;
    law_ = law;
    of.setPressure(law_, surface_);
    return {};
  }
  /// The body has new dynamics, and may have been scaled: the amount of a gas stays. With other tets, surfaces that
  /// were set or prepared are forgotten; where those of now have no boundary that serves, pressure ends.
  void moveTo(BodyDynamics<Scalar>& of, bool sameTets) {
    given_ = given_ && sameTets && surface_->nodes().back() < of.nodeCount();
    if (!given_) surface_.reset();
    if (!sameTets || nodes_ != of.nodeCount()) make_ = nullptr;
    nodes_ = of.nodeCount();
    fault_ = {};
    if (given_) findRest(of);
    if (!acts()) return;
    if (!findSurface(of).ok()) return (void)end(of);
    if (law_.kind == PressureLaw::Kind::Constant) law_.reference = surface_->restVolume();
    of.setPressure(law_, surface_);
  }
  /// Number of faces of the surface that `setSurface` has set; 0: none.
  std::size_t givenFaces() const { return given_ ? surface_->faceCount() : 0; }

 private:
  /// Share of the volume at rest below which a gas cannot be set.
  static constexpr double kLeastVolume = 1e-3;
  std::size_t nodes_ = 0;  ///< of the last dynamics

  Status end(BodyDynamics<Scalar>& of) {
    law_ = {};
    of.setPressure(law_, nullptr);
    return {};
  }
  Status findSurface(BodyDynamics<Scalar>& of) {
    if (surface_) return {};
    if (!fault_.ok()) return fault_;
    if (!of.tets()) return {StatusCode::InvalidOption, "pressure needs a body of elastic tets"};
    Result<PressureSurface> made = make_ ? make_() : Status{StatusCode::Empty, ""};
    if (!made.ok()) made = PressureSurface::ofTets(of.tets()->rest());
    if (!made.ok()) return fault_ = made.status();
    surface_ = std::make_shared<PressureSurface>(std::move(made).value());
    findRest(of);
    return {};
  }
  /// A mesh does not know that the body was scaled.
  void findRest(BodyDynamics<Scalar>& of) {
    if (!of.tets() || of.tets()->rest().nodes.empty()) return;
    double* to = surface_->positions();
    for (const std::uint32_t n : surface_->nodes()) to = std::copy_n(of.tets()->rest().nodes[n].data(), 3, to);
    surface_->takeAsRest();
  }
  double referenceAfter(PressureSurface& before, const BodyProbe<Scalar>& now, BodyDynamics<Scalar>& of) {
    if (law_.kind == PressureLaw::Kind::Constant) return surface_->restVolume();
    const double from = of.volumeIn(before, now), to = of.volumeIn(*surface_, now);
    const bool crushed = !(from > kLeastVolume * before.restVolume() && to > kLeastVolume * surface_->restVolume());
    return law_.reference * (crushed ? surface_->restVolume() / before.restVolume() : to / from);
  }

  PressureLaw law_;
  std::shared_ptr<PressureSurface> surface_;  ///< null: of the tets, not made yet
  bool given_ = false;                        ///< by `setSurface`
  Status fault_;                              ///< why there is no surface; Ok: unknown
  std::function<Result<PressureSurface>()> make_;
};

}  // namespace tetskin::elastic_detail
