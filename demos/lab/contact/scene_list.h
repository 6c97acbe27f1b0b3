// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The scenes in which contact is measured.
#pragma once

#include "measure/run.h"

namespace tetskin::contact_demo {

using measure::Kind;
using measure::Run;
using measure::text;

using ContactScenes = measure::MeasuredScenes;

void addHitScenes(ContactScenes& scenes);
void addApplicationScenes(ContactScenes& scenes);
void addRestScenes(ContactScenes& scenes);
void addCoarseScenes(ContactScenes& scenes);
void addSoftScenes(ContactScenes& scenes);
void addSlabScenes(ContactScenes& scenes);
void addJointScenes(ContactScenes& scenes);
void addCostScenes(ContactScenes& scenes);
void addLoadScenes(ContactScenes& scenes);
void addFrictionScenes(ContactScenes& scenes);
void addEnergyScenes(ContactScenes& scenes);
void addBounceScenes(ContactScenes& scenes);
void addMovedScenes(ContactScenes& scenes);
void addSlidingScenes(ContactScenes& scenes);
void addSleepScenes(ContactScenes& scenes);

/// Sums of momentum, ways, gaps and speeds, compared with analytic results.
ContactScenes contactScenes();

}  // namespace tetskin::contact_demo
