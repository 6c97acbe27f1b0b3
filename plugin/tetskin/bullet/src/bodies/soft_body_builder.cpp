// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/body_elements.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/positive_values.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// Smallest mass of a node relative to the mean: lighter nodes explode on cages with slivers.
constexpr double kMinNodeMass = 0.3;
/// Default margin relative to the largest side of the cage's box. Bullet's own default is 0.25, whatever the size.
constexpr double kMarginFraction = 0.02;
/// With Bullet's default of one pass over the links, a body of thousands of tets collapses.
constexpr int kMassSpringIterations = 8;

Status checkOptions(const SoftBodyOptions& options) {
  const auto finite = [](double value) { return std::isfinite(static_cast<btScalar>(value)); };
  const auto positive = [&](double value) { return value > 0.0 && finite(value); };
  if (options.mass ? !positive(*options.mass) || !(options.density >= 0.0) : !positive(options.density)) {
    return {StatusCode::InvalidOption,
            "the mass of a soft body, or its density, must be above 0, and both must be finite"};
  }
  if (!(options.friction >= 0.0 && options.friction <= 1.0))
    return {StatusCode::InvalidOption, "friction: that of a soft body must be from 0 to 1"};
  if (!(options.restitution >= 0.0 && options.restitution <= 1.0))
    return {StatusCode::InvalidOption, "restitution: that of a soft body must be from 0 to 1"};
  if (options.margin && !(*options.margin >= 0.0 && finite(*options.margin)))
    return {StatusCode::InvalidOption, "margin: that of a soft body must be finite, and not negative"};
  if ((options.youngsModulus && !positive(*options.youngsModulus)) || !(options.relativeStiffness > 0.0) ||
      !(options.stiffnessDamping >= 0.0) || !(options.timeStep > 0.0) || !finite(options.relativeStiffness) ||
      !finite(options.stiffnessDamping) || !finite(options.timeStep)) {
    return {StatusCode::InvalidOption,
            "the stiffness and time step of a soft body must be above 0, its damping not negative, and all finite"};
  }
  if (!(options.poissonRatio >= 0.0 && options.poissonRatio < 0.5)) {
    return {StatusCode::InvalidOption, "a soft body's Poisson ratio must be at least 0 and below 0.5"};
  }
  if (!(options.solverTolerance >= 0.0 && options.solverTolerance < 1.0) || options.maxIterations < 1) {
    return {StatusCode::InvalidOption,
            "a soft body's solver tolerance must be at least 0 and below 1, and its iterations at least 1"};
  }
  switch (options.forceModel) {
    case ForceModel::Corotated:
    case ForceModel::NeoHookean:
    case ForceModel::LinearElasticity:
    case ForceModel::MassSpring:
      break;
    default:
      return {StatusCode::InvalidOption, "unknown force model; choose one of ForceModel"};
  }
  if (!options.stiffnessScale.empty() && options.forceModel == ForceModel::MassSpring) {
    return {StatusCode::InvalidOption,
            "mass-spring bodies do not support a stiffness per tet (stiffnessScale); leave it empty, or choose another "
            "ForceModel"};
  }
  if (!(options.linkStiffness > 0.0 && options.linkStiffness <= 1.0)) {
    return {StatusCode::InvalidOption, "a soft body's link stiffness must be above 0 and at most 1"};
  }
  return {};
}

btSoftBody::TetraScratch restScratch() {
  btSoftBody::TetraScratch scratch;
  scratch.m_F.setIdentity();
  scratch.m_cofF.setIdentity();
  scratch.m_corotation.setIdentity();
  scratch.m_trace = 3;
  scratch.m_J = 1;
  return scratch;
}

std::vector<double> massesOf(const TetMesh& cage, const SoftBodyOptions& options) {
  if (!options.nodeMasses.empty()) return options.nodeMasses;
  return lumpedMasses(cage, options.mass ? *options.mass : options.density * totalVolume(cage));
}

void setMasses(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses,
               btSoftBody& body) {
  assert(masses.size() == cage.nodeCount() && masses.size() == static_cast<std::size_t>(body.m_nodes.size()));
  for (std::size_t n = 0; n < masses.size(); ++n) {
    const bool pinned = options.pinned && options.pinned(cage.nodes[n]);
    body.setMass(static_cast<int>(n), pinned ? btScalar(0) : static_cast<btScalar>(masses[n]));
  }
}

/// Multiplies the tets' measures by the stiffness factors: Bullet's forces are proportional to a tet's measure.
void scaleMeasures(const std::vector<double>& scale, btSoftBody& body) {
  assert(scale.empty() || scale.size() == static_cast<std::size_t>(body.m_tetras.size()));
  for (std::size_t t = 0; t < scale.size(); ++t) {
    body.m_tetras[static_cast<int>(t)].m_element_measure *= static_cast<btScalar>(scale[t]);
  }
}

void configure(const TetMesh& cage, const SoftBodyOptions& options, btSoftBody& body) {
  collideWithRigidBodies(cage, options.margin, options.friction, body);
  body.setRestitution(static_cast<btScalar>(options.restitution));
  if (options.forceModel == ForceModel::MassSpring) {
    body.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    body.m_cfg.piterations = kMassSpringIterations;
    body.m_materials[0]->m_kLST = static_cast<btScalar>(options.linkStiffness);
  }
}

/// Rejects a cage so far from the origin that, in the precision of positions, its tets have no volume or, for Bullet's
/// forces, which read their shapes from positions, another volume.
Status checkPlace(const TetMesh& cage, const std::vector<btVector3>& nodes, ForceModel model) {
  const double left = model == ForceModel::Corotated ? 0.0 : 0.5;  // of a volume
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    TetCorners rounded;
    for (std::size_t k = 0; k < 4; ++k) rounded[k] = toEigen(nodes[static_cast<std::size_t>(cage.tets[t][k])]);
    const double volume = signedVolume(cornersOf(cage, cage.tets[t])), found = signedVolume(rounded);
    if ((model == ForceModel::Corotated ? std::abs(found) : found) > left * volume) continue;
    char text[200];
    std::snprintf(text, sizeof text,
                  "tet %zu is flat or inside out when positions %.3g from the origin are rounded to Bullet's numbers: "
                  "create the body nearer to the origin, or build Bullet in double precision",
                  t, rounded[0].cwiseAbs().maxCoeff());
    return {StatusCode::Degenerate, text};
  }
  return {};
}

/// Rejects masses whose products with any practical lengths and times exceed the range of Bullet's numbers.
Status checkMass(double mass) {
  const double heaviest = sizeof(btScalar) == sizeof(double) ? 1e100 : 1e15;
  if (mass <= heaviest && mass >= 1 / heaviest) return {};
  char text[160];
  std::snprintf(text, sizeof text, "a body of mass %.3g is beyond %.0g to %.0g: choose another unit of mass", mass,
                1 / heaviest, heaviest);
  return {StatusCode::InvalidOption, text};
}

/// Does what Bullet would do in the first step, but with our trees.
void finish(const SoftBodyOptions& options, BodyWithTrees& body) {
  body.updateConstants();
  body.makeTrees(options.faceTree);
  body.m_bUpdateRtCst = false;
}

}  // namespace

Status bullet_detail::checkCage(const TetMesh& cage, const TetMeshReport& report) {
  if (Status status = validate(cage, report); !status.ok()) return status;
  const TetMeshReport::Fault& flat = report.zeroVolume.count > 0 ? report.zeroVolume : report.repeatedNode;
  if (flat.count == 0) return {};
  return {StatusCode::Degenerate, std::to_string(report.zeroVolume.count + report.repeatedNode.count) +
                                      " tets of the cage are flat, the first of them tet " +
                                      std::to_string(flat.first) + "; Bullet divides by their volume, so remove them"};
}

void bullet_detail::appendElements(const TetMesh& cage, btSoftBody& body) {
  assert(static_cast<std::size_t>(body.m_nodes.size()) == cage.nodeCount() && body.m_tetras.size() == 0);
  for (const Tet& t : cage.tets) body.appendTetra(t[0], t[1], t[2], t[3]);
  // Bullet's own function searches linearly for an existing link; these edges are already distinct.
  for (const auto& e : uniqueEdges(cage)) body.appendLink(e[0], e[1], nullptr, false);
  for (const auto& f : boundaryFaces(cage)) body.appendFace(f[0], f[1], f[2]);
  body.initializeDmInverse();
  body.m_tetraScratches.resize(body.m_tetras.size(), restScratch());
  body.m_tetraScratchesTn.resize(body.m_tetras.size(), restScratch());
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].index = i;
}

void bullet_detail::collideWithRigidBodies(const TetMesh& cage, std::optional<double> margin, double friction,
                                           btSoftBody& body) {
  const double size = boundingBox(cage.nodes).sizes().maxCoeff();
  body.getCollisionShape()->setMargin(static_cast<btScalar>(margin.value_or(kMarginFraction * size)));
  body.m_cfg.kDF = static_cast<btScalar>(friction);
  body.m_cfg.kCHR = 1;  // hard contacts with rigid and with kinematic bodies
  body.m_cfg.kKHR = 1;
  body.m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
}

void setMass(btSoftBody& body, int node, btScalar mass) {
  assert(node >= 0 && node < body.m_nodes.size());
  body.setMass(node, mass);
  updateConstants(body);
}

void setTotalMass(btSoftBody& body, btScalar mass, bool fromFaces) {
  body.setTotalMass(mass, fromFaces);
  updateConstants(body);
}

std::vector<double> lumpedMasses(const TetMesh& cage, double totalMass) {
  std::vector<double> masses(cage.nodeCount(), 0.0);
  double sum = 0.0;
  for (const Tet& t : cage.tets) {
    const double quarter = std::abs(signedVolume(cornersOf(cage, t))) / 4.0;
    for (const int n : t) masses[n] += quarter;
    sum += 4.0 * quarter;
  }
  const double lightest = kMinNodeMass * sum / static_cast<double>(cage.nodeCount());
  for (double& m : masses) m = std::max(m, lightest);
  const double scale = totalMass / std::accumulate(masses.begin(), masses.end(), 0.0);
  for (double& m : masses) m *= scale;
  return masses;
}

SoftBodyOptions withCageDefaults(const Cage& cage, SoftBodyOptions options) {
  if (options.nodeMasses.empty() && !cage.masses.empty()) {
    const double volume = std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
    const double density = options.mass ? *options.mass / volume : options.density;
    for (const double mass : cage.masses) options.nodeMasses.push_back(density * mass);
  }
  if (options.stiffnessScale.empty() && options.forceModel != ForceModel::MassSpring) {
    options.stiffnessScale = cage.stiffnessScale();
  }
  return options;
}

Result<BuiltBody> bullet_detail::buildBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo,
                                           const SoftBodyOptions& options) {
  if (Status status = checkOptions(options); !status.ok()) return status;
  TetMesh positive = cage.mesh;
  if (Status status = checkCage(cage.mesh, repairTetMesh(positive)); !status.ok()) return status;
  for (Status status :
       {checkPositive<btScalar>(options.nodeMasses, cage.mesh.nodeCount(), "nodeMasses", "node"),
        checkPositive<btScalar>(options.stiffnessScale, cage.mesh.tetCount(), "stiffnessScale", "tet")}) {
    if (!status.ok()) return status;
  }

  std::vector<btVector3> nodes(positive.nodeCount());
  std::transform(positive.nodes.begin(), positive.nodes.end(), nodes.begin(), toBullet);
  std::vector<double> masses = massesOf(positive, options);
  for (const Status& status : {checkPlace(positive, nodes, options.forceModel),
                               checkMass(std::accumulate(masses.begin(), masses.end(), 0.0))}) {
    if (!status.ok()) return status;
  }
  auto body = std::make_unique<BodyWithTrees>(worldInfo, nodes);
  configure(positive, options, *body);
  appendElements(positive, *body);
  setMasses(positive, options, masses, *body);
  if (options.forceModel != ForceModel::Corotated) scaleMeasures(options.stiffnessScale, *body);
  finish(options, *body);
  return BuiltBody{std::move(body), std::move(masses)};
}

Result<std::unique_ptr<btSoftBody>> createSoftBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo,
                                                   const SoftBodyOptions& options) {
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  Result<BuiltBody> built = buildBody(cage, worldInfo, withCageDefaults(cage, options));
  if (!built.ok()) return built.status();
  return std::move(built.value().body);
}

}  // namespace tetskin
