// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The common part of the groups of cases. Each group appends its own cases.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "measure/run.h"
#include "stress/stress_case.h"

namespace tetskin::stress {

using Cases = std::vector<StressCase>;
using measure::text;
using scenes::Force;

constexpr double kStiffestOfBullets = 1e7;  ///< with stiffer bodies of Bullet's forces most time steps explode
constexpr double kStiffestOfOurs = 1e7;     ///< largest stiffness for which stability is promised

void addMaterialCases(Cases& cases);  ///< first the stability maps, whose cells are separate runs
void addEventCases(Cases& cases);
void addModelCases(Cases& cases);
void addContactCases(Cases& cases);
void addReducedCases(Cases& cases);
void addClaims(Cases& cases);

/// A time step as text: "1/240".
std::string stepText(double seconds);
const char* integrator(bool implicit);

/// A force, and the integrator of its world.
struct Method {
  Force force = Force::NeoHookean;
  bool implicit = false;
};

/// Bullet's forces with both of its integrators, and the library's force, whose solver has only one.
std::vector<Method> methodsOf(std::initializer_list<Force> bullets);

/// A case in a group, with a name made of words.
StressCase named(const std::string& group, std::initializer_list<std::string> words);
/// A case of a method, which is part of its name.
StressCase named(const std::string& group, const Method& method, std::initializer_list<std::string> words);

bool isOneOf(const std::string& scene, std::initializer_list<const char*> scenes);

/// The conditions that the library's force and solver are expected to withstand. The exceptions are rows that show what
/// is missing: - stiffness beyond 1e7 Pa; - 100 turns per second, 0.4 turns per substep: nodes move in a straight line
/// so far that the body more than doubles in size; - a body flat, ten times as long, or inside out, beyond 1e6 Pa in
/// steps longer than 1/240 s: it may grow to several times its size, and stay bent. The reason is the damping, which is
/// as stiff as the body: without any damping, such bodies recover.
Simulation promised(const StressCase& ours);

}  // namespace tetskin::stress
