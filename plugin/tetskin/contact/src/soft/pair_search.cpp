// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_search.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// Positions of a sample that are nearer to each other at rest than this many mean edges are one, found on the face
/// between two tets.
constexpr btScalar kOnePlaceEdges = btScalar(0.3);
/// For contacts of a body with itself, in cubes of the grid: a sample whose rest position, as a tet maps it, differs
/// from its own by less than this is where it belongs, and does not touch there.
constexpr btScalar kOwnPlaceCubes = btScalar(1.5);
/// In cubes of the grid: relative motion up to which touches are followed instead of searched for. With 0.1, a pile of
/// cubes is 0.8 mm deep at rest instead of 0.3.
constexpr btScalar kFollowedCubes = btScalar(0.05);
/// A side that is farther away at rest than this many mean edges belongs to another part.
constexpr btScalar kOneSideEdges = 1;

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

/// Lists the samples that pierce, ascending.
void listPierced(const std::vector<Touch>& touches, std::vector<int>& pierced) {
  pierced.clear();
  for (const Touch& touch : touches) {
    if (touch.pierces) pierced.push_back(touch.sample);
  }
  std::sort(pierced.begin(), pierced.end());
}

Clearance outside(btScalar gap) {
  Clearance clear;
  clear.outside = gap;
  return clear;
}
Clearance away(btScalar distance) {
  Clearance clear;
  clear.distance = distance;
  return clear;
}
Clearance atSurface() {
  return away(0);
}

// While nodes of a tet move by d, its gradients by less than a quarter, let q = d steepness: lengths at rest per length
// in the world grow by at most 1 / (1 - q), and their bound by at most 1 + kStretch q.
constexpr btScalar kStretch = btScalar(2.7), kMaxStretched = btScalar(0.25);

/// How far a sample within a tet at a distance from the surface may be taken to be, so that `kApproach` holds.
btScalar surfaceClearance(btScalar distance, const DistanceGrid& grid, const DeformedTet& in) {
  const btScalar room = std::max(kApproach - grid.steepness(), btScalar(0)) / (kStretch * in.steepness);
  return std::min({distance, room, kApproach * kMaxStretched / in.steepness});
}

/// How far a sample may move until it is this far, by lengths now, from where it is at rest.
btScalar ownPlaceClearance(btScalar distance, const DeformedTet& in) {
  return std::min(distance / (1 + kStretch * kMaxStretched), kMaxStretched / in.steepness);
}

}  // namespace

Overlap PairSearch::find(ContactBody& first, ContactBody& second, btScalar dt, const btVector3& apart, btScalar deep,
                         PairMemory& memory, std::vector<Touch>& touches) {
  assert(dt > 0 && deep >= 0);
  now_ = {&first, &second, dt, apart, deep, &memory.sides};
  ++pair_;
  if (known_.size() < second.data().tets.size()) known_.resize(second.data().tets.size());
  memory.candidates.update(first, second, dt);
  const bool still = memory.motion.isStill(first, second, dt, kFollowedCubes * second.data().grid.spacing());
  if (still && memory.follows && apart.isZero() && follow(touches)) return memory.overlap;
  memory.follows = apart.isZero();
  if (!memory.candidates.empty()) second.place();
  overlap_ = {};
  touches_.begin(first, second.data().grid.spacing(), memory.touched, touches);
  memory.sides.beginStep();
  pierced_.swap(memory.pierced);
  memory.motion.markSearched();
  memory.candidates.visit(
      second, [&](const VisitedRun& run) -> const ContactBox& { return beginRun(run); },
      [&](int tet) { return testTet(tet); }, [&] { touchRun(); });
  touches_.remember(memory.touched);
  listPierced(touches, memory.pierced);
  memory.overlap = overlap_;
  return overlap_;
}

/// Moves the touches with their samples and tets. Returns false if a tet is flat.
bool PairSearch::follow(std::vector<Touch>& touches) {
  for (Touch& touch : touches) {
    const DeformedTet& in = deformed(touch.tet);
    if (in.flat) return false;
    const btVector3 normal = carriedGradient(now_.second->data(), touch.tet, in, touch.restNormal);
    const btScalar length = normal.length();
    if (!(length > SIMD_EPSILON)) return false;
    const EmbeddedPoint<btScalar>& sample = now_.first->data().samples[static_cast<std::size_t>(touch.sample)];
    touch.point.setZero();
    for (std::size_t k = 0; k < 4; ++k) {
      touch.point += sample.weights[k] * now_.first->positions[static_cast<std::size_t>(sample.nodes[k])];
    }
    in.weightsAt(touch.point, touch.weights);
    touch.distance = (touch.restDistance + touch.restNormal.dot(in.restAt(touch.point) - touch.restFound)) / length;
    touch.normal = normal / length;
  }
  return true;
}

void PairMemory::serialize(bullet_detail::WorldStream& stream, std::vector<Touch>& touches, bool followed) {
  if (stream.restoring()) candidates.drop();
  motion.serialize(stream);
  sides.serialize(stream);
  stream(overlap.deepest, overlap.normals, overlap.inside, overlap.agreeing, follows);
  stream.each(touched, [&](TouchedSample& sample) { stream(sample.sample, sample.age); });
  stream.array(pierced);
  std::vector<Touch> none;
  stream.each(followed || stream.restoring() ? touches : none, [&](Touch& touch) {
    stream(touch.sample, touch.tet, touch.restFound, touch.restNormal, touch.restDistance);
  });
}

bool PairMemory::fits(const ContactBody& first, const ContactBody& second, const std::vector<Touch>& touches) const {
  const auto samples = static_cast<int>(first.data().samples.size()),
             tets = static_cast<int>(second.data().tets.size());
  const auto isSample = [&](int sample) { return sample >= 0 && sample < samples; };
  const auto isBefore = [](const TouchedSample& a, const TouchedSample& b) { return a.sample < b.sample; };
  const bool havePositions = !first.positions.empty() && !second.positions.empty();
  return (havePositions || !motion.goesOn(first, second)) &&  // else the next step measures motion from no positions
         std::all_of(pierced.begin(), pierced.end(), isSample) && std::is_sorted(pierced.begin(), pierced.end()) &&
         std::is_sorted(touched.begin(), touched.end(), isBefore) &&
         std::all_of(touched.begin(), touched.end(), [&](const TouchedSample& t) { return isSample(t.sample); }) &&
         std::all_of(touches.begin(), touches.end(),
                     [&](const Touch& t) { return isSample(t.sample) && t.tet >= 0 && t.tet < tets; });
}

const ContactBox& PairSearch::beginRun(const VisitedRun& run) {
  assert(run.reach > 0 && run.samples);
  visited_ = run;
  run_ = now_.first->data().runs[static_cast<std::size_t>(run.run)];
  assert(run_.first < run_.last);
  carryRun();
  heads_.assign(static_cast<std::size_t>(run_.last - run_.first), -1);
  positions_.clear();
  return around_;
}

/// Computes the positions of the run's samples, and a box around them that is tighter than the tet's.
void PairSearch::carryRun() {
  const ShapeData& shapeData = now_.first->data();
  const Tet& n = shapeData.tets[static_cast<std::size_t>(run_.tet)];
  const auto first = static_cast<std::size_t>(run_.first), count = static_cast<std::size_t>(run_.last) - first;
  const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
  if (inside_.size() < padded) {
    for (std::vector<btScalar>* lanes : {&inside_, &carried_[0], &carried_[1], &carried_[2]}) lanes->resize(padded);
  }
  padded_ = padded;
  const btScalar *w0 = &shapeData.weights[0][first], *w1 = &shapeData.weights[1][first],
                 *w2 = &shapeData.weights[2][first], *w3 = &shapeData.weights[3][first];
  for (int axis = 0; axis < 3; ++axis) {
    Four at[4];
    for (std::size_t k = 0; k < 4; ++k) at[k] = four(now_.first->positions[static_cast<std::size_t>(n[k])][axis]);
    btScalar* out = carried_[axis].data();
    Four low = four(BT_LARGE_FLOAT), high = four(-BT_LARGE_FLOAT);
    for (std::size_t s = 0; s < padded; s += kLanes) {
      const Four x = fourAt(w0 + s) * at[0] + fourAt(w1 + s) * at[1] + fourAt(w2 + s) * at[2] + fourAt(w3 + s) * at[3];
      put(x, out + s);
      if (s + kLanes > count) break;
      low = smaller(x, low);
      high = larger(x, high);
    }
    const btScalar last = out[count - 1];
    for (std::size_t s = count; s < padded; ++s) out[s] = last;
    const Four rest = fourAt(out + padded - kLanes);
    around_.low[axis] = least(smaller(rest, low));
    around_.high[axis] = largest(larger(rest, high));
  }
}

btVector3 PairSearch::sampleAt(int k) const {
  const auto s = static_cast<std::size_t>(k);
  return {carried_[0][s], carried_[1][s], carried_[2][s]};
}

const DeformedTet& PairSearch::deformed(int tet) {
  KnownTet& known = known_[static_cast<std::size_t>(tet)];
  if (known.pair != pair_) known.tet = now_.second->deformed(tet);
  known.pair = pair_;
  return known.tet;
}

void PairSearch::touchRun() {
  if (positions_.empty()) return;
  own_ = now_.first->deformed(run_.tet);
  for (std::size_t k = 0; k < heads_.size(); ++k) {
    for (int p = heads_[k]; p >= 0; p = positions_[static_cast<std::size_t>(p)].next) {
      makeTouch(static_cast<int>(k), positions_[static_cast<std::size_t>(p)]);
    }
  }
}

/// Computes how far inside of the tet each sample of the run is, by its nearest plane; returns the largest of these.
btScalar PairSearch::findDepths(const DeformedTet& tet) {
  Four normals[4][3], offsets[4];
  for (int k = 0; k < 4; ++k) {
    for (int axis = 0; axis < 3; ++axis) normals[k][axis] = four(tet.normals[k][axis]);
    offsets[k] = four(tet.offsets[k]);
  }
  const Four origin[3] = {four(tet.origin.x()), four(tet.origin.y()), four(tet.origin.z())};
  Four deepest = four(-BT_LARGE_FLOAT);
  for (std::size_t s = 0; s < padded_; s += kLanes) {
    const Four x = fourAt(&carried_[0][s]) - origin[0], y = fourAt(&carried_[1][s]) - origin[1],
               z = fourAt(&carried_[2][s]) - origin[2];
    const auto depth = [&](int k) -> Four {
      return normals[k][0] * x + normals[k][1] * y + normals[k][2] * z + offsets[k];
    };
    const Four least = smaller(smaller(depth(0), depth(1)), smaller(depth(2), depth(3)));
    put(least, &inside_[s]);
    deepest = larger(least, deepest);
  }
  return largest(deepest);
}

/// Tests the samples of the run.
Clearance PairSearch::testTet(int tet) {
  const DeformedTet& in = deformed(tet);
  if (in.flat) return outside(0);
  if (const btScalar gap = gapTo(around_, in); gap > 0) return outside(gap);
  if (const btScalar deepest = findDepths(in); deepest < 0) return outside(-deepest);
  Clearance clear;
  btScalar nearest = -BT_LARGE_FLOAT;  // of those that are outside
  const int count = run_.last - run_.first;
  for (int begin = 0; begin < count; begin += kLanes) {
    const Four depths = fourAt(&inside_[static_cast<std::size_t>(begin)]);
    if (const btScalar deepest = largest(depths); deepest < 0) {
      nearest = std::max(nearest, deepest);
      continue;
    }
    for (int k = begin; k < std::min(begin + kLanes, count); ++k) {
      const btScalar depth = depths[k - begin];
      if (depth >= 0) {
        clear.cut(testSample(tet, k));
      } else {
        nearest = std::max(nearest, depth);
      }
    }
  }
  clear.cut(outside(-nearest));
  return clear;
}

/// Most samples within a tet are away from its surface, and still where they were: these need not be looked up again.
Clearance PairSearch::testSample(int tet, int k) {
  SampleClearance& known = visited_.samples[k];
  const btScalar path = visited_.path;
  if (known.tet == tet && kApproach * (path + visited_.rounding) + visited_.reach < known.until) {
    return away(known.until - kApproach * path);
  }
  const Clearance found = addPosition(tet, run_.first + k, k);
  if (found.distance > 0 && found.outside == kForever) known = {tet, found.endsAt(path).distance};
  return found;
}

/// False if a point of the tet belongs to one of its duplicates.
bool PairSearch::isCarried(int tet, const btVector3& at) {
  const ShapeData& data = now_.second->data();
  if (data.carried.empty()) return true;
  const CarriedCells& cells = data.carried[static_cast<std::size_t>(tet)];
  if (cells.holdsAll()) return true;
  btScalar weights[4];
  deformed(tet).weightsAt(at, weights);
  return cells.holds(weights);
}

/// Skips positions that are already known from a neighbouring tet.
Clearance PairSearch::addPosition(int tet, int sample, int k) {
  assert(k >= 0 && static_cast<std::size_t>(k) < heads_.size());
  const ShapeData& data = now_.second->data();
  const DeformedTet& in = deformed(tet);
  const btVector3 at = sampleAt(k);
  SamplePosition position;
  if (!isCarried(tet, at)) return atSurface();
  position.rest = in.restAt(at);
  if (now_.first == now_.second) {
    const btScalar own = kOwnPlaceCubes * data.grid.spacing();
    const btScalar moved = (position.rest - data.sampleRest[static_cast<std::size_t>(sample)]).length();
    if (moved < own) return outside(ownPlaceClearance((own - moved) / in.restPerWorld, in));
  }
  int& head = heads_[static_cast<std::size_t>(k)];
  const btScalar apart = kOnePlaceEdges * data.edge;
  for (int p = head; p >= 0; p = positions_[static_cast<std::size_t>(p)].next) {
    if ((positions_[static_cast<std::size_t>(p)].rest - position.rest).length2() < apart * apart) return atSurface();
  }
  if (!data.grid.at(position.rest, position.nearest)) return atSurface();
  const btScalar distance = position.nearest.distance / in.restPerWorld;
  if (distance > visited_.reach) return away(surfaceClearance(distance, data.grid, in));
  in.weightsAt(at, position.weights);
  position.tet = tet;
  position.reach = reachOf(sample, position);
  if (distance > position.reach) return away(surfaceClearance(distance, data.grid, in));
  position.next = head;
  head = static_cast<int>(positions_.size());
  positions_.push_back(position);
  return atSurface();
}

/// The velocity of the sample relative to the tet.
btVector3 PairSearch::velocityOf(int sample, const SamplePosition& position) const {
  const EmbeddedPoint<btScalar>& point = now_.first->data().samples[static_cast<std::size_t>(sample)];
  const Tet& n = now_.second->data().tets[static_cast<std::size_t>(position.tet)];
  btVector3 velocity(0, 0, 0);
  for (std::size_t k = 0; k < 4; ++k) {
    velocity += point.weights[k] * now_.first->velocities[static_cast<std::size_t>(point.nodes[k])] -
                position.weights[k] * now_.second->velocities[static_cast<std::size_t>(n[k])];
  }
  return velocity;
}

/// By the sample's own motion: bounds of it depend on which other samples are candidates.
btScalar PairSearch::reachOf(int sample, const SamplePosition& position) const {
  const btScalar cube = now_.second->data().grid.spacing();
  return std::min(kReachCubes * cube, kNearCubes * cube + now_.dt * velocityOf(sample, position).length());
}

/// The motion of the sample in the body's rest space.
btVector3 PairSearch::restMotion(int sample, const SamplePosition& position) {
  const ShapeData& in = now_.second->data();
  const btVector3 velocity = velocityOf(sample, position);
  const DeformedTet& around = deformed(position.tet);
  const Tet& n = in.tets[static_cast<std::size_t>(position.tet)];
  btVector3 motion(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const btVector3 edge = in.nodes[static_cast<std::size_t>(n[k])] - in.nodes[static_cast<std::size_t>(n[3])];
    motion += now_.dt * around.rows[k].dot(velocity) * edge;
  }
  return motion;
}

/// The normal of the sample's own surface, world space; 0 if it is not known.
btVector3 PairSearch::ownNormal(int sample) const {
  if (own_.flat) return {0, 0, 0};
  const ShapeData& shapeData = now_.first->data();
  const btVector3 own =
      carriedGradient(shapeData, run_.tet, own_, shapeData.sampleNormals[static_cast<std::size_t>(sample)]);
  const btScalar length = own.length();
  return length > SIMD_EPSILON ? own / length : btVector3(0, 0, 0);
}

SampleSurface PairSearch::surfaceOf(int sample) const {
  SampleSurface surface;
  surface.normal = ownNormal(sample);
  surface.onFace = now_.first->data().sampleNormals[static_cast<std::size_t>(sample)].length() > kOnFace;
  surface.touched = touches_.ageOf(sample) >= 0;
  surface.pierced = std::binary_search(pierced_.begin(), pierced_.end(), sample);
  return surface;
}

/// Of the touch as it is before a normal is chosen.
void PairSearch::accumulateOverlap(const btVector3& own, const Touch& touch) {
  overlap_.agreeing += agree(own, touch.normal) ? 1 : 0;
  if (!(touch.distance < 0)) return;
  overlap_.deepest = std::min(overlap_.deepest, touch.distance);
  overlap_.normals += own;
  ++overlap_.inside;
}

void PairSearch::makeTouch(int k, const SamplePosition& position) {
  const ShapeData& in = now_.second->data();
  const int sample = run_.first + k;
  const ContactSide* before = now_.sides->find(sample, position.rest, kOneSideEdges * in.edge);
  const btVector3 motion =
      asksForMotion(in.grid, position.nearest, before) ? restMotion(sample, position) : btVector3(0, 0, 0);
  SideDistance found;
  if (!findSide(in.grid, position.rest, position.nearest, motion, before, found)) return;
  const btVector3 normal = carriedGradient(in, position.tet, deformed(position.tet), found.side.normal);
  const btScalar length = normal.length();
  if (!(length > SIMD_EPSILON)) return;
  Touch made;
  made.distance = found.distance / length;
  if (made.distance > position.reach) return;
  found.side.sample = sample;
  now_.sides->keep(found.side);
  made.sample = sample;
  made.run = visited_.run;
  made.tet = position.tet;
  made.point = sampleAt(k);
  std::copy(position.weights, position.weights + 4, made.weights);
  made.normal = normal / length;
  made.restFound = position.rest;
  made.restNormal = found.side.normal;
  made.restDistance = found.distance;
  const SampleSurface own = surfaceOf(sample);
  accumulateOverlap(own.normal, made);
  if (chooseNormal({now_.apart, now_.deep, in.grid.spacing()}, own, made)) touches_.keep(made);
}

}  // namespace tetskin::contact_detail
