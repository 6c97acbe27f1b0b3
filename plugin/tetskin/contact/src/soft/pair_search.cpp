// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_search.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// Positions of a sample that are nearer to each other at rest than this many mean edges are one, found on the face
/// between two tets.
constexpr btScalar kOnePlace = btScalar(0.3);
/// For contacts of a body with itself, in cubes of the grid: a sample whose rest position, as a tet maps it, differs
/// from its own by less than this is where it belongs, and does not touch there.
constexpr btScalar kOwnPlaceCubes = btScalar(1.5);
/// Relative motion of the bodies up to which candidates stay complete: that of this many steps, in cubes of the grid
/// bounded as given.
constexpr btScalar kSlackSteps = 8, kSlackCubes = 1, kMaxSlackCubes = 4;
/// In cubes of the grid: how much deeper another sample of a node must be than one that touched before.
constexpr btScalar kKeptCubes = btScalar(0.1);
/// Cosine between normals from which on two contacts of a node count as one.
constexpr btScalar kOneWay = btScalar(0.7);
/// Cosine between the normals of two surfaces below which they can touch, for a sample on an edge, and for one on a
/// face.
constexpr btScalar kOpposing = btScalar(-0.3), kOpposingOnFaces = btScalar(-0.8);
/// Depth, in cubes of the grid, beyond which a sample is a contact even if the normals are as if its surface slid along
/// the other one, unless the normals agree by this cosine.
constexpr btScalar kPiercingCubes = btScalar(0.2), kAgreeing = btScalar(0.3);
/// Length of the gradient from which on the sample is on no edge.
constexpr btScalar kOnFace = btScalar(0.9);
/// A side that is farther away at rest than this many mean edges belongs to another part.
constexpr btScalar kOneSide = 1;

/// Maps a covector from rest space to the world, by the gradients of a deformed tet's weights.
btVector3 carriedGradient(const ShapeData& data, int tet, const DeformedTet& deformed, const btVector3& gradient) {
  assert(!deformed.flat);
  const Tet& n = data.tets[static_cast<std::size_t>(tet)];
  const btVector3& origin = data.nodes[static_cast<std::size_t>(n[3])];
  btVector3 carried(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    carried += gradient.dot(data.nodes[static_cast<std::size_t>(n[k])] - origin) * deformed.rows[k];
  }
  return carried;
}

btVector3 restPoint(const ShapeData& data, int tet, const btScalar weights[4]) {
  const Tet& n = data.tets[static_cast<std::size_t>(tet)];
  btVector3 p(0, 0, 0);
  for (std::size_t k = 0; k < 4; ++k) p += weights[k] * data.nodes[static_cast<std::size_t>(n[k])];
  return p;
}

/// The distance between two boxes; 0 or below if they overlap.
btScalar gapBetween(const ContactBox& a, const ContactBox& b) {
  btScalar gap = -BT_LARGE_FLOAT;
  for (int axis = 0; axis < 3; ++axis) {
    gap = std::max({gap, a.low[axis] - b.high[axis], b.low[axis] - a.high[axis]});
  }
  return gap;
}

bool contains(const std::vector<int>& ascending, int sample) {
  return std::binary_search(ascending.begin(), ascending.end(), sample);
}

Clearance outside(btScalar gap) {
  Clearance clear;
  clear.outside = static_cast<double>(gap);
  return clear;
}
Clearance away(btScalar distance) {
  Clearance clear;
  clear.distance = static_cast<double>(distance);
  return clear;
}
Clearance atSurface() {
  return away(0);
}

}  // namespace

Overlap PairSearch::find(ContactBody& first, ContactBody& second, btScalar reach, btScalar dt, const btVector3& apart,
                         btScalar deep, PairMemory& memory, std::vector<Touch>& touches) {
  assert(reach > 0 && dt > 0 && deep >= 0);
  now_ = {&first, &second, reach, dt, apart, deep, &memory.sides};
  overlap_ = {};
  touches_ = &touches;
  touchOfNode_.assign(first.data().nodes.size(), -1);
  memory.sides.beginStep();
  touched_.swap(memory.touched);
  pierced_.swap(memory.pierced);
  const btScalar cube = second.data().grid.spacing();
  memory.candidates.advance(first, second);
  const btScalar slack =
      std::min(std::max(kSlackCubes * cube, kSlackSteps * memory.candidates.moved()), kMaxSlackCubes * cube);
  if (!memory.candidates.hold()) memory.candidates.find(first, second, slack);
  memory.candidates.visit(
      reach, [&](int run) { beginRun(run); }, [&](int tet) { return testTet(tet); }, [&](int run) { touchRun(run); });
  remember(memory);
  return overlap_;
}

/// A node that touches nothing in this step keeps the sample with which it touched before.
void PairSearch::remember(PairMemory& memory) const {
  memory.touched.clear();
  memory.pierced.clear();
  const std::vector<int>& nodes = now_.first->data().sampleNodes;
  for (const int sample : touched_) {
    const int node = nodes[static_cast<std::size_t>(sample)];
    if (touchOfNode_[static_cast<std::size_t>(node)] < 0) memory.touched.push_back(sample);
  }
  for (const Touch& touch : *touches_) {
    memory.touched.push_back(touch.sample);
    if (touch.pierces) memory.pierced.push_back(touch.sample);
  }
  for (std::vector<int>* samples : {&memory.touched, &memory.pierced}) std::sort(samples->begin(), samples->end());
}

void PairSearch::beginRun(int run) {
  run_ = now_.first->data().runs[static_cast<std::size_t>(run)];
  assert(run_.first < run_.last);
  around_ = now_.first->carry(run);
  const auto count = static_cast<std::size_t>(run_.last - run_.first);
  inside_.resize(count);
  heads_.assign(count, -1);
  positions_.clear();
}

void PairSearch::touchRun(int run) {
  for (std::size_t k = 0; k < heads_.size(); ++k) {
    for (int p = heads_[k]; p >= 0; p = positions_[static_cast<std::size_t>(p)].next) {
      touch(run_.first + static_cast<int>(k), run, positions_[static_cast<std::size_t>(p)]);
    }
  }
}

/// Tests the samples of the run.
Clearance PairSearch::testTet(int tet) {
  if (const btScalar gap = gapBetween(around_, now_.second->around(tet)); gap > 0) return outside(gap);
  const DeformedTet& deformed = now_.second->deformed(tet);
  if (deformed.flat) return outside(0);
  if (const btScalar gap = gapTo(around_, deformed); gap > 0) return outside(gap);
  const btVector3 &o = deformed.origin, &a = deformed.rows[0], &b = deformed.rows[1], &c = deformed.rows[2];
  const btScalar *xs = &now_.first->samples[0][static_cast<std::size_t>(run_.first)],
                 *ys = &now_.first->samples[1][static_cast<std::size_t>(run_.first)],
                 *zs = &now_.first->samples[2][static_cast<std::size_t>(run_.first)];
  const int count = run_.last - run_.first;
  for (int k = 0; k < count; ++k) {
    const btScalar x = xs[k] - o.x(), y = ys[k] - o.y(), z = zs[k] - o.z();
    const btScalar w0 = a.x() * x + a.y() * y + a.z() * z;
    const btScalar w1 = b.x() * x + b.y() * y + b.z() * z;
    const btScalar w2 = c.x() * x + c.y() * y + c.z() * z;
    inside_[static_cast<std::size_t>(k)] = std::min(std::min(w0, w1), std::min(w2, 1 - w0 - w1 - w2));
  }
  Clearance clear;
  btScalar maximum = -BT_LARGE_FLOAT;
  for (int k = 0; k < count; ++k) {
    const btScalar weight = inside_[static_cast<std::size_t>(k)];
    if (weight >= kMinWeight) {
      clear.cut(offer(tet, run_.first + k, k));
    } else {
      maximum = std::max(maximum, weight);
    }
  }
  clear.cut(outside((kMinWeight - maximum) / deformed.steepest));
  return clear;
}

/// Skips positions that are already known from a neighbouring tet.
Clearance PairSearch::offer(int tet, int sample, int k) {
  assert(k >= 0 && static_cast<std::size_t>(k) < heads_.size());
  const ShapeData& data = now_.second->data();
  const DeformedTet& deformed = now_.second->deformed(tet);
  SamplePosition position;
  deformed.weightsAt(now_.first->sampleAt(sample), position.weights);
  if (!data.carried.empty() && !data.carried[static_cast<std::size_t>(tet)].holds(position.weights)) return atSurface();
  position.rest = restPoint(data, tet, position.weights);
  if (now_.first == now_.second) {
    const btScalar own = kOwnPlaceCubes * data.grid.spacing();
    const btScalar moved = (position.rest - data.sampleRest[static_cast<std::size_t>(sample)]).length();
    if (moved < own) return outside((own - moved) / deformed.restPerWorld);
  }
  int& head = heads_[static_cast<std::size_t>(k)];
  const btScalar apart = kOnePlace * data.edge;
  for (int p = head; p >= 0; p = positions_[static_cast<std::size_t>(p)].next) {
    if ((positions_[static_cast<std::size_t>(p)].rest - position.rest).length2() < apart * apart) return atSurface();
  }
  if (!data.grid.at(position.rest, position.nearest)) return atSurface();
  const btScalar distance = position.nearest.distance / deformed.restPerWorld;
  if (distance > now_.reach) return away(distance);
  position.tet = tet;
  position.next = head;
  head = static_cast<int>(positions_.size());
  positions_.push_back(position);
  return atSurface();
}

/// The motion of the sample in the body's rest space.
btVector3 PairSearch::restMotion(int sample, const SamplePosition& position) const {
  const ShapeData& in = now_.second->data();
  const EmbeddedPoint<btScalar>& point = now_.first->data().samples[static_cast<std::size_t>(sample)];
  const btVector3 velocity =
      point.velocity(velocitiesIn(*now_.first->body)) - now_.second->velocityAt(position.tet, position.weights);
  const DeformedTet& deformed = now_.second->deformed(position.tet);
  const Tet& n = in.tets[static_cast<std::size_t>(position.tet)];
  btVector3 motion(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const btVector3 edge = in.nodes[static_cast<std::size_t>(n[k])] - in.nodes[static_cast<std::size_t>(n[3])];
    motion += now_.dt * deformed.rows[k].dot(velocity) * edge;
  }
  return motion;
}

/// The normal of the sample's own surface, world space; 0 if it is not known.
btVector3 PairSearch::ownNormal(int sample, int run) const {
  const ShapeData& shapeData = now_.first->data();
  const int tet = shapeData.runs[static_cast<std::size_t>(run)].tet;
  const DeformedTet& deformed = now_.first->deformed(tet);
  if (deformed.flat) return {0, 0, 0};
  const btVector3 own =
      carriedGradient(shapeData, tet, deformed, shapeData.sampleNormals[static_cast<std::size_t>(sample)]);
  const btScalar length = own.length();
  return length > SIMD_EPSILON ? own / length : btVector3(0, 0, 0);
}

/// Determines the direction in which the contact pushes; returns false if it is no contact. Surfaces touch whose
/// normals oppose each other: a surface that slides along another one does not catch on its edges by the sides of its
/// own. All deep samples leave in one direction, since pushing each to its nearest surface would tear the body; less
/// deep samples beside them do not hold it back.
bool PairSearch::direct(const btVector3& own, bool onFace, Touch& touch) const {
  const bool overlaps = !now_.apart.isZero();
  // Where bodies coincide, their surfaces do, too.
  if (overlaps && own.dot(touch.normal) > kAgreeing) touch.distance = std::min(touch.distance, -2 * now_.deep);
  const bool deep = overlaps && touch.distance < -now_.deep;
  if (deep) touch.normal = now_.apart;
  if (overlaps && touch.distance < 0 && touch.normal.dot(now_.apart) < -kOpposing) return false;
  if (own.isZero()) return true;
  const bool pierced = contains(pierced_, touch.sample);
  touch.pierces = !overlaps && (pierced || touch.distance < -kPiercingCubes * now_.second->data().grid.spacing());
  if (touch.pierces) return own.dot(touch.normal) < kAgreeing;
  return own.dot(touch.normal) < (onFace && !deep ? kOpposingOnFaces : kOpposing);
}

void PairSearch::count(const btVector3& own, const Touch& touch) {
  overlap_.agreeing += own.dot(touch.normal) > kAgreeing ? 1 : 0;
  if (!(touch.distance < 0)) return;
  overlap_.deepest = std::min(overlap_.deepest, touch.distance);
  overlap_.normals += own;
  ++overlap_.inside;
}

void PairSearch::touch(int sample, int run, const SamplePosition& position) {
  const ShapeData& in = now_.second->data();
  const ContactSide* before = now_.sides->find(sample, position.rest, kOneSide * in.edge);
  const btVector3 motion = before ? btVector3(0, 0, 0) : restMotion(sample, position);
  SideDistance found;
  if (!findSide(in.grid, position.rest, position.nearest, motion, before, found)) return;
  const btVector3 normal = carriedGradient(in, position.tet, now_.second->deformed(position.tet), found.side.normal);
  const btScalar length = normal.length();
  if (!(length > SIMD_EPSILON)) return;
  Touch made;
  made.distance = found.distance / length;
  if (made.distance > now_.reach) return;
  found.side.sample = sample;
  now_.sides->keep(found.side);
  made.sample = sample;
  made.run = run;
  made.tet = position.tet;
  std::copy(position.weights, position.weights + 4, made.weights);
  made.normal = normal / length;
  const btVector3 own = ownNormal(sample, run);
  count(own, made);
  const bool onFace = now_.first->data().sampleNormals[static_cast<std::size_t>(sample)].length() > kOnFace;
  if (!direct(own, onFace, made)) return;
  keepDeepest(made, now_.first->data().sampleNodes[static_cast<std::size_t>(sample)]);
}

/// Samples that touched in the step before count as deeper: otherwise a resting body would be supported by other
/// samples in each step, and jitter.
btScalar PairSearch::rankOf(const Touch& touch) const {
  return contains(touched_, touch.sample) ? touch.distance - kKeptCubes * now_.second->data().grid.spacing()
                                          : touch.distance;
}

void PairSearch::keepDeepest(const Touch& touch, int node) {
  assert(node >= 0 && static_cast<std::size_t>(node) < touchOfNode_.size());
  int& head = touchOfNode_[static_cast<std::size_t>(node)];
  for (int t = head; t >= 0; t = (*touches_)[static_cast<std::size_t>(t)].next) {
    Touch& other = (*touches_)[static_cast<std::size_t>(t)];
    if (other.normal.dot(touch.normal) < kOneWay) continue;
    const int next = other.next;
    if (rankOf(touch) < rankOf(other)) other = touch;
    other.next = next;
    return;
  }
  touches_->push_back(touch);
  touches_->back().next = head;
  head = static_cast<int>(touches_->size()) - 1;
}

}  // namespace tetskin::contact_detail
