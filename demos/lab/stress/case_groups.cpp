// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

#include <algorithm>
#include <cmath>

namespace tetskin::stress {

std::string stepText(double seconds) {
  return "1/" + text(std::round(1.0 / seconds));
}

const char* integrator(bool implicit) {
  return implicit ? "implicit" : "explicit";
}

std::vector<Method> methodsOf(std::initializer_list<Force> bullets) {
  std::vector<Method> methods;
  for (const Force force : bullets) {
    methods.push_back({force, false});
    methods.push_back({force, true});
  }
  methods.push_back({Force::Elastic, false});
  return methods;
}

StressCase named(const std::string& group, std::initializer_list<std::string> words) {
  StressCase made;
  made.group = group;
  made.name = group;
  for (const std::string& word : words) made.name += "/" + word;
  return made;
}

StressCase named(const std::string& group, const Method& method, std::initializer_list<std::string> words) {
  StressCase made = named(group, words);
  const std::string force = toString(method.force);
  const bool ownSolver = method.force == Force::Elastic;
  made.name.insert(group.size(), "/" + (ownSolver ? force : force + "/" + integrator(method.implicit)));
  made.force = method.force;
  made.implicit = method.implicit;
  return made;
}

bool isOneOf(const std::string& scene, std::initializer_list<const char*> scenes) {
  return std::count(scenes.begin(), scenes.end(), scene) > 0;
}

Simulation promised(const StressCase& ours) {
  constexpr double kStiffestInverted = 1e6;
  constexpr double kMaxStep = 1.0 / 240;
  if (ours.stiffness > kStiffestOfOurs || ours.scene == "spin") return Simulation::Either;
  const bool restored = isOneOf(ours.scene, {"squash_flat", "stretch", "mirror"});
  const bool coarse = ours.stiffness > kStiffestInverted && ours.substep() > kMaxStep;
  return restored && coarse ? Simulation::Either : Simulation::Bounded;
}

}  // namespace tetskin::stress
