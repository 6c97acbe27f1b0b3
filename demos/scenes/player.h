// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <deque>
#include <functional>

#include "scenes/command_line.h"
#include "scenes/placement.h"
#include "scenes/playback.h"
#include "scenes/scene.h"

namespace tetskin::scenes {

/// A skin, and its surface in the model's space.
struct Carried {
  SoftBodySkin skin;
  std::vector<Eigen::Vector3d> surface;  ///< vertexCount
  double microseconds = 0.0;             ///< total of all updates
};

/// A model in a scene, with surfaces on its body. It may have any size and position: results are in its own space.
/// Frame 0 is the model at rest.
class Player {
 public:
  /// Makes a scene with a cage, see scenes/table.h, where those of `sceneTable` are.
  using MakeScene = std::function<std::unique_ptr<Scene>(const Cage& cage, const SceneOptions& options)>;

  /// Loads the model. Throws InputError.
  Player(const ModelOptions& options, const MakeScene& makeScene, const SceneOptions& how = {});

  /// Adds a surface. All later ones share the binding of the first, and may leave out its quadratic skinning. Throws
  /// InputError if mesh and cage do not fit.
  Carried& carry(const SkinOptions& options);

  /// From now on, rigid bodies touch the model's mesh, for which `carry` must have been called before.
  void touchBySurface();

  /// From now on, the body has self-contact at its surface, if possible: see `selfContactOf`.
  void touchItself(SelfContactWish wish);
  const SelfContact& selfContact() const { return selfContact_; }

  const Model& model() const { return model_; }
  Scene& scene() { return *scene_; }
  const Placement& placement() const { return placement_; }
  const EmbedReport& fit() const { return fit_; }

  /// Simulates the frames that the options request, and prints the progress.
  /// measure  called after every frame; write  called after those that are to be written
  Playback play(const char* doing, const OutputOptions& output, const OfFrame& measure, const OfFrame& write);

  /// The cage's nodes at present, in the model's space.
  std::vector<Eigen::Vector3d> nodes() const;

 private:
  SoftBodyBinding::Pointer bind(const SkinOptions& options);
  bool step(int frame, Playback& run);
  bool makeFrame(int frame, Playback& run);

  ModelOptions options_;
  Model model_;
  Placement placement_;
  std::unique_ptr<Scene> scene_;
  std::deque<Carried> carried_;
  EmbedReport fit_;
  SelfContact selfContact_;
};

}  // namespace tetskin::scenes
