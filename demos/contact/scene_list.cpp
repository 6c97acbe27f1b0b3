// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact/scene_list.h"

#include <cstdio>

namespace tetskin::contact_demo {

const ContactScenes& contactScenes() {
  static const ContactScenes all = [] {
    ContactScenes scenes;
    addHitScenes(scenes);
    addApplicationScenes(scenes);
    addLoadScenes(scenes);
    addFrictionScenes(scenes);
    addEnergyScenes(scenes);
    addMovedScenes(scenes);
    addRestScenes(scenes);
    addCoarseScenes(scenes);
    addSleepScenes(scenes);
    addSoftScenes(scenes);
    addSlabScenes(scenes);
    addSlidingScenes(scenes);
    addJointScenes(scenes);
    addCostScenes(scenes);
    return scenes;
  }();
  return all;
}

std::string text(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%g", value);
  return digits;
}

}  // namespace tetskin::contact_demo
