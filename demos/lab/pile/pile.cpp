// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "pile/pile.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "scenes/caged_mesh.h"
#include "scenes/input_error.h"
#include "scenes/joined_mesh.h"
#include "scenes/placement.h"
#include "scenes/printed_table.h"
#include "scenes/solid_meshes.h"
#include "scenes/timer.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

/// Steps of Bullet's per frame.
constexpr int kSubsteps = 4;
/// A body farther from the origin than any can be thrown has exploded.
constexpr double kMaxCoordinate = 100.0 * kSize;

Cage placedAt(const Vector3d& at, const Eigen::Quaterniond& turn, Cage cage) {
  for (Vector3d& p : cage.mesh.nodes) p = turn * p + at;
  return cage;
}

std::vector<Vector3d> positionsOf(const SoftBodySkin& skin) {
  std::vector<Vector3d> positions;
  for (std::size_t v = 0; v < skin.positions().size(); ++v) {
    const btScalar* p = skin.positions()[v];
    positions.emplace_back(p[0], p[1], p[2]);
  }
  return positions;
}

std::vector<Vector3d> positionsOf(const btRigidBody& body, const TriangleMesh& mesh) {
  std::vector<Vector3d> positions;
  const Eigen::Affine3d at = affineOf(body.getWorldTransform());
  for (const Vector3d& p : mesh.positions) positions.push_back(at * p);
  return positions;
}

}  // namespace

PileModel::PileModel(Model placed, const SoftBodyOptions& madeOf, bool touches)
    : model(std::move(placed)), material(madeOf) {
  if (touches) {
    auto made = ContactShape::create(model.cage, model.mesh);
    if (!made.ok()) throw InputError(model.name + ": " + made.status().message);
    shape = made.value();
  }
  binding = boundTo(model.cage, model.mesh);
}

Pile::Pile(const PileOptions& options)
    : scene_(pileSceneNamed(options.scene)),
      contact_(options.contact),
      touchThemselves_(options.touchThemselves()),
      world_(Force::Elastic, btVector3(0, btScalar(-kEarth), 0)) {
  world_.leaveOutNodeNormals();
  if (options.threads > 1) world_.setThreads(&threads_.emplace(static_cast<std::size_t>(options.threads)));
  scene_.build(options, *this);
}

std::size_t Pile::addModel(PileModel model) {
  models_.push_back(std::move(model));
  return models_.size() - 1;
}

void Pile::addBody(std::size_t model, const Vector3d& at, const Eigen::Quaterniond& turn) {
  const PileModel& shared = models_[model];
  const TriangleMesh& mesh = shared.model.mesh;
  btSoftBody& body = world_.add(placedAt(at, turn, shared.model.cage), shared.material);
  if (contact_ == Contact::Surface) {
    shared.contact ? (void)world_.touchBySurface(body, *shared.binding, mesh, *shared.contact)
                   : world_.touchBySurface(body, *shared.binding, mesh);
  }
  if (shared.shape) world_.touchEachOther(body, shared.shape, touchThemselves_);
  bodies_.push_back({model, &body});
  softBodies_.push_back(&body);
  require(skins_.emplace_back().bind(body, shared.binding));
  skinPointers_.push_back(&skins_.back());
  tetCount_ += shared.model.cage.mesh.tetCount();
  (void)append(mesh, mesh_, shared.model.name);
}

void Pile::addBall(const PileBall& ball, const Vector3d& at) {
  TriangleMesh mesh = icosphere(ball.level);
  for (Vector3d& p : mesh.positions) p *= ball.radius;
  mesh.groups = {{"ball", ball.material, 0, mesh.triangleCount()}};
  btRigidBody& body = world_.addRigid(std::make_unique<btSphereShape>(static_cast<btScalar>(ball.radius)),
                                      btTransform(btQuaternion::getIdentity(), toBullet(at)), ball.mass);
  TriangleMesh drawn = mesh;
  for (Vector3d& p : drawn.positions) p += at;
  (void)append(drawn, mesh_);
  balls_.push_back({&body, ball.radius, std::move(mesh)});
}

void Pile::keepAwake() {
  for (btSoftBody* body : softBodies_) body->setActivationState(DISABLE_DEACTIVATION);
  for (const Ball& ball : balls_) ball.body->setActivationState(DISABLE_DEACTIVATION);
}

bool Pile::step() {
  for (int s = 0; s < kSubsteps; ++s) world_.step(kFrame / kSubsteps);
  statuses_.resize(skins_.size());
  const WallTimer timer;
  (void)SoftBodySkin::updateAll(skinPointers_.data(), skins_.size(), statuses_.data(), 1,
                                threads_ ? &*threads_ : nullptr);
  skinSeconds_ += timer.seconds();
  const bool followed = std::all_of(statuses_.begin(), statuses_.end(), [](StatusCode status) {
    return status == StatusCode::Ok || status == StatusCode::Asleep;
  });
  const bool near = std::all_of(skins_.begin(), skins_.end(),
                                [](const SoftBodySkin& skin) { return maxCoordinate(skin.bounds()) < kMaxCoordinate; });
  return followed && near && std::all_of(balls_.begin(), balls_.end(), [](const Ball& ball) {
           return toEigen(ball.body->getWorldTransform().getOrigin()).cwiseAbs().maxCoeff() < kMaxCoordinate;
         });
}

std::vector<Vector3d> Pile::surface() const {
  std::vector<Vector3d> points;
  const auto add = [&](const std::vector<Vector3d>& part) { points.insert(points.end(), part.begin(), part.end()); };
  for (const SoftBodySkin& skin : skins_) add(positionsOf(skin));
  for (const Ball& ball : balls_) add(positionsOf(*ball.body, ball.mesh));
  return points;
}

DeepestVertex Pile::deepestVertex() const {
  std::vector<TriangleMesh> surfaces;
  const auto add = [&](const TriangleMesh& mesh, std::vector<Vector3d> positions) {
    TriangleMesh& surface = surfaces.emplace_back();
    surface.triangles = mesh.triangles;
    surface.positions = std::move(positions);
  };
  for (std::size_t k = 0; k < skins_.size(); ++k) add(models_[bodies_[k].model].model.mesh, positionsOf(skins_[k]));
  for (const Ball& ball : balls_) add(ball.mesh, positionsOf(*ball.body, ball.mesh));
  DeepestVertex deepest = scenes::deepestVertex(surfaces);
  deepest.depth /= scene_.unit();
  return deepest;
}

double Pile::deepestContact() const {
  double deepest = 0.0;
  for (const SoftContact& c : world_.softContacts()) deepest = std::min(deepest, static_cast<double>(c.distance));
  return deepest / scene_.unit();
}

std::optional<double> Pile::deepestDent() const {
  std::optional<double> deepest;
  for (const Ball& ball : balls_) {
    const double lowest = static_cast<double>(ball.body->getWorldTransform().getOrigin().y()) - ball.radius;
    deepest = std::max(deepest.value_or(0.0), top_ - lowest);
  }
  return deepest;
}

std::size_t Pile::pairCount() const {
  std::set<std::pair<const btSoftBody*, const btSoftBody*>> pairs;
  for (const SoftContact& c : world_.softContacts()) {
    if (c.body != c.other) pairs.insert(std::minmax(c.body, c.other));
  }
  return pairs.size();
}

std::size_t Pile::asleepCount() const {
  const auto asleep = [](const auto& one) { return !one.body->isActive(); };
  return static_cast<std::size_t>(std::count_if(bodies_.begin(), bodies_.end(), asleep) +
                                  std::count_if(balls_.begin(), balls_.end(), asleep));
}

double Pile::fastest() const {
  btScalar squared = 0;
  for (const btSoftBody* body : softBodies_) {
    for (int n = 0; n < body->m_nodes.size(); ++n) squared = std::max(squared, body->m_nodes[n].m_v.length2());
  }
  for (const Ball& ball : balls_) squared = std::max(squared, ball.body->getLinearVelocity().length2());
  return std::sqrt(static_cast<double>(squared));
}

StageTimes Pile::stageTimes() const {
  StageTimes times = world_.stageTimes();
  times.skin = skinSeconds_;
  return times;
}

Recording Pile::record(const PileOptions& options, const std::string& view) const {
  std::vector<std::string> facts = {std::to_string(bodies_.size()) +
                                    (bodies_.size() == 1 ? " soft body" : " soft bodies")};
  if (!balls_.empty()) facts.push_back(std::to_string(balls_.size()) + " balls");
  facts.push_back(withCommas(mesh_.vertexCount()) + " vertices");
  facts.push_back(withCommas(tetCount_) + " tets");
  facts.push_back(contact_ == Contact::Surface
                      ? factOf(contact_, touchThemselves_)
                      : "contact with the " + std::string(scene_.rigid) + " at the cages' nodes");
  Recording recording(options.output, view, scene_.title, facts, Interpolation::Linear);
  if (!recording.wanted()) return recording;
  for (const PileModel& model : models_) {
    recording.addModel(titleOf(model.model.name), model.model.cage, model.model.mesh, model.binding->embedding());
  }
  for (const Body& body : bodies_) recording.addBody({body.model, "", ""});
  for (const Ball& ball : balls_) recording.addProp(ball.mesh);
  recording.setObstacles(obstacles());
  recording.setFocus(focus_);
  return recording;
}

ViewMoment Pile::moment() const {
  ViewMoment moment;
  for (const btSoftBody* body : softBodies_) moment.bodies.push_back(nodesOf(*body));
  for (const Ball& ball : balls_) moment.props.push_back(affineOf(ball.body->getWorldTransform()));
  return moment;
}

}  // namespace tetskin::scenes
