// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>

#include "scenes/input_error.h"
#include "scenes/placement.h"
#include "scenes/serpent.h"
#include "stress/claim.h"
#include "stress/skin_judge.h"

namespace tetskin::stress {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSecondsRun = 1.0;
constexpr double kPoisson = 0.3;
constexpr double kGravity = 9.81;
/// Limits relative to the initial energy and the work put in, to momentum, and to the size of a reference. A dragged
/// body, whose point is light compared with the rest, gains more energy, and in long steps, for a moment, as much as
/// kMaxInLongSteps.
constexpr double kMaxEnergy = 1.02, kMaxDragged = 1.2, kMaxInLongSteps = 1.5, kMaxLost = 1e-3, kMaxSize = 1.2;
constexpr double kLongStep = 0.01;
/// E V times this is the elastic energy that rounding of positions appears as.
constexpr double kRounding = sizeof(btScalar) == sizeof(float) ? 1e-11 : 1e-27;

const Vector3d& spinAxis() {
  static const Vector3d axis = Vector3d(1.0, 1.0, 0.3).normalized();
  return axis;
}

TriangleMesh ellipsoid(const Vector3d& halves) {
  constexpr int kRings = 16, kAround = 20;
  TriangleMesh mesh;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < kAround; ++j) {
      const double a = 3.14159265358979323846 * i / kRings, b = 2.0 * 3.14159265358979323846 * j / kAround;
      mesh.positions.push_back(
          halves.cwiseProduct(Vector3d(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b))));
    }
  }
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kAround; ++j) {
      const int a = i * kAround + j, b = i * kAround + (j + 1) % kAround;
      if (i > 0) mesh.triangles.push_back({a, b, a + kAround});
      if (i < kRings - 1) mesh.triangles.push_back({b, b + kAround, a + kAround});
    }
  }
  // The rings of the poles are points.
  std::vector<int> index(mesh.positions.size());
  std::vector<Vector3d> kept;
  for (std::size_t v = 0; v < index.size(); ++v) {
    const bool pole = v < kAround || v >= kRings * kAround;
    if (pole && v % kAround != 0) {
      index[v] = index[v - v % kAround];
      continue;
    }
    index[v] = static_cast<int>(kept.size());
    kept.push_back(mesh.positions[v]);
  }
  mesh.positions = std::move(kept);
  for (auto& t : mesh.triangles) {
    for (int& v : t) v = index[static_cast<std::size_t>(v)];
  }
  return mesh;
}

struct ClaimModel {
  TriangleMesh mesh;
  tetskin::Cage cage;
  std::vector<Matrix3d> inverseEdges;
  std::vector<double> volumes;
  double volume = 0.0, size = 0.0;
};

ClaimModel makeModel(Claim::Shape shape) {
  ClaimModel model;
  switch (shape) {
    case Claim::Shape::Sphere:
      model.mesh = ellipsoid({0.5, 0.5, 0.5});
      break;
    case Claim::Shape::Bar:
      model.mesh = ellipsoid({0.125, 1.0, 0.175});
      break;
    case Claim::Shape::Serpent: {
      model.mesh = scenes::makeSerpent({scenes::kMinSerpentTriangles});
      const Box3 box = boundingBox(model.mesh.positions);
      for (Vector3d& p : model.mesh.positions) p = (p - box.center()) / box.sizes().maxCoeff();
    }
  }
  CageOptions options;
  options.targetTets = 200;
  model.cage = createCage(model.mesh, options).value();
  for (const Tet& tet : model.cage.mesh.tets) {
    Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = model.cage.mesh.nodes[tet[k + 1]] - model.cage.mesh.nodes[tet[0]];
    model.inverseEdges.push_back(edges.inverse());
    model.volumes.push_back(std::abs(edges.determinant()) / 6.0);
    model.volume += model.volumes.back();
  }
  model.size = boundingBox(model.cage.mesh.nodes).sizes().maxCoeff();
  return model;
}

const ClaimModel& modelOf(Claim::Shape shape) {
  static std::map<Claim::Shape, ClaimModel> models;
  auto found = models.find(shape);
  if (found == models.end()) found = models.emplace(shape, makeModel(shape)).first;
  return found->second;
}

/// In double precision, by singular values: the solver's own formula would only agree with itself.
double elasticEnergy(const ClaimModel& model, const std::vector<double>& scale, double youngsModulus,
                     const std::vector<Vector3d>& nodes) {
  const double mu = youngsModulus / (2.0 * (1.0 + kPoisson));
  const double lambda = youngsModulus * kPoisson / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));
  double energy = 0.0;
  for (std::size_t t = 0; t < model.volumes.size(); ++t) {
    const Tet& tet = model.cage.mesh.tets[t];
    Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = nodes[tet[k + 1]] - nodes[tet[0]];
    const Matrix3d gradient = edges * model.inverseEdges[t];
    Vector3d strain = Eigen::JacobiSVD<Matrix3d>(gradient).singularValues();
    if (gradient.determinant() < 0.0) strain[2] = -strain[2];
    strain.array() -= 1.0;
    const double stiffness = model.volumes[t] * (scale.empty() ? 1.0 : scale[t]);
    energy += stiffness * (mu * strain.squaredNorm() + 0.5 * lambda * strain.sum() * strain.sum());
  }
  return energy;
}

struct Motion {
  double kinetic = 0.0, elastic = 0.0, height = 0.0, extent = 0.0;
  Vector3d momentum = Vector3d::Zero(), spin = Vector3d::Zero();

  bool finite() const { return std::isfinite(kinetic) && std::isfinite(elastic); }
};

Motion motionOf(const ClaimModel& model, const SoftBodyOptions& options, const btSoftBody& body) {
  Motion motion;
  std::vector<Vector3d> nodes = scenes::nodesOf(body);
  Vector3d centre = Vector3d::Zero();
  double mass = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double m = 1.0 / static_cast<double>(body.m_nodes[static_cast<int>(n)].m_im);
    centre += m * nodes[n];
    mass += m;
  }
  centre /= mass;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[static_cast<int>(n)];
    const double m = 1.0 / static_cast<double>(node.m_im);
    const Vector3d v = toEigen(node.m_v);
    motion.kinetic += 0.5 * m * v.squaredNorm();
    motion.momentum += m * v;
    motion.spin += m * (nodes[n] - centre).cross(v);
    motion.extent = std::max(motion.extent, (nodes[n] - centre).norm());
  }
  motion.height = mass * kGravity * centre.y();
  motion.elastic = elasticEnergy(model, options.stiffnessScale, options.youngsModulus.value(), nodes);
  return motion;
}

void giveVelocities(const Claim& claim, const ClaimModel& model, btSoftBody& body) {
  Vector3d centre = Vector3d::Zero();
  double mass = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double m = 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    centre += m * toEigen(body.m_nodes[n].m_x);
    mass += m;
  }
  centre /= mass;
  const Vector3d drift = claim.event == ClaimEvent::Landing ? Vector3d(0.5, -2.0, 0.0) : Vector3d(0.2, 0.1, -0.1);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    const Vector3d arm = toEigen(node.m_x) - centre;
    node.m_v = node.m_vn = toBullet(model.size * drift + claim.spin * spinAxis().cross(arm));
  }
}

/// The largest distance that a free body reaches from its centre to its farthest node.
double referenceExtent(const Claim& claim, const ClaimModel& model, const SoftBodyOptions& options,
                       const btSoftBody& body) {
  ElasticOptions elastic;
  elastic.youngsModulus = claim.youngsModulus;
  elastic.poissonRatio = kPoisson;
  elastic.stiffnessDamping = claim.damping;
  elastic.stiffnessScale = options.stiffnessScale;
  elastic.tolerance = 1e-6;
  elastic.maxIterations = 2000;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    elastic.nodeMasses.push_back(1.0 / static_cast<double>(body.m_nodes[n].m_im));
  }
  auto reference = ElasticBody<double>::create(model.cage.mesh, elastic).value();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      reference.positions()[static_cast<std::size_t>(n)][k] = static_cast<double>(body.m_nodes[n].m_x[k]);
      reference.velocities()[static_cast<std::size_t>(n)][k] = static_cast<double>(body.m_nodes[n].m_v[k]);
    }
  }
  double extent = 0.0;
  constexpr int kFiner = 16;
  const auto steps = static_cast<int>(std::lround(kSecondsRun / claim.seconds)) * kFiner;
  for (int step = 0; step < steps; ++step) {
    reference.step(claim.seconds / kFiner);
    if (step % kFiner != 0) continue;
    Vector3d centre = Vector3d::Zero();
    for (std::size_t n = 0; n < reference.nodeCount(); ++n) centre += Vector3d::Map(reference.positions()[n]);
    centre /= static_cast<double>(reference.nodeCount());
    for (std::size_t n = 0; n < reference.nodeCount(); ++n) {
      extent = std::max(extent, (Vector3d::Map(reference.positions()[n]) - centre).norm());
    }
  }
  return extent;
}

SoftBodyOptions optionsOf(const Claim& claim, const ClaimModel& model) {
  SoftBodyOptions options;
  options.youngsModulus = claim.youngsModulus;
  options.poissonRatio = kPoisson;
  options.stiffnessDamping = claim.damping;
  options.density = claim.density > 0.0 ? claim.density : 1.0 / model.volume;
  options.solverTolerance = claim.tolerance;
  if (claim.tolerance < 1e-3) options.maxIterations = 2000;
  return options;
}

/// The body of a claim in its world.
class ClaimRun {
 public:
  ClaimRun(const Claim& claim, const ClaimModel& model);

  void start();
  void step();
  /// Returns true if everything is finite.
  bool look();

  const scenes::World& world() const { return world_; }
  const SoftBodyOptions& options() const { return options_; }
  btSoftBody& body() { return body_; }
  double energy() const { return maxEnergy_; }  ///< largest so far, over the initial energy and work
  double stored() const { return maxStored_; }  ///< the same for elastic energy alone
  double lost() const { return lost_; }         ///< the largest relative loss of momentum and angular momentum
  double extent() const { return extent_; }
  double growth() const { return extent_ / began_.extent; }
  double densityTimes(double squaredSpeed) const { return mass_ / model_.volume * squaredSpeed; }

 private:
  const Claim& claim_;
  const ClaimModel& model_;
  bool landing_;
  scenes::World world_;
  SoftBodyOptions options_;
  btSoftBody& body_;
  SoftBodySkin skin_;
  SurfacePoint point_;
  std::unique_ptr<SurfaceSpring> spring_;
  Motion began_;
  double mass_ = 0.0, work_ = 0.0, maxEnergy_ = 0.0, maxStored_ = 0.0, lost_ = 0.0, extent_ = 0.0;
};

ClaimRun::ClaimRun(const Claim& claim, const ClaimModel& model)
    : claim_(claim),
      model_(model),
      landing_(claim.event == ClaimEvent::Landing),
      world_(scenes::Force::Elastic, btVector3(0, landing_ ? btScalar(-kGravity) : btScalar(0), 0)),
      options_(withCageDefaults(model.cage, optionsOf(claim, model))),
      body_(world_.add(model.cage, optionsOf(claim, model))) {
  if (const Status fit = skin_.bind(body_, model.cage, model.mesh).status(); !fit.ok()) {
    throw scenes::InputError(fit.message);
  }
  if (!landing_) return;
  const double floor = boundingBox(model.mesh.positions).min().y() - 0.2 * model.size;
  world_.addBox({0, floor - 0.5, 0}, {20, 0.5, 20});
  world_.touchBySurface(body_, *skin_.binding(), model.mesh);
}

void ClaimRun::start() {
  giveVelocities(claim_, model_, body_);
  began_ = motionOf(model_, options_, body_);
  for (int n = 0; n < body_.m_nodes.size(); ++n) mass_ += 1.0 / static_cast<double>(body_.m_nodes[n].m_im);
  if (claim_.event != ClaimEvent::Dragged) return;
  point_ = SurfaceTree::create(skin_.binding(), model_.mesh).value().pointAtVertex(body_, 0).value();
  spring_ = SurfaceSpring::add(world_.bullet(), point_).value();
  (void)spring_->setTarget(*point_.position() + btVector3(static_cast<btScalar>(model_.size), 0, 0));
}

void ClaimRun::step() {
  const btVector3 before = spring_ ? *point_.position() : btVector3(0, 0, 0);
  world_.step(claim_.seconds);
  if (spring_ && point_.status() == StatusCode::Ok) {
    work_ += static_cast<double>(spring_->force().dot(*point_.position() - before));
  }
}

bool ClaimRun::look() {
  const Motion now = motionOf(model_, options_, body_);
  if (!now.finite()) return false;
  extent_ = std::max(extent_, now.extent);
  const double fallen = landing_ ? began_.height - now.height : 0.0;
  const double chord = 1.0 / std::pow(std::cos(std::min(1.0, 0.5 * claim_.spin * claim_.seconds)), 2);
  const double rounding = kRounding * claim_.youngsModulus * model_.volume * (1.0 + model_.size);
  const double put = chord * (began_.kinetic + began_.elastic + std::max(0.0, work_ + fallen)) + rounding;
  // Contact moves each node by itself to where it does not penetrate the floor. In a stiff body and a long step, this
  // is strain, and work done by the contact. It must not return as motion.
  maxEnergy_ = std::max(maxEnergy_, (now.kinetic + (landing_ ? 0.0 : now.elastic)) / put);
  maxStored_ = std::max(maxStored_, now.elastic / put);
  if (claim_.event != ClaimEvent::Free) return true;
  const double linear = began_.momentum.norm(), angular = std::max(began_.spin.norm(), 0.01 * linear * model_.size);
  lost_ =
      std::max({lost_, (now.momentum - began_.momentum).norm() / linear, (now.spin - began_.spin).norm() / angular});
  return true;
}

}  // namespace

void runClaim(const Claim& claim, Verdict& verdict) {
  const ClaimModel& model = modelOf(claim.shape);
  ClaimRun run(claim, model);
  run.start();
  // The size of a body that is torn by its spin is not limited.
  const double tip = claim.spin * model.size;
  const bool compared = claim.event == ClaimEvent::Free && claim.compared;
  const bool holds = run.densityTimes(tip * tip) < claim.youngsModulus;
  const double reference = compared && holds ? referenceExtent(claim, model, run.options(), run.body())
                                             : std::numeric_limits<double>::infinity();
  const auto steps = static_cast<int>(std::lround(kSecondsRun / claim.seconds));
  const int every = std::max(1, steps / 120);
  verdict.status = toString(StatusCode::Ok);
  for (int step = 1; step <= steps && verdict.simulationFinite; ++step) {
    run.step();
    if (step > 40 && step % every != 0) continue;
    verdict.simulationFinite = run.look();
    verdict.hash = run.world().hashOfNodes(verdict.hash);
  }
  verdict.solve = run.world().solveTotals();
  verdict.extentMax = run.growth();
  verdict.energy = run.energy();
  verdict.energyStored = run.stored();
  verdict.momentumLost = run.lost();
  const double maxDragged = claim.seconds > kLongStep ? kMaxInLongSteps : kMaxDragged;
  const double maximum = claim.event == ClaimEvent::Dragged ? maxDragged : kMaxEnergy;
  verdict.simulationBounded = verdict.simulationFinite && run.energy() <= maximum;
  verdict.expect(verdict.simulationBounded, "its energy never exceeds the initial energy plus the work done on it");
  verdict.expect(run.lost() <= kMaxLost, "linear and angular momentum are conserved");
  verdict.expect(run.extent() <= kMaxSize * reference, "its extent does not exceed that of a fine reference");
}

}  // namespace tetskin::stress
