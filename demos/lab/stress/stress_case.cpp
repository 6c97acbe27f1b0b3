// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/stress_case.h"

#include <cstddef>

namespace tetskin::stress {
namespace {

/// Names, in the order of the enumeration.
template <class Enum, std::size_t N>
const char* nameIn(const char* const (&names)[N], Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? names[index] : "unknown";
}

}  // namespace

bool isOurs(scenes::Force force) {
  return force == scenes::Force::Elastic;
}

const char* toString(scenes::Force force) {
  static const char* const kNames[] = {"mass_spring", "linear_elasticity", "neo_hookean",
                                       "corotated",   "tetskin",           "reduced"};
  return nameIn(kNames, force);
}

const char* toString(Cage cage) {
  static const char* const kNames[] = {"bar",      "flat_tets",  "needle_tets",  "sliver_tets", "all_flat",
                                       "inverted", "duplicates", "unreferenced", "far_1e5",     "far_1e7",
                                       "tiny",     "huge",       "one_tet",      "split",       "large"};
  return nameIn(kNames, cage);
}

const char* toString(Surface surface) {
  static const char* const kNames[] = {"bar",        "far_outside",   "coincident",
                                       "non_finite", "three_million", "no_vertices"};
  return nameIn(kNames, surface);
}

const char* toString(Interpolation interpolation) {
  static const char* const kNames[] = {"linear", "quadratic"};
  return nameIn(kNames, interpolation);
}

const char* toString(Normals normals) {
  static const char* const kNames[] = {"none", "transformed", "recomputed"};
  return nameIn(kNames, normals);
}

}  // namespace tetskin::stress
