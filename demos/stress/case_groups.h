// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the groups of cases have in common. Each group appends its cases.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "stress/stress_case.h"

namespace tetskin::stress {

using Cases = std::vector<StressCase>;
using scenes::Force;

constexpr double kStiffestOfBullets = 1e7;  ///< at most steps they explode with less
constexpr double kStiffestOfOurs = 1e7;     ///< that is promised

void addMaterialCases(Cases& cases);  ///< first the stability maps, whose cells are runs of their own
void addEventCases(Cases& cases);
void addModelCases(Cases& cases);
void addContactCases(Cases& cases);
void addReducedCases(Cases& cases);
void addClaims(Cases& cases);

/// "1e+06", "0.49".
std::string text(double value);
/// "1/240".
std::string stepText(double seconds);
const char* integrator(bool implicit);

/// A force, and how its world integrates it.
struct Method {
  Force force = Force::NeoHookean;
  bool implicit = false;
};

/// Bullet's forces with both of its integrators, and the library's, whose solver has one.
std::vector<Method> methodsOf(std::initializer_list<Force> bullets);

/// Group, and name from words.
StressCase named(const std::string& group, std::initializer_list<std::string> words);
/// The same, of a method, which is in the name.
StressCase named(const std::string& group, const Method& method, std::initializer_list<std::string> words);

bool isOneOf(const std::string& scene, std::initializer_list<const char*> scenes);

/// What the library's force and solver are expected to hold; the rest are rows that say what is missing:
/// - beyond 1e7 Pa;
/// - 100 turns a second, 0.4 turns a substep: nodes fly that far straight on, to more than twice the size;
/// - a body flat, ten times as long, or inside out, beyond 1e6 Pa in steps longer than 1/240 s: it may grow to several
///   times its size, and stay bent. That is the damping, which is as stiff as the body: without any, such bodies come
///   back.
Simulation promised(const StressCase& ours);

}  // namespace tetskin::stress
