// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The rigid motion of one part of a body over a step: nodes that tets connect, of which some may be held.
//
// Positions are moved along straight lines, x + dt v. A body that turns by dt omega x r swells so by (dt omega)^2 / 2
// in every step, which its stiffness has to take back. So the velocities of a rigid motion are taken as the chords of a
// rotation Q: v = (Q - 1) r / dt, and Q is the one that has the angular momentum of the part,
//   sum m r x Q r = dt L
// which is what x + dt v keeps: angular momentum is exact, and a part that does not deform is not stretched.
#pragma once

#include <Eigen/Core>

namespace tetskin::elastic_detail {

/// What is held of a part, world space: nothing, a node, nodes on a line, or more; and how that moves.
class HeldNodes {
 public:
  enum Kind { Nothing, Point, Line, Fixed };

  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& velocity);
  /// Once all are added.
  void finish(double seconds);

  Kind kind = Nothing;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the centre
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< over the step, as closely as a rotation follows them

 private:
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  Eigen::Vector3d places_ = Eigen::Vector3d::Zero(), velocities_ = Eigen::Vector3d::Zero();  ///< sums
  Eigen::Matrix3d placesByPlaces_ = Eigen::Matrix3d::Zero(), velocitiesByPlaces_ = Eigen::Matrix3d::Zero();
};

/// Sums over the nodes of a part that are not held, about a point near them. Plain numbers: it is filled for each node.
struct PartMoments {
  double mass = 0.0;
  double first[3] = {}, momentum[3] = {}, spin[3] = {};  ///< m r, m v, m r x v
  double second[6] = {};                                 ///< m r r^T: xx xy xz yy yz zz

  template <class S>
  void add(S nodeMass, const S* point, const S* velocity, const double* about) {
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

/// Of the velocities that a solve has left: what momentum they have.
struct PartMomentum {
  double momentum[3] = {}, spin[3] = {};

  template <class S>
  void add(S nodeMass, const S* point, const double* velocity, const double* about) {
    const auto m = static_cast<double>(nodeMass);
    const double x = point[0] - about[0], y = point[1] - about[1], z = point[2] - about[2];
    const double a = m * velocity[0], b = m * velocity[1], c = m * velocity[2];
    momentum[0] += a, momentum[1] += b, momentum[2] += c;
    spin[0] += y * c - z * b, spin[1] += z * a - x * c, spin[2] += x * b - y * a;
  }
};

/// x -> velocity + field (x - about)
struct RigidVelocity {
  double about[3] = {}, velocity[3] = {}, field[9] = {};  ///< field by rows

  template <class S>
  void at(const S* point, double out[3]) const {
    const double x = point[0] - about[0], y = point[1] - about[1], z = point[2] - about[2];
    for (int i = 0; i < 3; ++i) out[i] = velocity[i] + field[3 * i] * x + field[3 * i + 1] * y + field[3 * i + 2] * z;
  }
  RigidVelocity operator-(const RigidVelocity& other) const;
};

class PartMotion {
 public:
  /// moments  about `near`, a point near the part
  void find(const PartMoments& moments, const Eigen::Vector3d& near, const HeldNodes& held, double seconds);

  /// The centre of mass, or of what is held.
  const Eigen::Vector3d& about() const { return about_; }
  /// The velocities of the rigid motion over the step, by where nodes are at its beginning.
  RigidVelocity velocities(double seconds) const;
  /// Near `about()`, on a grid as wide as the part, so that it seldom changes: beside it positions have as many digits
  /// as they can, and from step to step the same.
  Eigen::Vector3d anchor() const;
  /// From the origin to about the farthest node.
  double reach() const;
  /// The least moment of inertia about an axis through the centre of mass; 0 where there is no mass.
  double leastInertia() const;
  /// By how much a unit impulse at a point changes the velocity there, both in a direction, as far as the part moves as
  /// one: of what is held, about a node or a line; 0 where more is.
  double compliance(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

  /// What must be taken from velocities that have this momentum, about `about()`, for them to have what the part had at
  /// the step's beginning: internal forces cannot change it, but a solve that is cut short does. A rigid motion of the
  /// part as it has been moved, which its stiffness does not resist. Of what is held: about a node the angular momentum
  /// alone, about a line that along it, else nothing.
  /// impulse, torque  what else has acted on it in the step
  RigidVelocity excess(const PartMomentum& now, const Eigen::Vector3d& impulse, const Eigen::Vector3d& torque) const;

  /// The rigid motion with this momentum, about `about()`, as far as the part is not held.
  RigidVelocity withMomentum(const PartMomentum& own) const;

  /// What must be added to velocities in which something else has turned the part: the turn is a straight motion, in
  /// proportion to where nodes are, and becomes a chord. Momenta stay.
  /// now, moments  of these velocities
  RigidVelocity chord(const PartMomentum& now, const PartMoments& moments, const Eigen::Vector3d& near,
                      double seconds) const;

 private:
  void findInverseInertia();
  /// With this momentum about `about_`, of the part as a rotation has turned it.
  RigidVelocity rigidWith(const Eigen::Vector3d& momentum, const Eigen::Vector3d& spin,
                          const Eigen::Matrix3d& turn) const;

  HeldNodes held_;
  Eigen::Vector3d about_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  double mass_ = 0.0;
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();  ///< about `about_`
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero(), central_ = second_;  ///< of mass, about `about_` and its centre
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverseInertia_ = Eigen::Matrix3d::Zero();  ///< about `about_`; of what can turn about a point
};

}  // namespace tetskin::elastic_detail
