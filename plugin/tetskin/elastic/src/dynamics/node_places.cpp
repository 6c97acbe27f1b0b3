// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/component_motion.h>
#include <tetskin/elastic/src/dynamics/node_places.h>

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::elastic_detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Roundings of a position up to which a node counts as moved with the whole body: Bullet computes such a position with
/// some products and sums.
constexpr double kRoundings = 3.0;

/// The product, normalised. Eigen's has other bits on other processors.
Eigen::Quaterniond turned(const Eigen::Quaterniond& by, const Eigen::Quaterniond& q) {
  const double w = by.w() * q.w() - by.x() * q.x() - by.y() * q.y() - by.z() * q.z();
  const double x = by.w() * q.x() + by.x() * q.w() + by.y() * q.z() - by.z() * q.y();
  const double y = by.w() * q.y() + by.y() * q.w() + by.z() * q.x() - by.x() * q.z();
  const double z = by.w() * q.z() + by.z() * q.w() + by.x() * q.y() - by.y() * q.x();
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  if (!(length > 0.0 && std::isfinite(length))) return Eigen::Quaterniond::Identity();
  return {w / length, x / length, y / length, z / length};
}

/// The rotation by a small vector, to second order, not normalised.
Eigen::Quaterniond smallRotation(const Vector3d& angle) {
  return {1.0, 0.5 * angle.x(), 0.5 * angle.y(), 0.5 * angle.z()};
}

}  // namespace

template <class S>
NodePlaces<S>::NodePlaces(const std::vector<Vector3d>& rest, const std::vector<std::uint32_t>& slotOf,
                          const std::vector<std::uint32_t>& partOf, std::size_t parts)
    : slotOf_(slotOf), partOf_(partOf), parts_(parts), frames_(parts) {
  assert(rest.empty() || rest.size() == slotOf.size());
  places_.assign(3 * partOf.size(), 0.0);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) places_[3 * slotOf[n] + k] = rest[n][static_cast<Eigen::Index>(k)];
  }
  if (!rest.empty()) rest_ = places_;
  findParts();
  publish();
}

template <class S>
void NodePlaces<S>::findParts() {
  std::vector<double> counts(parts_.size(), 0.0);
  for (const std::uint32_t slot : slotOf_) {
    Part& part = parts_[partOf_[slot]];
    if (counts[partOf_[slot]]++ == 0.0) part.first = slot;
    if (hasFrames()) part.centroid += restAt(slot);
  }
  if (!hasFrames()) return;
  for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].centroid /= std::max(counts[k], 1.0);
  std::vector<Matrix3d> second(parts_.size(), Matrix3d::Zero());
  for (const std::uint32_t slot : slotOf_) {
    const Vector3d arm = restAt(slot) - parts_[partOf_[slot]].centroid;
    second[partOf_[slot]] += arm * arm.transpose();
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Matrix3d inertia = second[k].trace() * Matrix3d::Identity() - second[k];
    parts_[k].inverseInertia = inertia.inverse();
    if (!parts_[k].inverseInertia.allFinite()) parts_[k].inverseInertia.setZero();  // a single node
  }
}

template <class S>
void NodePlaces<S>::publish() {
  quaternions_.resize(4 * frames_.size());
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const Eigen::Quaterniond& q = frames_[k].turn;
    S* to = &quaternions_[4 * k];
    to[0] = static_cast<S>(q.w()), to[1] = static_cast<S>(q.x());
    to[2] = static_cast<S>(q.y()), to[3] = static_cast<S>(q.z());
  }
}

// ---- positions

template <class S>
bool NodePlaces<S>::isAt(std::size_t slot, const S* point, S near) const {
  S own[3];
  round(slot, own);
  const double* x = at(slot);
  for (std::size_t k = 0; k < 3; ++k) {
    if (point[k] == own[k]) continue;
    const double rounding = std::abs(static_cast<double>(own[k]) - x[k]);
    if (!(std::abs(static_cast<double>(point[k]) - x[k]) <= rounding + static_cast<double>(near))) return false;
  }
  return true;
}

template <class S>
void NodePlaces<S>::take(const AlignedVector<S>& points) {
  std::size_t moved = 0;
  for (const std::uint32_t slot : slotOf_) moved += !isAt(slot, &points[4 * slot], S(0));
  if (moved == 0) return;
  if (2 * moved > slotOf_.size() && takeRigid(points)) return;
  for (const std::uint32_t slot : slotOf_) {
    if (isAt(slot, &points[4 * slot], S(0))) continue;
    for (std::size_t k = 0; k < 3; ++k) places_[3 * slot + k] = static_cast<double>(points[4 * slot + k]);
  }
}

/// Tries a translation first, which leaves directions unchanged.
template <class S>
bool NodePlaces<S>::takeRigid(const AlignedVector<S>& points) {
  const auto given = [&](std::size_t slot) {
    const S* x = &points[4 * slot];
    return Vector3d(static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2]));
  };
  Vector3d before = Vector3d::Zero(), after = before;
  double size = 0.0;
  for (const std::uint32_t slot : slotOf_) {
    before += placeAt(slot);
    after += given(slot);
    size = std::max({size, placeAt(slot).cwiseAbs().maxCoeff(), given(slot).cwiseAbs().maxCoeff()});
  }
  before /= static_cast<double>(slotOf_.size());
  after /= static_cast<double>(slotOf_.size());
  const double rounding = kRoundings * static_cast<double>(std::numeric_limits<S>::epsilon()) * size;
  const auto fits = [&](const Matrix3d& turn) {
    return std::all_of(slotOf_.begin(), slotOf_.end(), [&](std::uint32_t slot) {
      return (after + turn * (placeAt(slot) - before) - given(slot)).cwiseAbs().maxCoeff() <= rounding;
    });
  };
  Matrix3d turn = Matrix3d::Identity();
  if (!fits(turn)) {
    Matrix3d moments = Matrix3d::Zero();
    for (const std::uint32_t slot : slotOf_) moments += (given(slot) - after) * (placeAt(slot) - before).transpose();
    if (!moments.allFinite()) return false;
    turn = nearestRotation(moments);
    if (!fits(turn)) return false;
  }
  for (const std::uint32_t slot : slotOf_) {
    const Vector3d now = after + turn * (placeAt(slot) - before);
    std::copy_n(now.data(), 3, &places_[3 * slot]);
  }
  if (!turn.isIdentity(0.0)) turnFrames(std::vector<Matrix3d>(frames_.size(), turn));
  return true;
}

// ---- displacements

/// If displacements come from a frame that is behind by a rotation, these sums give it: in the frame's own directions,
/// sum a x u over sum a x (w x a), with a from the centroid.
/// sum a x u over sum a x (w x a), with a from the centroid.
template <class S>
void NodePlaces<S>::displace(const std::vector<Vector3d>& anchors, AlignedVector<S>& displacements) {
  assert(anchors.size() == frames_.size() && displacements.size() == 4 * partOf_.size());
  largest_ = 0.0;
  if (!hasFrames()) {
    for (const std::uint32_t slot : slotOf_) {
      const Vector3d u = placeAt(slot) - anchors[partOf_[slot]];
      largest_ = std::max(largest_, u.cwiseAbs().maxCoeff());
      for (std::size_t k = 0; k < 3; ++k) displacements[4 * slot + k] = static_cast<S>(u[static_cast<Eigen::Index>(k)]);
    }
    return;
  }
  struct Placed {
    Matrix3d rotation;
    Vector3d origin, displaced = Vector3d::Zero();
    Matrix3d moments = Matrix3d::Zero();
  };
  std::vector<Placed> placed(frames_.size());
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    Frame& frame = frames_[k];
    frame.turn = turned(smallRotation(frame.lag), frame.turn);
    placed[k].rotation = frame.turn.toRotationMatrix();
    placed[k].origin = placeAt(parts_[k].first) - placed[k].rotation * restAt(parts_[k].first);
  }
  for (const std::uint32_t slot : slotOf_) {
    const std::uint32_t part = partOf_[slot];
    Placed& frame = placed[part];
    const Vector3d arm = frame.rotation * restAt(slot), u = placeAt(slot) - (frame.origin + arm);
    largest_ = std::max(largest_, u.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < 3; ++k) displacements[4 * slot + k] = static_cast<S>(u[static_cast<Eigen::Index>(k)]);
    frame.displaced += u;
    frame.moments += arm * u.transpose();
  }
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    Frame& frame = frames_[k];
    const Matrix3d& rotation = placed[k].rotation;
    const Matrix3d m = placed[k].moments - (rotation * parts_[k].centroid) * placed[k].displaced.transpose();
    const Vector3d moment(m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0));
    frame.lag = rotation * (parts_[k].inverseInertia * (rotation.transpose() * moment));
    if (!frame.lag.allFinite()) frame.lag.setZero();
  }
}

/// Positions that are still the nodes' own get all of their digits.
template <class S>
void NodePlaces<S>::displacePoints(AlignedVector<S>& points) const {
  assert(points.size() == 4 * partOf_.size());
  const auto exact = [&](std::size_t slot) {
    const S* x = &points[4 * slot];
    if (isAt(slot, x, S(0))) return Vector3d(placeAt(slot));
    return Vector3d(static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2]));
  };
  const auto armOf = [&](std::size_t slot) {
    return hasFrames() ? Vector3d(frames_[partOf_[slot]].turn * restAt(slot)) : Vector3d(Vector3d::Zero());
  };
  std::vector<Vector3d> origins;
  for (const Part& part : parts_) origins.push_back(exact(part.first) - armOf(part.first));
  for (const std::uint32_t slot : slotOf_) {
    const Vector3d u = exact(slot) - origins[partOf_[slot]] - armOf(slot);
    for (std::size_t k = 0; k < 3; ++k) points[4 * slot + k] = static_cast<S>(u[static_cast<Eigen::Index>(k)]);
  }
}

template <class S>
template <class T>
void NodePlaces<S>::fromDisplacement(std::size_t slot, const S* displacement, T* position) const {
  Vector3d arm = Vector3d::Zero();
  if (hasFrames()) arm = frames_[partOf_[slot]].turn * (restAt(slot) - parts_[partOf_[slot]].centroid);
  for (std::size_t k = 0; k < 3; ++k) {
    position[k] = static_cast<T>(arm[static_cast<Eigen::Index>(k)]) + static_cast<T>(displacement[k]);
  }
}

template <class S>
void NodePlaces<S>::turnFrames(const std::vector<Matrix3d>& turns) {
  assert(turns.size() == frames_.size());
  if (!hasFrames()) return;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    Frame& frame = frames_[k];
    frame.turn = turned(Eigen::Quaterniond(turns[k]), frame.turn);
    frame.lag = turns[k] * frame.lag;
  }
  publish();
}

template <class S>
void NodePlaces<S>::carry(bool turns, const Matrix3d& turn, const Vector3d& by) {
  for (const std::uint32_t slot : slotOf_) {
    const Vector3d x = placeAt(slot), now = (turns ? Vector3d(turn * x) : x) + by;
    std::copy_n(now.data(), 3, &places_[3 * slot]);
  }
  if (turns) turnFrames(std::vector<Matrix3d>(frames_.size(), turn));
}

template <class S>
void NodePlaces<S>::serialize(StateStream& stream) {
  stream.plain(places_.data(), places_.size());
  for (Frame& frame : frames_) {
    stream.plain(frame.turn.coeffs().data(), 4);
    stream.plain(frame.lag.data(), 3);
  }
  if (stream.restoring()) publish();
}

TETSKIN_INSTANTIATE_CLASS(NodePlaces)
template void NodePlaces<float>::fromDisplacement<float>(std::size_t, const float*, float*) const;
template void NodePlaces<float>::fromDisplacement<double>(std::size_t, const float*, double*) const;
template void NodePlaces<double>::fromDisplacement<double>(std::size_t, const double*, double*) const;

}  // namespace tetskin::elastic_detail
