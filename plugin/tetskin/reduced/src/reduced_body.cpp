// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/reduced/reduced_body.h>
#include <tetskin/reduced/src/bodies/modal_body.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <sstream>

namespace tetskin {

using namespace bullet_detail;

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
    if (bodies[k]->m_reducedModel) continue;
    return invalid("soft body " + std::to_string(k) +
                   " of the world is not a reduced body, but Bullet's reduced solver treats all as such; remove it "
                   "from the world");
  }
  return {};
}

Status checkWorld(btDeformableMultiBodyDynamicsWorld& world) {
  if (world.getForceUpdateAllAabbs()) return {};
  return invalid(
      "call setForceUpdateAllAabbs(true) of the world: without it Bullet does not update the box of a sleeping reduced "
      "body, which then falls");
}

Status checkOptions(const ReducedBodyOptions& options) {
  const auto isSize = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (options.modeCount && *options.modeCount < 1) return invalid("the number of modes must be at least 1");
  if (!isSize(options.density) ||
      (options.mass ? !(*options.mass > 0.0 && isSize(*options.mass)) : options.density == 0.0)) {
    return invalid("the mass of a reduced body, or its density, must be above 0, and both must be finite");
  }
  if (!isSize(options.friction) || (options.margin && !isSize(*options.margin))) {
    return invalid("the friction and margin of a reduced body must be finite and not negative");
  }
  if ((options.youngsModulus && !(*options.youngsModulus > 0.0 && isSize(*options.youngsModulus))) ||
      !isSize(options.stiffnessDamping) || !(options.relativeStiffness > 0.0) || !(options.timeStep > 0.0)) {
    return invalid(
        "the stiffness and time step of a reduced body must be above 0, its damping not negative, and all finite");
  }
  return {};
}

Status checkModes(const VibrationModes& modes) {
  if (modes.modeCount() == 0) return {StatusCode::Empty, "there are no modes; compute them with computeVibrationModes"};
  const bool fits = modes.shapes.size() == modes.modeCount() && modes.masses.size() == modes.nodeCount() &&
                    std::all_of(modes.shapes.begin(), modes.shapes.end(),
                                [&](const auto& shape) { return shape.size() == 3 * modes.nodeCount(); });
  const int nodes = static_cast<int>(modes.nodeCount());
  const bool exist = std::all_of(modes.pinned.begin(), modes.pinned.end(), [&](int n) { return n >= 0 && n < nodes; });
  if (!exist) return {StatusCode::IndexOutOfRange, "the modes have a pinned node that does not exist"};
  if (fits) return {};
  return {StatusCode::SizeMismatch, "the modes have inconsistent numbers of shapes, eigenvalues and masses"};
}

ModalMaterial materialOf(const VibrationModes& modes, const TetMesh& cage, const ReducedBodyOptions& options,
                         double gravity) {
  ModalMaterial material{options.youngsModulus.value_or(0.0), options.density, options.stiffnessDamping};
  if (options.mass) {
    double volume = 0.0;
    for (const double mass : modes.masses) volume += mass;
    material.density = *options.mass / volume;
  }
  if (!options.youngsModulus) {
    constexpr double kEarth = 9.81;  // without gravity nothing sags; the earth's gravity then sets the scale
    material.youngsModulus = options.relativeStiffness * material.density * (gravity > 0.0 ? gravity : kEarth) *
                             boundingBox(cage.nodes).sizes().maxCoeff();
  }
  return material;
}

/// The number of requested modes, and the number of these that are slow enough.
struct Selection {
  std::size_t wanted = 0, slow = 0;
};

Selection select(const std::vector<double>& frequencies, const ReducedBodyOptions& options) {
  const std::size_t all = frequencies.size();
  Selection selection{options.modeCount ? std::min(all, static_cast<std::size_t>(*options.modeCount)) : all, 0};
  while (selection.slow < selection.wanted && frequencies[selection.slow] * options.timeStep <= Limits::kMaxOmegaDt) {
    ++selection.slow;
  }
  return selection;
}

Status checkSelection(const Selection& selection, const std::vector<double>& frequencies,
                      const ReducedBodyOptions& options) {
  if (selection.slow == selection.wanted || (options.skipFastModes && selection.slow > 0)) return {};
  std::ostringstream text;
  text << selection.wanted - selection.slow << " of " << selection.wanted << " modes are too fast for steps of "
       << options.timeStep << " s: from " << frequencies[selection.slow] << " to " << frequencies[selection.wanted - 1]
       << " radians per second, where Bullet's explicit step is stable up to " << Limits::kMaxOmegaDt / options.timeStep
       << "; use shorter steps, a softer material or fewer modes"
       << (options.skipFastModes ? "" : ", or leave them out (skipFastModes)");
  return invalid(text.str());
}

}  // namespace

struct ReducedBody::Impl {
  explicit Impl(btDeformableMultiBodyDynamicsWorld& ofWorld) : world(ofWorld) {}

  btDeformableMultiBodyDynamicsWorld& world;
  btSoftBodySolver* solver =
      nullptr;  ///< the solver of its world: a different one means that the body is in another world
  std::unique_ptr<ModalBody> body;
  ReductionReport report;
  double youngsModulus = 0.0;
};

ReducedBody::ReducedBody(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<ReducedBody>> ReducedBody::add(btDeformableMultiBodyDynamicsWorld& world,
                                                      const VibrationModes& modes, const Cage& cage,
                                                      const ReducedBodyOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  for (Status status :
       {checkWorld(world), checkOthers(world), checkOptions(options), checkModes(modes), validateAttributes(cage)}) {
    if (!status.ok()) return status;
  }
  TetMesh positive = cage.mesh;
  if (Status status = checkCage(cage.mesh, repairTetMesh(positive)); !status.ok()) return status;
  const ModalMaterial material =
      materialOf(modes, cage.mesh, options, static_cast<double>(world.getGravity().length()));
  const std::vector<double> frequencies = modes.frequencies(material.youngsModulus, material.density);
  const Selection selection = select(frequencies, options);
  if (Status status = checkSelection(selection, frequencies, options); !status.ok()) return status;
  const Result<CageModes> ofCage = reduced_detail::modesOfCage(modes, selection.slow, positive, options.nodeTets);
  if (!ofCage.ok()) return ofCage.status();

  std::vector<btVector3> nodes(positive.nodeCount());
  std::transform(positive.nodes.begin(), positive.nodes.end(), nodes.begin(), toBullet);
  auto body = std::make_unique<ModalBody>(world.getWorldInfo(), nodes, !modes.pinned.empty());
  appendElements(positive, *body);
  collideWithRigidBodies(positive, options.margin, options.friction, *body);
  body->begin(ofCage.value(),
              {modes.eigenvalues.begin(), modes.eigenvalues.begin() + static_cast<std::ptrdiff_t>(selection.slow)},
              material);
  body->updateConstants();
  buildTrees(*body);
  body->m_bUpdateRtCst = false;
  body->placeAt(options.placement);
  // Only bodies in a world have access to its solver.
  world.addSoftBody(body.get());
  if (body->getSoftBodySolver()->getSolverType() != btSoftBodySolver::REDUCED_DEFORMABLE_SOLVER) {
    world.removeSoftBody(body.get());
    return invalid("a reduced body needs a world created with a btReducedDeformableBodySolver");
  }

  ReductionReport report{ofCage.value().projectionErrors, selection.wanted - selection.slow, ofCage.value().outside,
                         frequencies[selection.slow - 1], 0.0};
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  auto impl = std::make_unique<Impl>(world);
  impl->solver = body->getSoftBodySolver();
  impl->body = std::move(body);
  impl->report = std::move(report);
  impl->youngsModulus = material.youngsModulus;
  assert(impl->solver && impl->report.projectionErrors.size() == selection.slow);
  return std::unique_ptr<ReducedBody>(new ReducedBody(std::move(impl)));
}

ReducedBody::~ReducedBody() {
  // The body was removed from the world, by the application or by the world's destructor: nothing there needs an update
  // any more.
  if (!impl_->body->getBroadphaseHandle()) return;
  if (impl_->body->getSoftBodySolver() == impl_->solver) {
    impl_->world.removeSoftBody(impl_->body.get());
  } else {
    (void)impl_->body.release();  // another world still contains it
  }
}

btReducedDeformableBody& ReducedBody::body() {
  return *impl_->body;
}
const btReducedDeformableBody& ReducedBody::body() const {
  return *impl_->body;
}
const ReductionReport& ReducedBody::report() const {
  return impl_->report;
}
double ReducedBody::youngsModulus() const {
  return impl_->youngsModulus;
}
std::size_t ReducedBody::modeCount() const {
  return impl_->report.projectionErrors.size();
}
void ReducedBody::setPlacement(const btTransform& placement) {
  impl_->body->placeAt(placement);
}

std::string ReductionReport::describe() const {
  std::ostringstream text;
  text << projectionErrors.size() << " modes, up to " << maxFrequency << " radians per second";
  if (skippedModes > 0) text << "; " << skippedModes << " were left out because they are too fast for the time step";
  if (projectionErrors.empty()) return text.str();
  text << "\nlargest relative error of a mode at the cage's nodes: "
       << *std::max_element(projectionErrors.begin(), projectionErrors.end());
  if (outside > 0) text << "\n" << outside << " nodes of the fine tets lie outside the cage";
  return text.str();
}

}  // namespace tetskin
