// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Fingers that a cage keeps apart come apart when they are pulled, about as far as those of the body itself.

#include <tetskin/bullet/deformable_body.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/elastic/calibration.h>

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <limits>
#include <map>

#include "scenes/hand.h"
#include "scenes/world.h"
#include "support/component_models.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;
/// The vertices at the tip of each finger, from one side of the hand to the other.
using Tips = std::vector<std::vector<int>>;

Tips tipsOf(const TriangleMesh& mesh, const TetMesh& tets, const std::vector<VertexBinding>& bindings) {
  constexpr double kTip = 0.06;
  const test::Plane plane = handPlane();
  const std::vector<int> fingerOf = test::componentsBeyond(tets, plane);
  std::map<int, double> reach;
  const auto fingerAt = [&](std::size_t v) { return fingerOf[bindings[v].tet]; };
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    if (fingerAt(v) < 0) continue;
    reach[fingerAt(v)] = std::max(reach[fingerAt(v)], plane.signedDistance(mesh.positions[v]));
  }
  std::map<int, std::vector<int>> tips;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const int finger = fingerAt(v);
    if (finger >= 0 && plane.signedDistance(mesh.positions[v]) > reach[finger] - kTip) {
      tips[finger].push_back(static_cast<int>(v));
    }
  }
  Tips sorted;
  for (auto& [finger, vertices] : tips) sorted.push_back(vertices);
  const auto x = [&](const std::vector<int>& tip) { return mesh.positions[tip.front()].x(); };
  std::sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) { return x(a) < x(b); });
  return sorted;
}

/// A hand pinned at its wrist, with two of its fingers pulled at their tips.
class PulledHand {
 public:
  PulledHand(const Cage& cage, const TriangleMesh& mesh)
      : cage_(cage), bindings_(embed(cage, mesh).value().bindings()), world_(Force::Elastic, btVector3(0, 0, 0)) {
    constexpr double kPinned = 0.15;
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : mesh.positions) lowest = std::min(lowest, p.y());
    SoftBodyOptions options;
    options.youngsModulus = 2000.0;
    options.density = 1.0;
    options.stiffnessDamping = 0.3;
    options.solverTolerance = 1e-6;
    options.maxIterations = 1000;
    options.pinned = [=](const Vector3d& p) { return p.y() < lowest + kPinned; };
    body_ = &world_.add(cage, options);
  }

  /// The increase of the distance between two tips.
  double partBy(const std::vector<int>& one, const std::vector<int>& other) {
    constexpr double kPull = 0.005, kStep = 1.0 / 60;
    constexpr int kSteps = 180;
    const Vector3d direction = positionOf(other) - positionOf(one);
    for (int k = 0; k < kSteps; ++k) {
      pull(one, -kPull * kStep * direction.normalized());
      pull(other, kPull * kStep * direction.normalized());
      world_.step(kStep);
    }
    return (positionOf(other) - positionOf(one)).norm() - direction.norm();
  }

 private:
  btSoftBody::Node& node(int vertex, int corner) {
    return body_->m_nodes[cage_.mesh.tets[bindings_[vertex].tet][corner]];
  }

  void pull(const std::vector<int>& tip, const Vector3d& impulse) {
    for (const int v : tip) {
      for (int k = 0; k < 4; ++k) {
        const double fraction = node(v, k).m_im * bindings_[v].weights[k] / static_cast<double>(tip.size());
        node(v, k).m_v += btVector3(btScalar(fraction * impulse.x()), btScalar(fraction * impulse.y()),
                                    btScalar(fraction * impulse.z()));
      }
    }
  }

  Vector3d positionOf(const std::vector<int>& tip) {
    Vector3d sum = Vector3d::Zero();
    for (const int v : tip) {
      for (int k = 0; k < 4; ++k) {
        const btVector3& x = node(v, k).m_x;
        sum += bindings_[v].weights[k] / static_cast<double>(tip.size()) * Vector3d(x.x(), x.y(), x.z());
      }
    }
    return sum;
  }

  const Cage& cage_;
  std::vector<VertexBinding> bindings_;
  World world_;
  btSoftBody* body_ = nullptr;
};

Cage calibratedCage(const TriangleMesh& mesh, bool split) {
  CageOptions options;
  options.targetTets = 3000;
  options.duplicateElements = split;
  Cage cage = createCage(mesh, options).value();
  EXPECT_TRUE(calibrate(cage).ok());
  return cage;
}

/// The reference: tets that fill the hand and share only the palm, with reduced stiffness because such tets are too
/// stiff as well.
TEST(PulledFingers, ComeApartAsThoseOfTheBodyDo) {
  const TriangleMesh mesh = makeHand(20000);
  Cage reference(makeHandTets(kMinHandTets));
  ASSERT_TRUE(calibrate(reference).ok());
  const Cage split = calibratedCage(mesh, true), whole = calibratedCage(mesh, false);
  const Tips tips = tipsOf(mesh, reference.mesh, embed(reference, mesh).value().bindings());
  ASSERT_EQ(tips.size(), 5u);
  for (std::size_t k = 0; k + 1 < tips.size(); ++k) {
    const double wanted = PulledHand(reference, mesh).partBy(tips[k], tips[k + 1]);
    const double ratio = PulledHand(split, mesh).partBy(tips[k], tips[k + 1]) / wanted;
    EXPECT_GT(ratio, 0.9) << "fingers " << k << " and " << k + 1;
    EXPECT_LT(ratio, 1.4) << "fingers " << k << " and " << k + 1;
    EXPECT_LT(PulledHand(whole, mesh).partBy(tips[k], tips[k + 1]), 0.1 * wanted);
  }
}

}  // namespace
}  // namespace tetskin::scenes
