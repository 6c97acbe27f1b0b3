// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_view.h"

#include <algorithm>

#include "report/cage_skin.h"
#include "scenes/view_page.h"

namespace tetskin::report {
namespace {

/// Distance from one body to the next, over the largest width of either in the whole scene.
constexpr double kGap = 1.15;

Embedding embeddingOf(const Cage& cage, const TriangleMesh& mesh) {
  return skinOf(cage, mesh, {}).binding()->embedding();
}

Box3 positionsOf(const Trajectory& trajectory) {
  Box3 box;
  for (const std::vector<Eigen::Vector3f>& nodes : trajectory) box.extend(boundingBox(viewOf(nodes)));
  return box;
}

Points moved(Points points, double along) {
  for (Eigen::Vector3d& p : points) p.x() += along;
  return points;
}

std::string labelOf(const char* what, std::size_t tets) {
  return std::string(what) + scenes::withCommas(tets) + " tets";
}

}  // namespace

void writeView(SceneRunner& runner, const ReportModel& model, const ReportOptions& options) {
  const ShownMotion shown = runner.shownMotion();
  scenes::ViewPage page = scenes::newPage(
      scenes::titleOf(model.name) + ": " + runner.scene(),
      {scenes::withCommas(model.mesh.vertexCount()) + " vertices", "a coarse cage beside the reference"},
      Interpolation::Quadratic);
  page.addBody({page.addModel(shown.cage, model.mesh, embeddingOf(shown.cage, model.mesh)),
                labelOf("", shown.cage.mesh.tetCount()), ""});
  // A fine cage may have more nodes than the mesh has vertices: then its surface is the smaller one to keep.
  const bool bySurface = shown.right.mesh.nodeCount() > model.mesh.vertexCount();
  const std::size_t right = bySurface ? page.addSurface(model.mesh)
                                      : page.addModel(shown.right, model.mesh, embeddingOf(shown.right, model.mesh));
  page.addBody({right, labelOf("reference, ", shown.right.mesh.tetCount()), "quadratic"});
  page.setObstacles(shown.obstacles);

  Box3 positions = positionsOf(shown.nodes);
  positions.extend(positionsOf(shown.rightNodes));
  const double beside = kGap * positions.sizes().x();
  for (std::size_t k = 0; k < std::min(shown.nodes.size(), shown.rightNodes.size()); ++k) {
    const Points points = bySurface ? runner.rightSurface(static_cast<int>(k)) : toDouble(shown.rightNodes[k]);
    page.keep({{toDouble(shown.nodes[k]), moved(points, beside)}, {}});
  }
  scenes::writePage(page, options.view, options.quiet);
}

}  // namespace tetskin::report
