// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/player.h"

#include <cassert>

#include "scenes/input_error.h"
#include "scenes/tets_of_nodes.h"
#include "scenes/timer.h"

namespace tetskin::scenes {

namespace {

/// Adds the modes of fine tets in the model, if its body is a reduced one.
SceneOptions withReduction(const Model& model, const Placement& position, const ModelOptions& options,
                           SceneOptions how) {
  if (how.force != Force::Reduced) return how;
  CageOptions fine;
  fine.targetTets = options.fineTets;
  fine.fit = false;
  announceCage(fine.targetTets, options);
  const Cage tets = cageFor(model, fine);
  how.reduction = std::make_shared<Reduction>(position.toWorld(tets), how.modes);
  if (!model.cage.vertexTets.empty()) how.reduction->nodeTets = tetsOfNodes(model.mesh, model.cage, tets);
  return how;
}

}  // namespace

Player::Player(const ModelOptions& options, const std::string& scene, const SceneOptions& how)
    : options_(options),
      model_(loadModel(options)),
      position_(placementOf(boundingBox(model_.cage.mesh.nodes))),
      scene_(sceneNamed(scene).make(position_.toWorld(model_.cage), withReduction(model_, position_, options, how))) {
  position_.offset = scene_->offset;
}

/// Embeds the mesh in the model's space, whose unit the options and the report use. Quadratic skinning measures its
/// correction by the cage at rest, and therefore needs the cage in the size of the body.
SoftBodyBinding::Pointer Player::bind(const SkinOptions& options) {
  const Result<Embedding> embedding = embed(model_.cage, model_.mesh, {options.outside, options.maxDistance}, &fit_);
  requireFit(embedding.status(), fit_, options_);
  TriangleMesh mesh = model_.mesh;
  position_.toWorld(mesh.positions);
  const auto binding = SoftBodyBinding::create(position_.toWorld(model_.cage), mesh, options, embedding.value());
  require(binding.status());
  return binding.value();
}

Carried& Player::carry(const SkinOptions& options) {
  InstanceOptions instance = options;
  instance.disableQuadratic = options.interpolation == Interpolation::Linear;
  Carried& added = carried_.emplace_back();
  if (carried_.size() == 1) {
    require(added.skin.bind(scene_->body(), bind(options), instance));
  } else {
    [[maybe_unused]] const BindingOptions& bound = carried_.front().skin.binding()->options();
    assert(options.interpolation == Interpolation::Linear || options.interpolation == bound.interpolation);
    assert(options.normals == bound.normals && options.order == bound.order);
    require(added.skin.bind(scene_->body(), carried_.front().skin.binding(), instance));
  }
  position_.readSurface(added.skin, added.surface);
  return added;
}

void Player::touchBySurface() {
  assert(!carried_.empty());
  scene_->world().touchBySurface(scene_->body(), *carried_.front().skin.binding(), model_.mesh);
}

void Player::touchItself(SelfContactWish wish) {
  Placement atRest = position_;  // the rest position of the cage, which the scene has moved
  atRest.offset.setZero();
  TriangleMesh mesh = model_.mesh;
  atRest.toWorld(mesh.positions);
  selfContact_ = selfContactOf(model_.name, atRest.toWorld(model_.cage), mesh, wish, options_.quiet);
  if (selfContact_.shape) scene_->world().touchEachOther(scene_->body(), selfContact_.shape, true);
}

/// Returns false if node positions are not finite.
bool Player::step(int frame, Playback& run) {
  const WallTimer simulation;
  scene_->step(frame);
  run.simulationMs += simulation.milliseconds();
  bool followed = true;
  for (Carried& carried : carried_) {
    const WallTimer timer;
    const StatusCode status = carried.skin.update();
    carried.microseconds += timer.microseconds();
    followed = followed && (status == StatusCode::Ok || status == StatusCode::Asleep);
    position_.readSurface(carried.skin, carried.surface);
  }
  return followed;
}

std::vector<Eigen::Vector3d> Player::nodes() const {
  std::vector<Eigen::Vector3d> nodes = nodesOf(scene_->body());
  position_.toModel(nodes);
  return nodes;
}

bool Player::makeFrame(int frame, Playback& run) {
  bool good = frame == 0 || step(frame, run);
  for (const Carried& carried : carried_) {
    const Findings found = scene_->check(carried.skin.positions());
    good = good && !found.exploded;
    run.aboveFloor = run.aboveFloor && found.aboveFloor;
  }
  return good;
}

Playback Player::play(const char* doing, const OutputOptions& output, const OfFrame& measure, const OfFrame& write) {
  return playFrames(
      doing, output, scene_->world(), [this](int frame, Playback& run) { return makeFrame(frame, run); }, measure,
      write);
}

}  // namespace tetskin::scenes
