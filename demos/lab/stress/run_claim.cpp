// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "scenes/files.h"
#include "scenes/placement.h"
#include "scenes/serpent.h"
#include "stress/changed.h"
#include "stress/claim.h"

namespace tetskin::stress {
namespace {

using namespace measure;
using Eigen::Vector3d;

constexpr double kSecondsRun = 1.0;
constexpr double kLongStep = 0.01;
/// E V times this is the elastic energy that rounding of positions appears as.
constexpr double kRounding = sizeof(btScalar) == sizeof(float) ? 1e-11 : 1e-27;

TriangleMesh ellipsoid(const Vector3d& halves) {
  constexpr int kRings = 16, kAround = 20, kLast = 1 + (kRings - 1) * kAround;
  constexpr double kPi = EIGEN_PI;
  const auto at = [&](double a, double b) {
    return Vector3d(halves.cwiseProduct(Vector3d(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b))));
  };
  // The first and the last ring are points.
  const auto vertex = [](int i, int j) {
    return i == 0 ? 0 : i == kRings ? kLast : 1 + (i - 1) * kAround + j % kAround;
  };
  TriangleMesh mesh;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < (i % kRings == 0 ? 1 : kAround); ++j) {
      mesh.positions.push_back(at(kPi * i / kRings, 2.0 * kPi * j / kAround));
    }
  }
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kAround; ++j) {
      if (i > 0) mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)});
      if (i < kRings - 1) mesh.triangles.push_back({vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  }
  return mesh;
}

TriangleMesh serpent() {
  TriangleMesh mesh = scenes::makeSerpent({scenes::kMinSerpentTriangles});
  const Box3 box = boundingBox(mesh.positions);
  for (Vector3d& p : mesh.positions) p = (p - box.center()) / box.sizes().maxCoeff();
  return mesh;
}

TriangleMesh meshOf(Claim::Shape shape) {
  if (shape == Claim::Shape::Serpent) return serpent();
  return ellipsoid(shape == Claim::Shape::Sphere ? Vector3d(0.5, 0.5, 0.5) : Vector3d(0.125, 1.0, 0.175));
}

const ModelPtr& modelOf(Claim::Shape shape) {
  static std::map<Claim::Shape, ModelPtr> models;
  ModelPtr& model = models[shape];
  if (!model) model = inBuiltCage(meshOf(shape), 200);
  return model;
}

SoftBodyOptions materialOf(const Claim& claim) {
  SoftBodyOptions options;
  options.youngsModulus = claim.youngsModulus;
  options.stiffnessDamping = claim.damping;
  options.density = claim.density > 0.0 ? claim.density : 1.0 / totalVolume(modelOf(claim.shape)->cage.mesh);
  options.solverTolerance = claim.tolerance;
  if (claim.tolerance < 1e-3) options.maxIterations = 2000;
  return options;
}

/// The largest distance of these points from a centre.
double reachOf(const std::vector<Vector3d>& points, const Vector3d& centre) {
  double reach = 0.0;
  for (const Vector3d& p : points) raise(reach, (p - centre).norm());
  return reach;
}

/// The largest distance that a free body reaches from its centre to its farthest node.
double referenceExtent(const Claim& claim, const SoftObject& body) {
  const btSoftBody& soft = body.soft();
  ElasticOptions elastic;
  elastic.youngsModulus = claim.youngsModulus;
  elastic.stiffnessDamping = claim.damping;
  elastic.tolerance = 1e-6;
  elastic.maxIterations = 2000;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    elastic.nodeMasses.push_back(1.0 / static_cast<double>(soft.m_nodes[n].m_im));
  }
  auto reference = ElasticBody<double>::create(body.model().cage, elastic).value();
  if (claim.changing) growAndYield(reference, claim.youngsModulus);
  scenes::require(reference.setElasticLaw(claim.law));
  for (std::size_t n = 0; n < reference.nodeCount(); ++n) {
    const btSoftBody::Node& node = soft.m_nodes[static_cast<int>(n)];
    Vector3d::Map(reference.positions()[n]) = toEigen(node.m_x);
    Vector3d::Map(reference.velocities()[n]) = toEigen(node.m_v);
  }
  double extent = 0.0;
  constexpr int kFiner = 16;
  const auto steps = static_cast<int>(std::lround(kSecondsRun / claim.seconds)) * kFiner;
  for (int step = 0; step < steps; ++step) {
    reference.step(claim.seconds / kFiner);
    if (step % kFiner != 0) continue;
    std::vector<Vector3d> nodes(reference.nodeCount());
    Vector3d centre = Vector3d::Zero();
    for (std::size_t n = 0; n < nodes.size(); ++n) centre += nodes[n] = Vector3d::Map(reference.positions()[n]);
    raise(extent, reachOf(nodes, centre / static_cast<double>(nodes.size())));
  }
  return extent;
}

/// Quantities that only external work and impulses may change. Angular momentum is about the centroid.
struct Motion {
  double kinetic = 0.0, elastic = 0.0, height = 0.0, extent = 0.0;
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};

/// stores  whether what it stores is known
Motion motionOf(const SoftObject& body, bool stores) {
  const RigidMotion whole = body.motion();
  Momentum momentum;
  addMomentum(momentum, body.soft());
  return {body.kineticEnergy(),
          stores ? body.elasticEnergy() : 0.0,
          whole.mass * scenes::kEarth * whole.centroid.y(),
          reachOf(scenes::nodesOf(body.soft()), whole.centroid),
          momentum.linear,
          angularMomentumAbout(whole.centroid, body.soft())};
}

/// Enlarges a body about its centre, to the size at which it is at rest once it has grown.
void enlarge(SoftObject& body) {
  const Vector3d centre = body.motion().centroid;
  for (int n = 0; n < body.soft().m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.soft().m_nodes[n];
    node.m_x = node.m_q = toBullet(centre + kGrowth * (toEigen(node.m_x) - centre));
  }
}

/// The body of a claim in its world.
class ClaimRun {
 public:
  ClaimRun(const Claim& claim, Run& run);

  void step();
  /// Returns true if everything is finite.
  bool look();
  /// reference  the extent that the body should have
  void report(Run& run, std::optional<double> reference) const;

  const scenes::World& world() const { return world_.world(); }
  const SoftObject& body() const { return body_; }
  double growth() const { return extent_ / began_.extent; }
  /// True if the body is strong enough for its spin.
  bool holdsTogether() const;

 private:
  const Claim& claim_;
  bool landing_;
  MeasuringWorld world_;
  SoftObject& body_;
  double size_;
  SurfacePoint point_;
  std::unique_ptr<SurfaceSpring> spring_;
  Motion began_;
  double work_ = 0.0, energy_ = 0.0, stored_ = 0.0, lost_ = 0.0, extent_ = 0.0;
};

ClaimRun::ClaimRun(const Claim& claim, Run& run)
    : claim_(claim),
      landing_(claim.event == ClaimEvent::Landing),
      world_(run, Vector3d(0, landing_ ? -scenes::kEarth : 0.0, 0)),
      body_(world_.addSoft(modelOf(claim.shape), materialOf(claim))),
      size_(boundingBox(body_.model().cage.mesh.nodes).sizes().maxCoeff()) {
  const TriangleMesh& mesh = body_.model().mesh;
  if (landing_) {
    world_.addBox({0, boundingBox(mesh.positions).min().y() - 0.2 * size_ - 0.5, 0}, {20, 0.5, 20});
    world_.touchBySurface(body_);
  }
  if (claim.changing) {
    growAndYield(body_.deformable(), claim.youngsModulus);
    enlarge(body_);
  }
  body_.setElasticLaw(claim.law);
  const Vector3d drift = landing_ ? Vector3d(0.5, -2.0, 0.0) : Vector3d(0.2, 0.1, -0.1);
  body_.push(size_ * drift, claim.spin * Vector3d(1.0, 1.0, 0.3).normalized());
  began_ = motionOf(body_, !claim.changing);
  if (claim.event != ClaimEvent::Dragged) return;
  point_ = SurfaceTree::create(body_.model().binding, mesh).value().pointAtVertex(body_.soft(), 0).value();
  spring_ = SurfaceSpring::add(world_.bullet(), point_).value();
  (void)spring_->setTarget(*point_.position() + btVector3(static_cast<btScalar>(size_), 0, 0));
}

bool ClaimRun::holdsTogether() const {
  const double tip = claim_.spin * size_, density = body_.motion().mass / totalVolume(body_.model().cage.mesh);
  return density * tip * tip < (claim_.changing ? kYieldStrain : 1.0) * claim_.youngsModulus;
}

void ClaimRun::step() {
  const btVector3 before = spring_ ? *point_.position() : btVector3(0, 0, 0);
  world_.step(claim_.seconds);
  if (spring_ && point_.status() == StatusCode::Ok) {
    work_ += static_cast<double>(spring_->force().dot(*point_.position() - before));
  }
}

bool ClaimRun::look() {
  const Motion now = motionOf(body_, !claim_.changing);
  raise(extent_, now.extent);
  const double fallen = landing_ ? began_.height - now.height : 0.0;
  const double chord = 1.0 / std::pow(std::cos(std::min(1.0, 0.5 * claim_.spin * claim_.seconds)), 2);
  const double rounding = kRounding * claim_.youngsModulus * totalVolume(body_.model().cage.mesh) * (1.0 + size_);
  const double put = chord * (began_.kinetic + began_.elastic + std::max(0.0, work_ + fallen)) + rounding;
  // Contact moves each node separately to a position where it does not penetrate the floor. In a stiff body and a long
  // step, this is strain, and work done by the contact. It must not return as motion.
  raise(energy_, (now.kinetic + (landing_ ? 0.0 : now.elastic)) / put);
  raise(stored_, now.elastic / put);
  if (claim_.event == ClaimEvent::Free) {
    const double linear = began_.linear.norm(), angular = std::max(began_.angular.norm(), 0.01 * linear * size_);
    raise(lost_, (now.linear - began_.linear).norm() / linear);
    raise(lost_, (now.angular - began_.angular).norm() / angular);
  }
  return std::isfinite(now.kinetic + now.elastic);
}

void ClaimRun::report(Run& run, std::optional<double> reference) const {
  run.report("energy", energy_);
  run.report("elastic energy", stored_);
  run.report("momentum lost", lost_);
  run.report("extent over its start", growth());
  if (reference) run.report("extent over a fine reference's", extent_ / *reference);
}

/// The name by which promises are found.
std::string sceneOf(const Claim& claim) {
  const bool isLong = claim.event == ClaimEvent::Dragged && claim.seconds > kLongStep;
  return isLong ? "claim/dragged in long steps" : "claim/" + nameOf(claim);
}

}  // namespace

void runClaim(const Claim& claim, Run& run) {
  ClaimRun body(claim, run);
  // The size of a body that is torn by its spin is not limited.
  const bool compared = claim.event == ClaimEvent::Free && claim.compared && body.holdsTogether();
  const auto reference = compared ? std::optional(referenceExtent(claim, body.body())) : std::nullopt;
  const auto steps = static_cast<int>(std::lround(kSecondsRun / claim.seconds));
  const int every = std::max(1, steps / 120);
  bool finite = true;
  run.hash = scenes::kNoHash;
  for (int step = 1; step <= steps && finite; ++step) {
    body.step();
    if (step > 40 && step % every != 0) continue;
    finite = body.look();
    run.hash = body.world().hashOfNodes(run.hash);
  }
  run.status = toString(finite ? StatusCode::Ok : StatusCode::NonFinite);
  run.promised = sceneOf(claim);
  body.report(run, reference);
  run.report("steps that did not converge", body.world().solveTotals().unconverged);
}

}  // namespace tetskin::stress
