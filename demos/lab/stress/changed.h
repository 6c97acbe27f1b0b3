// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/material_changes.h>

#include "scenes/input_error.h"

namespace tetskin::stress {

constexpr double kGrowth = 1.1;        ///< factor of length of bodies that have grown
constexpr double kYieldStrain = 0.02;  ///< of these: what is stretched by more flows

/// Lets a body grow at once, and flow from now on.
/// body  a DeformableBody or an ElasticBody
template <class Body>
void growAndYield(Body& body, double youngsModulus) {
  Plasticity plasticity;
  plasticity.yieldStress = kYieldStrain * youngsModulus;
  scenes::require(body.setPlasticity(plasticity));
  scenes::require(body.setGrowth(kGrowth));
}

}  // namespace tetskin::stress
