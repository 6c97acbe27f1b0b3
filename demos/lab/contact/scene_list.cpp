// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact/scene_list.h"

namespace tetskin::contact_demo {

ContactScenes contactScenes() {
  ContactScenes scenes;
  addHitScenes(scenes);
  addApplicationScenes(scenes);
  addLoadScenes(scenes);
  addFrictionScenes(scenes);
  addEnergyScenes(scenes);
  addBounceScenes(scenes);
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
}

}  // namespace tetskin::contact_demo
