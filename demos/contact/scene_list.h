// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The scenes in which contact is measured. Each is a function that makes its own world.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "contact/run.h"

namespace tetskin::contact_demo {

struct ContactScene {
  std::string name;
  std::function<void(Run&)> run;
  /// the kinds with which it can be run
  std::vector<Kind> kinds = {Kind::Surface, Kind::Nodes, Kind::Bullet};

  bool isFor(Kind kind) const { return std::count(kinds.begin(), kinds.end(), kind) > 0; }
};

using ContactScenes = std::vector<ContactScene>;

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
void addMovedScenes(ContactScenes& scenes);
void addSlidingScenes(ContactScenes& scenes);
void addSleepScenes(ContactScenes& scenes);

const ContactScenes& contactScenes();

/// A number as it stands in names: "50", "0.05".
std::string text(double value);

}  // namespace tetskin::contact_demo
