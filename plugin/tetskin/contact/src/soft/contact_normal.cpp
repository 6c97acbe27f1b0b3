// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/contact_normal.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// Cosine between the normals of two surfaces below which they can touch, for a sample on an edge, and for one on a
/// face.
constexpr btScalar kOpposingCosine = btScalar(-0.3), kFaceOpposingCosine = btScalar(-0.8);
/// By how much that cosine may be larger for a sample that has touched: otherwise a light part that one such contact
/// holds comes and goes with it.
constexpr btScalar kKeptCosine = btScalar(0.15);
/// Depth, in cubes of the grid, beyond which a sample is a contact even if the normals are as if its surface slid along
/// the other one, unless they agree.
constexpr btScalar kPiercingCubes = btScalar(0.2);
/// Cosine between normals from which on they agree. The overlaps of `tetskin_measure` hold with 0.95 and with -1, too.
constexpr btScalar kAgreeingCosine = btScalar(0.3);

/// All deep samples leave in one direction, since pushing each to its nearest surface would tear the body. Where bodies
/// coincide, their surfaces do, too. Returns whether the sample is deep.
bool leaveTogether(const PairDirection& pair, const btVector3& own, Touch& touch) {
  if (agree(own, touch.normal)) touch.distance = std::min(touch.distance, -2 * pair.deep);
  const bool deep = touch.distance < -pair.deep;
  if (deep) touch.normal = pair.apart;
  return deep;
}

/// True if a less deep sample would hold back the deep ones.
bool holdsBack(const PairDirection& pair, const Touch& touch) {
  return touch.distance < 0 && touch.normal.dot(pair.apart) < -kOpposingCosine;
}

/// The cosine between normals below which the surfaces touch.
btScalar touchingCosine(const SampleSurface& sample, bool deep, bool pierces) {
  if (pierces) return kAgreeingCosine;
  const btScalar opposing = sample.onFace && !deep ? kFaceOpposingCosine : kOpposingCosine;
  return opposing + (sample.touched ? kKeptCosine : btScalar(0));
}

}  // namespace

bool agree(const btVector3& first, const btVector3& second) {
  return first.dot(second) > kAgreeingCosine;
}

/// In this order: bodies that overlap are parted first, whatever their surfaces are like there, as normals say nothing
/// where one body is within another. A sample whose own normal is not known touches. All others touch where the
/// surfaces face each other: one that slides along another does not catch on its edges by the sides of its own. What
/// pierces is deeper than sliding leads, so that for it, any normals do that do not agree.
bool chooseNormal(const PairDirection& pair, const SampleSurface& sample, Touch& touch) {
  assert(pair.cube > 0 && pair.deep >= 0 && !touch.pierces);
  const bool overlaps = !pair.apart.isZero();
  const bool deep = overlaps && leaveTogether(pair, sample.normal, touch);
  if (overlaps && holdsBack(pair, touch)) return false;
  if (sample.normal.isZero()) return true;
  touch.pierces = !overlaps && (sample.pierced || touch.distance < -kPiercingCubes * pair.cube);
  return sample.normal.dot(touch.normal) < touchingCosine(sample, deep, touch.pierces);
}

}  // namespace tetskin::contact_detail
