// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The scenes of tetskin_pile: what falls, and on what.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "pile/pile_options.h"

namespace tetskin::scenes {

class Pile;

/// The figures by which a run is judged.
enum class PileFigures {
  Depths,  ///< how deep bodies enter each other, over their size
  Rest,    ///< also how many of them sleep, and what each costs; lengths in metres
};

struct PileScene {
  const char* name;
  const char* title;  ///< of the page
  const char* thing;  ///< the kind of object that `PileOptions::bodies` counts, in the singular
  const char* rigid;  ///< the objects that soft bodies touch besides each other
  int mostBodies;
  bool ownMeshes;  ///< it makes its own meshes: there is no choice of model
  PileFigures figures;
  void (*build)(const PileOptions& options, Pile& pile);

  /// Length in which depths are told: the size of a body, or a metre.
  double unit() const { return figures == PileFigures::Depths ? kSize : 1.0; }
};

const std::vector<PileScene>& pileScenes();
/// The scene with this name, which must exist.
const PileScene& pileSceneNamed(const std::string& name);
/// The options of a scene if nothing but its name is given.
PileOptions presetOf(const std::string& scene);

/// Rotation of the k-th body before it falls. Piles are chaotic: an observation in one need not hold in another.
/// seed  1: rotations that are the same in all versions; any other: random ones
Eigen::Quaterniond turnOf(int seed, int k);

// The functions that build the scenes. In the first two, soft bodies of three models, or of the user's mesh, fall into
// a bowl.

/// One above the other; some fall across poles.
void buildColumn(const PileOptions& options, Pile& pile);
/// In layers of four, in calibrated cages.
void buildHeap(const PileOptions& options, Pile& pile);
/// Rigid balls fall on a soft mat: many of them light, two heavy.
void buildPit(const PileOptions& options, Pile& pile);
/// Soft cubes fall into a bin in layers of sixteen.
void buildBin(const PileOptions& options, Pile& pile);

}  // namespace tetskin::scenes
