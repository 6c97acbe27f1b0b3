// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/xpbd_fit.h"

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scenes/statistics.h"
#include "scenes/timer.h"

namespace tetskin::report {
namespace {

/// Exponents of two of the stiffnesses that are tried.
constexpr int kLeastExponent = -4, kMostExponent = 8;
/// The search around the best of these ends with steps of the stiffness of 2^(1/8).
constexpr double kFinestStep = 0.125;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kVolumes[] = {0.0, 1.0, kInfinite};

struct Lame {
  double lambda, mu;
};

Lame lameOf(const scenes::SceneOptions& options) {
  const double young = *options.body.youngsModulus, poisson = options.body.poissonRatio;
  return {young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 + 2.0 * poisson)};
}

double volumeOf(const TetMesh& mesh, const Tet& tet) {
  const Eigen::Vector3d& origin = mesh.nodes[tet[0]];
  return std::abs((mesh.nodes[tet[1]] - origin).cross(mesh.nodes[tet[2]] - origin).dot(mesh.nodes[tet[3]] - origin)) /
         6.0;
}

}  // namespace

XpbdConstants constantsOf(const scenes::SceneOptions& options) {
  const Lame material = lameOf(options);
  // Young's modulus of a lattice is 2.5 times each of its Lame parameters.
  const double stiffness = 2.5 * material.mu / *options.body.youngsModulus;
  return {stiffness, std::max(0.0, 1.0 - material.mu / material.lambda), options.body.stiffnessDamping};
}

XpbdModel::XpbdModel(const scenes::SceneEntry& entry, const Cage& cage, const scenes::SceneOptions& options) {
  const std::unique_ptr<scenes::Scene> scene = entry.make(cage, options);
  body_.gravity = -static_cast<double>(scene->world().bullet().getGravity().y());
  const btSoftBody& body = scene->body();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    body_.nodes.push_back(toEigen(body.m_nodes[n].m_x));
    body_.inverseMasses.push_back(static_cast<double>(body.m_nodes[n].m_im));
  }
  const double young = *options.body.youngsModulus, lambda = lameOf(options).lambda;
  const std::vector<double> scale = withCageDefaults(cage, options.body).stiffnessScale;
  std::map<std::pair<int, int>, double> scaledVolumes;  // by edge
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const Tet& tet = cage.mesh.tets[t];
    const double volume = volumeOf(cage.mesh, tet), factor = scale.empty() ? 1.0 : scale[t];
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) scaledVolumes[std::minmax(tet[i], tet[j])] += volume * factor;
    }
    body_.volumes.push_back({tet, volume / (lambda * factor)});
  }
  for (const auto& [a, b] : uniqueEdges(cage.mesh)) {
    const double stiffness = young * scaledVolumes[std::minmax(a, b)];
    body_.edges.push_back({a, b, (cage.mesh.nodes[a] - cage.mesh.nodes[b]).squaredNorm() / stiffness});
  }
}

measure::XpbdBody XpbdModel::with(const XpbdConstants& constants) const {
  measure::XpbdBody body = body_;
  body.damping = constants.damping;
  for (measure::XpbdBody::Edge& edge : body.edges) edge.compliance /= constants.stiffness;
  for (measure::XpbdBody::Volume& volume : body.volumes) volume.compliance /= constants.volume;
  if (constants.volume == 0.0) body.volumes.clear();
  return body;
}

Simulation simulateXpbd(const measure::XpbdBody& body, const scenes::SceneOptions& options, const FrameDone& done) {
  Simulation result;
  measure::Xpbd xpbd(body);
  const double reach = scenes::kExploded * boundingBox(body.nodes).sizes().maxCoeff();
  std::vector<double> milliseconds;
  result.trajectory.push_back(xpbd.nodes());
  for (int frame = 1; frame <= options.frames; ++frame) {
    const scenes::CpuTimer timer;
    xpbd.step(static_cast<float>(options.frameSeconds), options.substeps);
    milliseconds.push_back(timer.milliseconds());
    std::vector<Eigen::Vector3f> nodes = xpbd.nodes();
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : nodes) {
      result.finite = result.finite && p.allFinite();
      box.extend(p);
    }
    result.finite = result.finite && static_cast<double>(box.sizes().maxCoeff()) < reach;
    if (!result.finite) break;
    result.trajectory.push_back(std::move(nodes));
    done();
  }
  result.milliseconds = scenes::median(std::move(milliseconds));
  return result;
}

XpbdConstants bestConstants(const std::vector<double>& dampings,
                            const std::function<double(const XpbdConstants&)>& errorOf) {
  XpbdConstants best;
  double least = kInfinite;
  const auto consider = [&](const XpbdConstants& constants) {
    const double error = errorOf(constants);
    if (!(error < least)) return;
    least = error;
    best = constants;
  };
  for (const double damping : dampings) {
    for (const double volume : kVolumes) {
      for (int k = kLeastExponent; k <= kMostExponent; ++k) consider({std::exp2(k), volume, damping});
    }
  }
  for (double step = 0.5; step >= kFinestStep; step /= 2.0) {
    const XpbdConstants centre = best;
    for (const double factor : {std::exp2(-step), std::exp2(step)}) {
      consider({centre.stiffness * factor, centre.volume, centre.damping});
      if (centre.volume == 0.0 || centre.volume == kInfinite) continue;
      consider({centre.stiffness, centre.volume * factor * factor, centre.damping});
    }
  }
  return best;
}

}  // namespace tetskin::report
