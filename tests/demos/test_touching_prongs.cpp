// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact between limbs that a cage keeps apart by duplicate elements: they lie in tets at the same position.

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/core/embedding.h>

#include "scenes/slotted_beam.h"
#include "scenes/world.h"
#include "support/component_models.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kRoot = -0.4;  ///< end of the slot, along the beam

/// The beam in a cage with duplicate elements.
struct Models {
  TriangleMesh mesh = makeSlottedBeam(6000);
  Cage cage;
  std::vector<VertexBinding> bindings;
  std::shared_ptr<const ContactShape> shape;
  Vector3d along = slottedBeamPlane().normal(), across = Vector3d::UnitZ().cross(along);

  Models() {
    CageOptions options;
    options.targetTets = 2000;  // with fewer, the prongs would not stay apart
    cage = createCage(mesh, options).value();
    EXPECT_EQ(test::countComponentsBeyond(cage.mesh, test::Plane(along, 0.6 * along)), 2);
    bindings = embed(cage, mesh).value().bindings();
    shape = ContactShape::create(cage, mesh).value();
  }
};

const Models& models() {
  static const Models made;
  return made;
}

class TouchingProngs : public testing::Test {
 protected:
  TouchingProngs() : world_(scenes::Force::Elastic, btVector3(0, 0, 0)) {
    SoftBodyOptions options = scenes::oneKilogram();
    options.youngsModulus = 2e3;
    options.pinned = [](const Vector3d& p) { return p.dot(models().along) < kRoot - 0.3; };
    beam_ = &world_.add(models().cage, options);
    contacts_ = SoftContacts::add(static_cast<btDeformableMultiBodyDynamicsWorld&>(world_.bullet())).value();
  }
  void step(int frames) {
    for (int k = 0; k < 4 * frames; ++k) world_.step(1.0 / 240);
  }
  Vector3d surfacePoint(std::size_t vertex) const {
    const VertexBinding& b = models().bindings[vertex];
    Vector3d p = Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
      p += static_cast<double>(b.weights[k]) * toEigen(beam_->m_nodes[models().cage.mesh.tets[b.tet][k]].m_x);
    }
    return p;
  }

  /// By node: on which side of the slot it lies, beyond the slot's end; 0 elsewhere.
  static const std::vector<double>& sides() {
    static const std::vector<double> made = [] {
      const Models& m = models();
      std::vector<double> side(m.cage.mesh.nodeCount(), 0.0);
      for (const VertexBinding& b : m.bindings) {
        Vector3d p = Vector3d::Zero();
        for (int k = 0; k < 4; ++k)
          p += static_cast<double>(b.weights[k]) * m.cage.mesh.nodes[m.cage.mesh.tets[b.tet][k]];
        for (const int n : m.cage.mesh.tets[b.tet]) side[n] += p.dot(m.across);
      }
      for (std::size_t n = 0; n < side.size(); ++n) {
        if ((m.cage.mesh.nodes[n] - kRoot * m.along).dot(m.along) < 0.0) side[n] = 0.0;
      }
      return side;
    }();
    return made;
  }
  /// Puts the prongs at rest, with velocities towards each other that grow with the distance from the slot's end.
  void restAndThrow() {
    for (std::size_t n = 0; n < sides().size(); ++n) {
      btSoftBody::Node& node = beam_->m_nodes[static_cast<int>(n)];
      const Vector3d& at = models().cage.mesh.nodes[n];
      const double direction = std::max(0.0, (at - kRoot * models().along).dot(models().along));
      const double side = sides()[n] > 0.0 ? 1.0 : sides()[n] < 0.0 ? -1.0 : 0.0;
      node.m_x = node.m_q = toBullet(at);
      node.m_v = node.m_vn = toBullet(-3.0 * side * direction * models().across);
    }
  }
  /// The gap between the prongs' inner faces near their ends: 0.04 at rest, below 0 where they have passed through each
  /// other.
  double gapAtTheTips() const {
    const Models& m = models();
    double gap[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
    for (std::size_t v = 0; v < m.mesh.vertexCount(); ++v) {
      const Vector3d& rest = m.mesh.positions[v];
      const double across = rest.dot(m.across);
      if (rest.dot(m.along) < 1.5 || std::abs(across) > 0.03) continue;
      gap[across > 0.0] += surfacePoint(v).dot(m.across);
      count[across > 0.0] += 1.0;
    }
    EXPECT_GT(std::min(count[0], count[1]), 0.0);
    return gap[1] / count[1] - gap[0] / count[0];
  }

  World world_;
  btSoftBody* beam_;
  std::unique_ptr<SoftContacts> contacts_;
};

/// The prongs are 0.04 apart at rest.
TEST_F(TouchingProngs, MeetEachOther) {
  double crossed[2];
  for (const bool collides : {false, true}) {
    if (collides) {
      ASSERT_TRUE(contacts_->add(*beam_, models().shape, true).ok());
    }
    restAndThrow();
    double minimum = HUGE_VAL;
    for (int k = 0; k < 40; ++k) {
      step(1);
      minimum = std::min(minimum, gapAtTheTips());
    }
    crossed[collides] = -minimum;
  }
  EXPECT_GT(crossed[false], 0.25);
  EXPECT_LT(crossed[true], 0.12);
}

/// They do not touch although each of them lies, all along, in duplicates of the other's tets.
TEST_F(TouchingProngs, DoNotTouchEachOtherAtRest) {
  ASSERT_TRUE(contacts_->add(*beam_, models().shape, true).ok());
  step(10);
  EXPECT_TRUE(contacts_->contacts().empty());
  for (int n = 0; n < beam_->m_nodes.size(); ++n) {
    EXPECT_LT((toEigen(beam_->m_nodes[n].m_x) - models().cage.mesh.nodes[static_cast<std::size_t>(n)]).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace tetskin::scenes
