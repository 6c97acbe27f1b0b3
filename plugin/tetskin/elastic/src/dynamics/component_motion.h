// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The rigid motion of one component of a body over a step. A component is a set of nodes connected by tets; some may be
// pinned.
//
// Positions move along straight lines, x + dt v. So a body that rotates by dt omega x r swells by (dt omega)^2 / 2 in
// every step, which its stiffness must undo. Therefore the velocities of a rigid motion are taken as the chords of a
// rotation Q: v = (Q - 1) r / dt, and Q is chosen to have the angular momentum of the component,
//   sum m r x Q r = dt L
// which x + dt v keeps: angular momentum is exact, and a component that does not deform is not stretched.
#pragma once

#include <tetskin/core/src/base/state/state_stream.h>

#include <Eigen/Core>

namespace tetskin::elastic_detail {

/// The pinned nodes of a component, world space: none, one node, nodes on a line, or more; and their motion.
class PinnedNodes {
 public:
  enum Kind { Nothing, Point, Line, Fixed };

  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& velocity);
  /// Call it after all nodes have been added.
  void finish(double seconds);

  Kind kind = Nothing;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the centroid
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< of the step: the rotation that best fits the nodes' motion

 private:
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  // Sums over the nodes of x, v, x x^T and v x^T, with x relative to the first one.
  Eigen::Vector3d positions_ = Eigen::Vector3d::Zero(), velocities_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d positionMoments_ = Eigen::Matrix3d::Zero(), velocityMoments_ = Eigen::Matrix3d::Zero();
};

/// Sums over the unpinned nodes of a component, about a point near them. Plain numbers, because they are updated for
/// each node.
struct ComponentMoments {
  double mass = 0.0;
  double first[3] = {}, momentum[3] = {}, spin[3] = {};  ///< sums of m r, m v, m r x v
  double second[6] = {};                                 ///< sum of m r r^T: xx xy xz yy yz zz

  template <class S>
  void add(S nodeMass, const double* point, const S* velocity, const double* about) {
    const auto m = static_cast<double>(nodeMass);
    const double x = point[0] - about[0], y = point[1] - about[1], z = point[2] - about[2];
    const double mx = m * x, my = m * y, mz = m * z;
    const double a = velocity[0], b = velocity[1], c = velocity[2];
    mass += m;
    first[0] += mx, first[1] += my, first[2] += mz;
    momentum[0] += m * a, momentum[1] += m * b, momentum[2] += m * c;
    spin[0] += my * c - mz * b, spin[1] += mz * a - mx * c, spin[2] += mx * b - my * a;
    second[0] += mx * x, second[1] += mx * y, second[2] += mx * z;
    second[3] += my * y, second[4] += my * z, second[5] += mz * z;
  }
};

/// The momentum of the velocities that a solve has found.
struct ComponentMomentum {
  double momentum[3] = {}, spin[3] = {};

  template <class S>
  void add(S nodeMass, const double* point, const double* velocity, const double* about) {
    const auto m = static_cast<double>(nodeMass);
    const double x = point[0] - about[0], y = point[1] - about[1], z = point[2] - about[2];
    const double a = m * velocity[0], b = m * velocity[1], c = m * velocity[2];
    momentum[0] += a, momentum[1] += b, momentum[2] += c;
    spin[0] += y * c - z * b, spin[1] += z * a - x * c, spin[2] += x * b - y * a;
  }
};

/// The velocity field x -> velocity + field (x - about).
struct RigidVelocity {
  double about[3] = {}, velocity[3] = {}, field[9] = {};  ///< `field` is stored by rows

  void at(const double* point, double out[3]) const {
    const double x = point[0] - about[0], y = point[1] - about[1], z = point[2] - about[2];
    for (int i = 0; i < 3; ++i) out[i] = velocity[i] + field[3 * i] * x + field[3 * i + 1] * y + field[3 * i + 2] * z;
  }
  RigidVelocity operator-(const RigidVelocity& other) const;
};

/// The rotation R nearest to a matrix M: the one with the largest tr(R^T M).
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& moments);

/// Maps a velocity of a component, and its rate of rotation about `ComponentMotion::about`, to the change of momentum
/// and angular momentum due to whatever resists them.
using Resistance = Eigen::Matrix<double, 6, 6>;

class ComponentMotion {
 public:
  /// moments  about `near`, a point near the component
  void find(const ComponentMoments& moments, const Eigen::Vector3d& near, const PinnedNodes& pinned, double seconds);

  /// The centre of mass, or the centroid of the pinned nodes.
  const Eigen::Vector3d& about() const { return about_; }
  /// The rotation of the step.
  const Eigen::Matrix3d& turn() const { return turn_; }
  /// The velocities of the rigid motion over the step, as a function of the nodes' positions at its beginning.
  RigidVelocity velocities(double seconds) const;
  /// A point near `about()`, on a grid as wide as the component, so that it seldom changes: positions relative to it
  /// have the most digits, and the same rounding from step to step.
  Eigen::Vector3d anchor() const;
  double mass() const { return mass_; }
  /// The root mean square distance from the centre of mass; 0 without mass.
  double radius() const;
  /// The smallest moment of inertia about an axis through the centre of mass; 0 without mass.
  double minInertia() const;
  /// The change of velocity per unit impulse, both at a point and in a direction, if the component moves as a rigid
  /// body. With pinned nodes, it only rotates about the node or line; 0 if more is pinned.
  double compliance(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

  /// The velocities to subtract from velocities with this momentum, about `about()`, so that the component keeps its
  /// momentum from the beginning of the step: internal forces cannot change it, but an incomplete solve does. They are
  /// a rigid motion of the component at its predicted position, which its stiffness does not resist. With one pinned
  /// node, only the angular momentum about it is corrected; with pinned nodes on a line, that about the line; with
  /// more, nothing.
  /// impulse, torque  of everything else that has acted in the step
  /// held             resistance to these velocities, whose impulses change by them; 0: none. Ignored with pinned nodes
  RigidVelocity excess(const ComponentMomentum& now, const Eigen::Vector3d& impulse, const Eigen::Vector3d& torque,
                       const Resistance& held) const;
  /// Adds the resistance of a point of the component with this stiffness.
  void addResistance(const Eigen::Vector3d& point, const Eigen::Matrix3d& stiffness, Resistance& to) const;

  /// The rigid motion with this momentum, about `about()`, as far as pinned nodes permit.
  RigidVelocity withMomentum(const ComponentMomentum& own) const;
  /// That of its momentum at the beginning of the step.
  RigidVelocity own() const;

  /// The velocities to add if something else has rotated the component: such a rotation is a straight motion, linear in
  /// the nodes' positions, and becomes a chord. Momenta stay the same.
  /// now, moments  of the velocities so far
  RigidVelocity chord(const ComponentMomentum& now, const ComponentMoments& moments, const Eigen::Vector3d& near,
                      double seconds) const;

  /// Moves what the next `find` uses of this one along with a rigid motion.
  void carry(const Eigen::Matrix3d& turn, const Eigen::Vector3d& by) { about_ = (turn * about_ + by).eval(); }
  /// Writes or reads what the next `find` uses of this one.
  void serialize(StateStream& stream) { stream.plain(about_.data(), 3); }

 private:
  void findInverseInertia();
  /// The rigid motion with this momentum about `about_`, of the component after a rotation.
  RigidVelocity rigidWith(const Eigen::Vector3d& momentum, const Eigen::Vector3d& spin,
                          const Eigen::Matrix3d& turn) const;

  PinnedNodes pinned_;
  Eigen::Vector3d about_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  double mass_ = 0.0;
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();  ///< momenta about `about_`
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero(),
                  central_ = second_;  ///< second moments of mass, about `about_` and about the centre
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverseInertia_ =
      Eigen::Matrix3d::Zero();  ///< about `about_`; with pinned nodes, of the rotations that they permit
};

}  // namespace tetskin::elastic_detail
