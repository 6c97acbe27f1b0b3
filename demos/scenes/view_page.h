// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/triangle_mesh.h>

#include <string>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/model.h"
#include "scenes/view_data.h"
#include "scenes/view_frames.h"

namespace tetskin::scenes {

/// Why no page can be made, in a sentence; empty if one can be: pages contain three.js, which must have been there when
/// the demos were configured, and be there still.
std::string whyNoView();
/// Throws InputError if no page can be made.
void requireViewable();
/// Where a run's page goes, empty for none. Where a default page cannot be made, says why. Throws
/// InputError where one that was asked for cannot be made.
std::string viewPath(const OutputOptions& options);

/// A body of a page.
struct ViewBody {
  std::size_t model = 0;
  std::string label;  ///< drawn above it
  std::string skin;   ///< "linear" or "quadratic", whatever the page's switch says; empty: as that says
};

/// One HTML file that plays a run in any browser, without a network: it holds each mesh, cage and embedding once and
/// the cages' nodes by frame, and skins by itself, linearly and quadratically. See demos/view/.
class ViewPage {
 public:
  /// title  what is shown;  facts  about it, in the line below
  ViewPage(std::string title, std::vector<std::string> facts, Interpolation interpolation);

  /// A mesh in its cage, which any number of bodies may share: bodies of it are given by the cage's nodes. Returns its
  /// number. Throws InputError if they do not fit.
  std::size_t addModel(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);
  /// A mesh of which bodies are given by its vertices: smaller where the cage has more nodes than the mesh has
  /// vertices.
  std::size_t addSurface(const TriangleMesh& mesh);
  void addBody(const ViewBody& body);
  /// Rigid, and moved.
  void addProp(const TriangleMesh& mesh);
  /// Fixed, in the space of the nodes.
  void setObstacles(const TriangleMesh& mesh) { obstacles_ = mesh; }
  /// What the first view shows; without it, all places where bodies are.
  void setFocus(const Box3& focus) { focus_ = focus; }

  /// The next frame: bodies and props in the order in which they were added.
  void keep(const ViewMoment& moment) { frames_.keep(moment); }
  const ViewFrames& frames() const { return frames_; }

  /// The page. Throws InputError if a part of it cannot be read.
  std::string html() const;
  /// Writes it, and tells where it is, how large, and how to look at it. Throws InputError.
  void write(const std::string& path, bool quiet) const;

 private:
  Json data() const;
  Json bodyData(std::size_t body) const;
  Json propData(std::size_t prop) const;
  Box3 focus() const;

  std::string title_;
  std::vector<std::string> facts_;
  Interpolation interpolation_;
  Json models_ = Json::array();
  Json materials_ = Json::object();  ///< by name
  std::vector<ViewBody> bodies_;
  std::vector<TriangleMesh> props_;
  TriangleMesh obstacles_;
  Box3 focus_;
  ViewFrames frames_;
};

/// A model by the name of its file, without the folder.
std::string titleOf(const std::string& name);
/// What meets obstacles and other bodies.
std::string factOf(Contact contact, bool withItself);
/// "12,345".
std::string withCommas(std::size_t number);
/// Vertices, triangles and tets.
std::vector<std::string> factsOf(const Model& model);

}  // namespace tetskin::scenes
