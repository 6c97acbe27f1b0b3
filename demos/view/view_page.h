// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <string>
#include <vector>

#include "view/view_data.h"
#include "view/view_frames.h"

namespace tetskin::view {

/// The files that pages are made from.
struct ViewFiles {
  std::string folder;  ///< of view.html and the files that it names
  std::string three, orbitControls;
};

/// The colour of the triangles whose group names it.
struct ViewMaterial {
  std::string name;
  std::array<double, 3> colour;
  double shine = 0.0;  ///< strength of highlights, 0 to 1
  double opacity = 1.0;
};

/// A body shown on a page.
struct ViewBody {
  std::size_t model = 0;
  std::string label;          ///< drawn above it
  std::string skin;           ///< "linear" or "quadratic" regardless of the page's switch; empty: as the switch says
  std::string material = {};  ///< of all its triangles; empty: those that the model's groups name
};

/// One HTML file that plays a run in any browser, without a network. It contains each mesh, cage and embedding once and
/// the cages' nodes by frame, and does linear and quadratic skinning itself. See demos/view/.
class ViewPage {
 public:
  /// title  of the page; facts  shown in the line below; materials  those that meshes may name, in any order
  ViewPage(std::string title, std::vector<std::string> facts, Interpolation interpolation,
           std::vector<ViewMaterial> materials = {});

  /// A mesh in its cage, which any number of bodies may share: these bodies are given by the cage's nodes. Returns the
  /// model's number. Throws ViewError if they do not fit.
  std::size_t addModel(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding);
  /// A mesh whose bodies are given by its vertices: smaller where the cage has more nodes than the mesh has vertices.
  std::size_t addSurface(const TriangleMesh& mesh);
  void addBody(const ViewBody& body);
  /// Adds a rigid object that moves.
  void addProp(const TriangleMesh& mesh);
  /// Sets the fixed obstacles, in the space of the nodes.
  void setObstacles(const TriangleMesh& mesh);
  /// Sets the box that the first view shows; by default, it shows all positions of bodies.
  void setFocus(const Box3& focus) { focus_ = focus; }
  /// Sets the number of frames in a second, 60 by default.
  void setRate(double framesPerSecond) { rate_ = framesPerSecond; }

  /// Adds the next frame: bodies and props in the order in which they were added.
  void keep(const ViewMoment& moment) { frames_.keep(moment); }
  const ViewFrames& frames() const { return frames_; }

  /// The page. Throws ViewError if one of its files cannot be read.
  std::string html(const ViewFiles& files) const;

 private:
  void useMaterial(const std::string& name);
  void useMaterials(const TriangleMesh& mesh);
  Json data() const;
  Json bodyData(std::size_t body) const;
  Json propData(std::size_t prop) const;
  Box3 focus() const;

  std::string title_;
  std::vector<std::string> facts_;
  Interpolation interpolation_;
  double rate_ = 60.0;
  std::vector<ViewMaterial> known_;
  Json models_ = Json::array();
  Json materials_ = Json::object();  ///< those in use, by name
  std::vector<ViewBody> bodies_;
  std::vector<TriangleMesh> props_;
  TriangleMesh obstacles_;
  Box3 focus_;
  ViewFrames frames_;
};

/// A number as "12,345".
std::string withCommas(std::size_t number);

}  // namespace tetskin::view
