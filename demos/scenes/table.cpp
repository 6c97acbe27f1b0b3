// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"

#include <algorithm>

#include "scenes/input_error.h"

namespace tetskin::scenes {

// One line per scene: its maker is make<Name>, in a file of the folder `all`, or in obstacles.cpp. Name, frames,
// whether it lands, description.
#define TETSKIN_SCENES(SCENE)                                                                                       \
  SCENE(Sag, "sag", 60, false, "pinned at its lower end, under gravity")                                            \
  SCENE(Twist, "twist", 60, false, "pinned at both ends; the upper one is turned")                                  \
  SCENE(Drop, "drop", 48, true, "falls on a box")                                                                   \
  SCENE(Exact, "exact", 1, false, "nodes moved by a smooth map, without Bullet")                                    \
  SCENE(Obstacles, "obstacles", 240, true, "falls on a floor, a ramp and a dome")                                   \
  SCENE(Wring, "wring", 240, false, "pinned at both ends of its longest side, twisted by a full turn and released") \
  SCENE(Crowd, "crowd", 60, false, "many bodies side by side in free fall, too far apart to touch")                 \
  SCENE(Float, "float", 60, false, "bodies side by side, without gravity")                                          \
  SCENE(Land, "land", 30, true, "falls on the floor from a small height")                                           \
  SCENE(Pluck, "pluck", 30, false, "stretched by 1 % at once and released")                                         \
  SCENE(SquashFlat, "squash_flat", 30, false, "all nodes are put on a plane and released")                          \
  SCENE(Stretch, "stretch", 30, false, "stretched to ten times its length at once and released")                    \
  SCENE(Mirror, "mirror", 30, false, "turned inside out at once")                                                   \
  SCENE(Permute, "permute", 30, false, "every node is put at the position of another")                              \
  SCENE(Spin, "spin", 30, false, "spins at 100 revolutions per second")                                             \
  SCENE(Teleport, "teleport", 30, false, "moved by 1,000 body lengths, and back")                                   \
  SCENE(Impact, "impact", 30, true, "hits the floor at 100 body lengths per second")                                \
  SCENE(SoftStack, "soft_stack", 60, true, "four bodies on top of each other, with contact")                        \
  SCENE(SoftRemoved, "soft_removed", 60, true,                                                                      \
        "four bodies on top of each other; all but the lowest are removed one by one")                              \
  SCENE(SoftSqueezed, "soft_squeezed", 60, false, "squeezed to half its height between two others")                 \
  SCENE(SoftPile, "soft_pile", 120, true, "ten bodies between four walls, with contact")                            \
  SCENE(Pull, "pull", 30, false, "pinned at one node, pulled by another over three body lengths")                   \
  SCENE(HeavyBox, "heavy_box", 30, true, "a box of 1,000 times its mass falls on it")                               \
  SCENE(LightBox, "light_box", 30, true, "a box of a tenth of its mass falls on it")                                \
  SCENE(Pole, "pole", 60, true, "falls on a pole thinner than a tet")                                               \
  SCENE(Press, "press", 60, true, "pressed to half its height by a plate and released")                             \
  SCENE(Blade, "blade", 60, true, "falls on an edge thinner than a tet")                                            \
  SCENE(Bed, "bed", 60, true, "falls on 225 small balls")                                                           \
  SCENE(Hail, "hail", 60, true, "a hundred little boxes fall on it")                                                \
  SCENE(Flatten, "flatten", 60, false, "squeezed to a tenth of its height between two plates and released")         \
  SCENE(Squeeze, "squeeze", 60, false, "squeezed to half its height between plates once per second")                \
  SCENE(Mill, "mill", 60, true, "hit by a bar that rotates and moves")                                              \
  SCENE(ObstaclesGo, "obstacles_go", 60, true, "its support, and an object on it, are removed")                     \
  SCENE(BodyGoes, "body_goes", 60, true, "removed from the floor on which it lies")                                 \
  SCENE(NodeNaN, "node_nan", 30, false, "a node is NaN for one update")                                             \
  SCENE(NodeInfinite, "node_infinite", 30, false, "a node is infinite for one update")                              \
  SCENE(NodeTooFar, "node_too_far", 30, false, "a node is beyond the supported range for one update")

#define DECLARE(maker, name, frames, lands, about) \
  std::unique_ptr<Scene> make##maker(const Cage& cage, const SceneOptions& options);
TETSKIN_SCENES(DECLARE)
#undef DECLARE

const std::vector<SceneEntry>& sceneTable() {
#define ENTRY(maker, name, frames, lands, about) {name, frames, lands, about, make##maker},
  static const std::vector<SceneEntry> table = {TETSKIN_SCENES(ENTRY)};
#undef ENTRY
  return table;
}

std::string sceneNames() {
  std::string names;
  for (const SceneEntry& entry : sceneTable()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

const SceneEntry& sceneNamed(const std::string& name) {
  const auto& table = sceneTable();
  const auto found = std::find_if(table.begin(), table.end(), [&](const SceneEntry& e) { return e.name == name; });
  if (found != table.end()) return *found;
  throw InputError("unknown scene '" + name + "'; choose from: " + sceneNames());
}

std::function<std::unique_ptr<Scene>(const Cage&, const SceneOptions&)> makerOf(const std::string& name) {
  return
      [&entry = sceneNamed(name)](const Cage& cage, const SceneOptions& options) { return entry.make(cage, options); };
}

std::unique_ptr<Scene> SceneEntry::make(const Cage& cage, SceneOptions options) const {
  if (options.frames == 0) options.frames = frames;
  return maker(cage, options);
}

}  // namespace tetskin::scenes
