// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/animation.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/view_page.h"

namespace tetskin::scenes {

/// All frames of a run, given by nodes, for its page and for its GLB, whichever are wanted: both hold each mesh once.
class Recording {
 public:
  /// The GLB's name in the folder of a run.
  static constexpr const char* kGlbName = "animation.glb";

  /// view  the file of the page (see `viewPath`), empty for none; title, facts  of the page
  /// Throws InputError if the GLB, which goes to an existing folder, cannot be written.
  Recording(const OutputOptions& output, std::string view, const std::string& title,
            const std::vector<std::string>& facts, Interpolation interpolation);

  /// Whether anything is recorded.
  bool wanted() const { return page_ || glb_; }
  bool hasGlb() const { return glb_.has_value(); }
  /// About how many bytes the GLB will have, once everything is added; 0 without one.
  double glbBytes() const { return glb_ ? glb_->bytesFor(frames_) : 0.0; }
  /// Wall time that the GLB has taken so far: keeping its frames, and writing it.
  double glbMilliseconds() const { return glbMs_; }

  // The title: see ViewPage. Names are those of the GLB's nodes. Throws InputError if a mesh does not fit its cage.

  std::size_t addModel(const std::string& name, const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);
  void addBody(const ViewBody& body);
  void addProp(const TriangleMesh& mesh);
  void setObstacles(const TriangleMesh& mesh);
  void setFocus(const Box3& focus);

  /// Adds the next frame: bodies and props in the order in which they were added.
  void keep(const ViewMoment& moment);
  /// Writes the GLB, after the last frame. Throws InputError.
  void writeGlb();
  /// Writes the page, and prints where it is. Throws InputError.
  void writePage() const;

 private:
  struct Model {
    std::string name;
    Cage cage;
    TriangleMesh mesh;
    Embedding embedding;
  };

  std::string view_;
  bool quiet_ = false;
  int frames_ = 0;
  Interpolation interpolation_;
  std::vector<Model> models_;
  std::map<std::pair<std::size_t, Interpolation>, std::size_t> glbModels_;
  std::optional<ViewPage> page_;
  std::optional<GlbWriter> glb_;
  double glbMs_ = 0.0;
};

}  // namespace tetskin::scenes
