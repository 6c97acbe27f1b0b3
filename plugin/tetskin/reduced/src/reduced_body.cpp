// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <tetskin/bullet/src/shared/bodies/body_elements.h>
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/reduced/reduced_body.h>
#include <tetskin/reduced/src/bodies/modal_body.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

namespace tetskin {
namespace {

using reduced_detail::CageModes;
using reduced_detail::ModalBody;
using reduced_detail::ModalMaterial;

Status invalid(std::string message) {
  return {StatusCode::InvalidOption, std::move(message)};
}

Status checkOthers(btDeformableMultiBodyDynamicsWorld& world) {
  const btSoftBodyArray& bodies = world.getSoftBodyArray();
  for (int k = 0; k < bodies.size(); ++k) {
    if (dynamic_cast<btReducedDeformableBody*>(bodies[k])) continue;
    return invalid("soft body " + std::to_string(k) +
                   " of the world is not reduced, and Bullet's reduced solver takes every one for that: take it out");
  }
  return {};
}

Status checkWorld(btDeformableMultiBodyDynamicsWorld& world) {
  if (world.getForceUpdateAllAabbs()) return {};
  return invalid("a sleeping reduced body falls where Bullet does not ask for its box: setForceUpdateAllAabbs(true)");
}

Status checkOptions(const ReducedBodyOptions& options) {
  const auto isSize = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (options.modes < 0) return invalid("a reduced body cannot have less than no modes; 0 takes all");
  if (!isSize(options.density) || !isSize(options.mass) || (options.density == 0.0 && options.mass == 0.0)) {
    return invalid("a reduced body needs a mass above 0, or a density above 0, and both finite");
  }
  if (!isSize(options.friction) || std::isnan(options.margin)) {
    return invalid("a reduced body's friction must not be negative, nor its margin NaN");
  }
  if (!isSize(options.youngsModulus) || !isSize(options.damping) || !(options.relativeStiffness > 0.0) ||
      !(options.timeStep > 0.0)) {
    return invalid(
        "a reduced body's stiffness and damping must not be negative, and finite, and its time step must be above 0");
  }
  return {};
}

Status checkModes(const VibrationModes& modes) {
  if (modes.modeCount() == 0) return {StatusCode::Empty, "there are no modes: see vibrationModes"};
  const bool fits = modes.shapes.size() == modes.modeCount() && modes.masses.size() == modes.nodeCount() &&
                    std::all_of(modes.shapes.begin(), modes.shapes.end(),
                                [&](const auto& shape) { return shape.size() == 3 * modes.nodeCount(); });
  const int nodes = static_cast<int>(modes.nodeCount());
  const bool exist = std::all_of(modes.pinned.begin(), modes.pinned.end(), [&](int n) { return n >= 0 && n < nodes; });
  if (!exist) return {StatusCode::IndexOutOfRange, "the modes name a pinned node that they do not have"};
  if (fits) return {};
  return {StatusCode::SizeMismatch, "the modes' shapes, eigenvalues and masses are not as many as they must be"};
}

ModalMaterial materialOf(const VibrationModes& modes, const TetMesh& cage, const ReducedBodyOptions& options,
                         double gravity) {
  ModalMaterial material{options.youngsModulus, options.density, options.damping};
  if (options.mass > 0.0) {
    double volume = 0.0;
    for (const double mass : modes.masses) volume += mass;
    material.density = options.mass / volume;
  }
  if (material.youngsModulus == 0.0) {
    constexpr double kEarth = 9.81;  // without gravity nothing sags; the earth's serves as a scale
    material.youngsModulus = options.relativeStiffness * material.density * (gravity > 0.0 ? gravity : kEarth) *
                             boundingBox(cage.nodes).sizes().maxCoeff();
  }
  return material;
}

/// How many of the modes are asked for, and how many of these are slow enough.
struct Selection {
  std::size_t wanted = 0, slow = 0;
};

Selection select(const std::vector<double>& frequencies, const ReducedBodyOptions& options) {
  const std::size_t all = frequencies.size();
  Selection selection{options.modes > 0 ? std::min(all, static_cast<std::size_t>(options.modes)) : all, 0};
  while (selection.slow < selection.wanted && frequencies[selection.slow] * options.timeStep <= kMostOmegaDt) {
    ++selection.slow;
  }
  return selection;
}

Status checkSelection(const Selection& selection, const std::vector<double>& frequencies,
                      const ReducedBodyOptions& options) {
  if (selection.slow == selection.wanted || (options.leaveOutFastModes && selection.slow > 0)) return {};
  std::ostringstream text;
  text << selection.wanted - selection.slow << " of " << selection.wanted << " modes are too fast for steps of "
       << options.timeStep << " s: from " << frequencies[selection.slow] << " to " << frequencies[selection.wanted - 1]
       << " radians a second, where Bullet's explicit step bears " << kMostOmegaDt / options.timeStep
       << "; take shorter steps, a softer material or fewer modes"
       << (options.leaveOutFastModes ? "" : ", or leave them out (leaveOutFastModes)");
  return invalid(text.str());
}

}  // namespace

struct ReducedBody::Parts {
  explicit Parts(btDeformableMultiBodyDynamicsWorld& ofWorld) : world(ofWorld) {}

  btDeformableMultiBodyDynamicsWorld& world;
  btSoftBodySolver* solver = nullptr;  ///< the world's: another one, and the body is in another world
  std::unique_ptr<ModalBody> body;
  ReductionReport report;
  double youngsModulus = 0.0;
};

ReducedBody::ReducedBody(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<ReducedBody>> ReducedBody::add(btDeformableMultiBodyDynamicsWorld& world,
                                                      const VibrationModes& modes, const Cage& cage,
                                                      const ReducedBodyOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  for (Status status :
       {checkWorld(world), checkOthers(world), checkOptions(options), checkModes(modes), cage.check()}) {
    if (!status.ok()) return status;
  }
  TetMesh positive = cage;
  if (Status status = checkCage(cage, repairTetMesh(positive)); !status.ok()) return status;
  const ModalMaterial material = materialOf(modes, cage, options, static_cast<double>(world.getGravity().length()));
  const std::vector<double> frequencies = modes.frequencies(material.youngsModulus, material.density);
  const Selection selection = select(frequencies, options);
  if (Status status = checkSelection(selection, frequencies, options); !status.ok()) return status;
  const Result<CageModes> ofCage = reduced_detail::modesOfCage(modes, selection.slow, positive, options.nodeTets);
  if (!ofCage.ok()) return ofCage.status();

  std::vector<btVector3> nodes(positive.nodeCount());
  std::transform(positive.nodes.begin(), positive.nodes.end(), nodes.begin(), toBullet);
  auto body = std::make_unique<ModalBody>(world.getWorldInfo(), nodes, !modes.pinned.empty());
  appendElements(positive, *body);
  meetRigidBodies(positive, options.margin, options.friction, *body);
  body->begin(ofCage.value(),
              {modes.eigenvalues.begin(), modes.eigenvalues.begin() + static_cast<std::ptrdiff_t>(selection.slow)},
              material);
  body->updateConstants();
  buildTrees(*body);
  body->m_bUpdateRtCst = false;
  body->placeAt(options.placement);
  // Only bodies in a world know its solver.
  world.addSoftBody(body.get());
  if (!dynamic_cast<btReducedDeformableBodySolver*>(body->getSoftBodySolver())) {
    world.removeSoftBody(body.get());
    return invalid("a reduced body needs a world that is made with a btReducedDeformableBodySolver");
  }

  ReductionReport report{ofCage.value().projectionErrors, selection.wanted - selection.slow, ofCage.value().outside,
                         frequencies[selection.slow - 1], 0.0};
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  auto parts = std::make_unique<Parts>(world);
  parts->solver = body->getSoftBodySolver();
  parts->body = std::move(body);
  parts->report = std::move(report);
  parts->youngsModulus = material.youngsModulus;
  return std::unique_ptr<ReducedBody>(new ReducedBody(std::move(parts)));
}

ReducedBody::~ReducedBody() {
  // Taken out of the world, by the application or by the world's own end: nothing there may be left to be told.
  if (!parts_->body->getBroadphaseHandle()) return;
  if (parts_->body->getSoftBodySolver() == parts_->solver) {
    parts_->world.removeSoftBody(parts_->body.get());
  } else {
    (void)parts_->body.release();  // in another world, which has it still
  }
}

btReducedDeformableBody& ReducedBody::body() {
  return *parts_->body;
}
const btReducedDeformableBody& ReducedBody::body() const {
  return *parts_->body;
}
const ReductionReport& ReducedBody::report() const {
  return parts_->report;
}
double ReducedBody::youngsModulus() const {
  return parts_->youngsModulus;
}
std::size_t ReducedBody::modeCount() const {
  return parts_->report.projectionErrors.size();
}
void ReducedBody::placeAt(const btTransform& placement) {
  parts_->body->placeAt(placement);
}

std::string ReductionReport::describe() const {
  std::ostringstream text;
  text << projectionErrors.size() << " modes, up to " << fastest << " radians a second";
  if (leftOut > 0) text << "; " << leftOut << " were left out, too fast for the time step";
  if (projectionErrors.empty()) return text.str();
  text << "\nthe cage's nodes tell them to " << *std::max_element(projectionErrors.begin(), projectionErrors.end())
       << " of themselves, or better";
  if (outside > 0) text << "\n" << outside << " nodes of the fine tets lie outside of the cage";
  return text.str();
}

}  // namespace tetskin
