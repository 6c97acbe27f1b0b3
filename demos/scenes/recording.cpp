// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/recording.h"

#include <cassert>
#include <filesystem>

#include "scenes/formats.h"
#include "scenes/input_error.h"
#include "scenes/materials.h"
#include "scenes/scene.h"
#include "scenes/timer.h"

namespace tetskin::scenes {

Recording::Recording(const OutputOptions& output, std::string view, const std::string& title,
                     const std::vector<std::string>& facts, Interpolation interpolation)
    : view_(std::move(view)), quiet_(output.quiet), frames_(output.frames), interpolation_(interpolation) {
  if (!view_.empty()) page_.emplace(newPage(title, facts, interpolation));
  if (!formatsOf(output).glb) return;
  const std::string path = (std::filesystem::path(output.out) / kGlbName).string();
  Result<GlbWriter> writer = GlbWriter::create(path, kFrameRate);
  require(writer.status());
  glb_.emplace(std::move(writer).value());
  glb_->setMaterials(surfaceMaterials());
}

std::size_t Recording::addModel(const std::string& name, const Cage& cage, const TriangleMesh& mesh,
                                const Embedding& embedding) {
  if (page_) (void)page_->addModel(cage, mesh, embedding);
  models_.push_back({name, {}, {}, {}});
  if (glb_) models_.back() = {name, cage, mesh, embedding};
  return models_.size() - 1;
}

void Recording::addBody(const ViewBody& body) {
  assert(body.model < models_.size());
  if (page_) page_->addBody(body);
  if (!glb_) return;
  const Interpolation kind = body.skin.empty()       ? interpolation_
                             : body.skin == "linear" ? Interpolation::Linear
                                                     : Interpolation::Quadratic;
  const Model& model = models_[body.model];
  const auto [known, isNew] = glbModels_.try_emplace({body.model, kind});
  if (isNew) {
    const Result<std::size_t> added = glb_->addModel(model.name, model.cage, model.mesh, model.embedding, kind);
    require(added.status());
    known->second = added.value();
  }
  glb_->addBody(known->second, body.label.empty() ? model.name : body.label);
}

void Recording::addProp(const TriangleMesh& mesh) {
  if (page_) page_->addProp(mesh);
  if (glb_) require(glb_->addObject(mesh.groups.empty() ? "prop" : mesh.groups.front().name, mesh, true));
}

void Recording::setObstacles(const TriangleMesh& mesh) {
  if (page_) page_->setObstacles(mesh);
  if (glb_ && !mesh.triangles.empty()) require(glb_->addObject("obstacles", mesh, false));
}

void Recording::setFocus(const Box3& focus) {
  if (page_) page_->setFocus(focus);
}

void Recording::keep(const ViewMoment& moment) {
  if (page_) page_->keep(moment);
  if (!glb_) return;
  const WallTimer timer;
  std::vector<PointView<const double>> nodes;
  for (const auto& body : moment.bodies) nodes.push_back(viewOf(body));
  require(glb_->addFrame(nodes, moment.props));
  glbMs_ += timer.milliseconds();
}

void Recording::writeGlb() {
  if (!glb_) return;
  const WallTimer timer;
  require(glb_->finish());
  glbMs_ += timer.milliseconds();
  glb_.reset();
}

void Recording::writePage() const {
  if (page_) scenes::writePage(*page_, view_, quiet_);
}

}  // namespace tetskin::scenes
