// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <string>

#include "scenes/command_line.h"

namespace tetskin::scenes {

constexpr int kFramesPerSecond = 60;
constexpr double kFrame = 1.0 / kFramesPerSecond;

/// The settings of tetskin_pile's command line. The numbers of bodies, triangles and tets are those of the scene
/// "column"; `presetOf` gives them for any scene.
struct PileOptions {
  std::string scene = "column";       ///< see pile/pile_scenes.h
  int bodies = 10;                    ///< those that fall: soft ones, or the balls of the pit
  int depthEvery = kFramesPerSecond;  ///< frames between two measurements of the deepest vertex
  int seed = 1;                       ///< of the rotations or places of the bodies before they fall
  int threads = 1;                    ///< threads of the solver and of the skins, including the calling one
  ModelOptions model;                 ///< if it has no mesh: the options common to all built-in models
  Contact contact = Contact::Surface;
  SelfContactWish selfContact = SelfContactWish::WherePossible;
  OutputOptions output{"out/pile", "", 600, 1, false};

  bool touchThemselves() const { return wishBeside(contact, selfContact) != SelfContactWish::Off; }
};

}  // namespace tetskin::scenes
