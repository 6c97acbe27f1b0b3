// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>

#include <string>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/model.h"
#include "scenes/view_data.h"
#include "scenes/view_frames.h"

namespace tetskin::scenes {

/// Why no page can be made, in a sentence; empty if one can be made. Pages contain three.js, which must have been found
/// when the demos were configured, and must still be there.
std::string whyNoView();
/// Throws InputError if no page can be made.
void requireViewable();
/// The file of a run's page, empty for none. Where a default page cannot be made, prints why. Throws InputError where a
/// page that was requested cannot be made.
std::string viewPath(const OutputOptions& options);

/// A body shown on a page.
struct ViewBody {
  std::size_t model = 0;
  std::string label;  ///< drawn above it
  std::string skin;   ///< "linear" or "quadratic" regardless of the page's switch; empty: as the switch says
};

/// One HTML file that plays a run in any browser, without a network. It contains each mesh, cage and embedding once and
/// the cages' nodes by frame, and does linear and quadratic skinning itself. See demos/view/.
class ViewPage {
 public:
  /// title  what is shown; facts  about it, in the line below
  ViewPage(std::string title, std::vector<std::string> facts, Interpolation interpolation);

  /// A mesh in its cage, which any number of bodies may share: these bodies are given by the cage's nodes. Returns the
  /// model's number. Throws InputError if they do not fit.
  std::size_t addModel(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);
  /// A mesh whose bodies are given by its vertices: smaller where the cage has more nodes than the mesh has vertices.
  std::size_t addSurface(const TriangleMesh& mesh);
  void addBody(const ViewBody& body);
  /// Adds a rigid object that moves.
  void addProp(const TriangleMesh& mesh);
  /// Sets the fixed obstacles, in the space of the nodes.
  void setObstacles(const TriangleMesh& mesh) { obstacles_ = mesh; }
  /// Sets the box that the first view shows; by default, it shows all positions of bodies.
  void setFocus(const Box3& focus) { focus_ = focus; }

  /// Adds the next frame: bodies and props in the order in which they were added.
  void keep(const ViewMoment& moment) { frames_.keep(moment); }
  const ViewFrames& frames() const { return frames_; }

  /// The page. Throws InputError if one of its files cannot be read.
  std::string html() const;
  /// Writes the page, and prints its path, its size, and how to look at it. Throws InputError.
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

/// A model's name: that of its file, without the folder.
std::string titleOf(const std::string& name);
/// A sentence on what meets obstacles and other bodies.
std::string factOf(Contact contact, bool withItself);
/// A number as "12,345".
std::string withCommas(std::size_t number);
/// Numbers of vertices, triangles and tets.
std::vector<std::string> factsOf(const Model& model);

}  // namespace tetskin::scenes
