// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pairs, and the contact points that their algorithms keep from step to step. An algorithm creates its manifold on
// construction or in its first run, depending on the bodies at that time; here it gets one if the saved one had it.
// Algorithms of soft bodies keep nothing, and are never asked for manifolds: Bullet's would read uninitialised members.
#include <BulletCollision/CollisionDispatch/btBoxBoxCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexPlaneCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btHashedSimplePairCache.h>
#include <BulletCollision/CollisionDispatch/btSphereSphereCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btSphereTriangleCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_state.h>
#include <tetskin/solver/src/exported/solver_state.h>

#include <memory>
#include <string>

namespace tetskin::bullet_detail {
namespace {

/// Where an algorithm for two convex shapes keeps its manifold.
struct PointCache {
  btPersistentManifold** manifold = nullptr;
  bool* owned = nullptr;  ///< null: the manifold always exists
};

template <class Algorithm>
using ManifoldMember = Hidden<Algorithm, btPersistentManifold*>;
template <class Algorithm>
using OwnedMember = Hidden<Algorithm, bool>;

template <class Algorithm>
PointCache cacheOf(Algorithm& algorithm) {
  return {&(algorithm.*memberOf(ManifoldMember<Algorithm>())), &(algorithm.*memberOf(OwnedMember<Algorithm>()))};
}

}  // namespace

template struct Opened<ManifoldMember<btConvexConvexAlgorithm>, &btConvexConvexAlgorithm::m_manifoldPtr>;
template struct Opened<OwnedMember<btConvexConvexAlgorithm>, &btConvexConvexAlgorithm::m_ownManifold>;
template struct Opened<ManifoldMember<btBoxBoxCollisionAlgorithm>, &btBoxBoxCollisionAlgorithm::m_manifoldPtr>;
template struct Opened<OwnedMember<btBoxBoxCollisionAlgorithm>, &btBoxBoxCollisionAlgorithm::m_ownManifold>;
template struct Opened<ManifoldMember<btSphereSphereCollisionAlgorithm>,
                       &btSphereSphereCollisionAlgorithm::m_manifoldPtr>;
template struct Opened<OwnedMember<btSphereSphereCollisionAlgorithm>, &btSphereSphereCollisionAlgorithm::m_ownManifold>;
template struct Opened<ManifoldMember<btSphereTriangleCollisionAlgorithm>,
                       &btSphereTriangleCollisionAlgorithm::m_manifoldPtr>;
template struct Opened<OwnedMember<btSphereTriangleCollisionAlgorithm>,
                       &btSphereTriangleCollisionAlgorithm::m_ownManifold>;
template struct Opened<ManifoldMember<btConvexPlaneCollisionAlgorithm>,
                       &btConvexPlaneCollisionAlgorithm::m_manifoldPtr>;
template struct Opened<OwnedMember<btConvexPlaneCollisionAlgorithm>, &btConvexPlaneCollisionAlgorithm::m_ownManifold>;

using TriangleCallback = Hidden<btConvexConcaveCollisionAlgorithm, btConvexTriangleCallback>;
template struct Opened<TriangleCallback, &btConvexConcaveCollisionAlgorithm::m_btConvexTriangleCallback>;
using CompoundAlgorithm = btCompoundCollisionAlgorithm;
using ChildrenMember = Hidden<CompoundAlgorithm, btAlignedObjectArray<btCollisionAlgorithm*>>;
template struct Opened<ChildrenMember, &CompoundAlgorithm::m_childCollisionAlgorithms>;
using IsSwappedMember = Hidden<CompoundAlgorithm, bool>;
template struct Opened<IsSwappedMember, &CompoundAlgorithm::m_isSwapped>;
using RevisionMember = Hidden<CompoundAlgorithm, int>;
template struct Opened<RevisionMember, &CompoundAlgorithm::m_compoundShapeRevision>;
using TwoCompoundsAlgorithm = btCompoundCompoundCollisionAlgorithm;
using ChildPairsMember = Hidden<TwoCompoundsAlgorithm, btHashedSimplePairCache*>;
template struct Opened<ChildPairsMember, &TwoCompoundsAlgorithm::m_childCollisionAlgorithmCache>;

namespace {

PointCache cacheOf(btConvexConcaveCollisionAlgorithm& algorithm) {
  return {&(algorithm.*memberOf(TriangleCallback())).m_manifoldPtr, nullptr};
}

enum class AlgorithmKind : unsigned char { None, Stateless, Convex, Compound, TwoCompounds, Unknown };

/// Samples of Bullet's algorithms, as its dispatcher creates them for these shapes: a world's objects are recognised by
/// comparison.
class BulletClasses {
 public:
  static const BulletClasses& get() {
    static const BulletClasses* const classes = new BulletClasses;  // never destroyed: worlds may be static
    return *classes;
  }

  AlgorithmKind kindOf(const btCollisionAlgorithm* algorithm) const {
    if (!algorithm) return AlgorithmKind::None;
    const auto is = [&](const btCollisionAlgorithm* sample) { return isOfSameClass(*algorithm, *sample); };
    if (is(convex_) || is(boxes_) || is(spheres_) || is(triangle_) || is(plane_) || is(concave_))
      return AlgorithmKind::Convex;
    if (is(compound_)) return AlgorithmKind::Compound;
    if (is(twoCompounds_)) return AlgorithmKind::TwoCompounds;
    return is(empty_) ? AlgorithmKind::Stateless : AlgorithmKind::Unknown;
  }
  PointCache cacheOfConvex(btCollisionAlgorithm& a) const {
    if (isOfSameClass(a, *convex_)) return cacheOf(static_cast<btConvexConvexAlgorithm&>(a));
    if (isOfSameClass(a, *boxes_)) return cacheOf(static_cast<btBoxBoxCollisionAlgorithm&>(a));
    if (isOfSameClass(a, *spheres_)) return cacheOf(static_cast<btSphereSphereCollisionAlgorithm&>(a));
    if (isOfSameClass(a, *triangle_)) return cacheOf(static_cast<btSphereTriangleCollisionAlgorithm&>(a));
    if (isOfSameClass(a, *plane_)) return cacheOf(static_cast<btConvexPlaneCollisionAlgorithm&>(a));
    return cacheOf(static_cast<btConvexConcaveCollisionAlgorithm&>(a));
  }

 private:
  btCollisionAlgorithm* made(btCollisionShape* first, btCollisionShape* second) {
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(first);
    const btCollisionObjectWrapper a(nullptr, first, objects_.back().get(), btTransform::getIdentity(), -1, -1);
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(second);
    const btCollisionObjectWrapper b(nullptr, second, objects_.back().get(), btTransform::getIdentity(), -1, -1);
    return WorldParts::get().dispatcher.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  }

  btSphereShape sphere_{1};
  btBoxShape box_{btVector3(1, 1, 1)};
  btTriangleShape triangleShape_{btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0)};
  btStaticPlaneShape planeShape_{btVector3(0, 1, 0), 0};
  btEmptyShape nothing_;  // counts as concave
  btCompoundShape compoundShape_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  const btCollisionAlgorithm* convex_ = made(&sphere_, &box_);
  const btCollisionAlgorithm* boxes_ = made(&box_, &box_);
  const btCollisionAlgorithm* spheres_ = made(&sphere_, &sphere_);
  const btCollisionAlgorithm* triangle_ = made(&sphere_, &triangleShape_);
  const btCollisionAlgorithm* plane_ = made(&box_, &planeShape_);
  const btCollisionAlgorithm* concave_ = made(&sphere_, &nothing_);
  const btCollisionAlgorithm* compound_ = made(&compoundShape_, &sphere_);
  const btCollisionAlgorithm* twoCompounds_ = made(&compoundShape_, &compoundShape_);
  const btCollisionAlgorithm* empty_ = made(&planeShape_, &planeShape_);
};

/// Goes through the pairs, and notes each manifold's index in the dispatcher's list, in whose order the solver takes
/// them.
class PairVisitor {
 public:
  explicit PairVisitor(WorldStream& stream)
      : stream_(stream), dispatcher_(static_cast<btCollisionDispatcher&>(*stream.world().getDispatcher())) {}

  void visit(btBroadphasePair& pair) {
    auto& a = *static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
    auto& b = *static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
    const btCollisionObjectWrapper first(nullptr, a.getCollisionShape(), &a, a.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper second(nullptr, b.getCollisionShape(), &b, b.getWorldTransform(), -1, -1);
    visit(pair.m_algorithm, first, second);
  }

  /// The manifolds in the order of the dispatcher's list, and their points.
  void serializeCaches() {
    int count = dispatcher_.getNumManifolds();
    stream_(count);
    btPersistentManifold** list = dispatcher_.getInternalManifoldPointer();
    if (stream_.saving()) {
      if (static_cast<std::size_t>(count) != found_.size())
        stream_.refuse("a contact manifold that belongs to no pair");
    } else if (!putInOrder(count, list)) {
      return stream_.fail();
    }
    for (int k = 0; k < count; ++k) serializeCache(*list[k]);
  }

 private:
  struct Found {
    btPersistentManifold* manifold;
    int index;  ///< in the list
  };

  static std::string nameOf(const btCollisionObjectWrapper& object) {
    return "object " + std::to_string(object.getCollisionObject()->getWorldArrayIndex()) + " (" +
           object.getCollisionShape()->getName() + ")";
  }
  static bool isSoft(const btCollisionObjectWrapper& object) {
    return object.getCollisionObject()->getInternalType() == btCollisionObject::CO_SOFT_BODY;
  }

  void visit(btCollisionAlgorithm*& algorithm, const btCollisionObjectWrapper& first,
             const btCollisionObjectWrapper& second) {
    const BulletClasses& classes = BulletClasses::get();
    const bool soft = isSoft(first) || isSoft(second);
    const auto kindNow = [&] { return soft && algorithm ? AlgorithmKind::Stateless : classes.kindOf(algorithm); };
    AlgorithmKind kind = kindNow();
    if (kind == AlgorithmKind::Unknown) {
      return stream_.refuse("the contact of " + nameOf(first) + " and " + nameOf(second) +
                            ", whose collision algorithm it does not know: that of a GImpact mesh, or your own");
    }
    stream_(kind);
    if (stream_.restoring() && !make(algorithm, kind != AlgorithmKind::None && !stream_.failed(), first, second))
      return;
    if (kindNow() != kind) return stream_.fail();
    if (kind == AlgorithmKind::Convex) serializeConvex(*algorithm, first, second);
    if (kind == AlgorithmKind::Compound || kind == AlgorithmKind::TwoCompounds) {
      serializeCompound(static_cast<CompoundAlgorithm&>(*algorithm), first, second);
    }
    if (kind == AlgorithmKind::TwoCompounds)
      serializeTwo(static_cast<TwoCompoundsAlgorithm&>(*algorithm), first, second);
  }

  /// Creates or destroys the algorithm as wanted. Returns false if there is none afterwards.
  bool make(btCollisionAlgorithm*& algorithm, bool wanted, const btCollisionObjectWrapper& first,
            const btCollisionObjectWrapper& second) {
    if (wanted && !algorithm) {
      algorithm = dispatcher_.findAlgorithm(&first, &second, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    } else if (!wanted && algorithm) {
      algorithm->~btCollisionAlgorithm();
      dispatcher_.freeCollisionAlgorithm(algorithm);
      algorithm = nullptr;
    }
    return algorithm;
  }

  void serializeConvex(btCollisionAlgorithm& algorithm, const btCollisionObjectWrapper& first,
                       const btCollisionObjectWrapper& second) {
    const PointCache cache = BulletClasses::get().cacheOfConvex(algorithm);
    btPersistentManifold*& manifold = *cache.manifold;
    const btCollisionObject *a = first.getCollisionObject(), *b = second.getCollisionObject();
    bool has = manifold, swapped = manifold && manifold->getBody0() == b;
    int index = has ? manifold->m_index1a : 0;
    serializeAll(stream_, has, swapped, index);
    if (stream_.restoring() && cache.owned) {
      if (has && !manifold) {
        manifold = dispatcher_.getNewManifold(a, b);
        *cache.owned = true;
      } else if (!has && manifold) {
        dispatcher_.releaseManifold(manifold);
        manifold = nullptr;
        *cache.owned = false;
      }
    }
    if (!manifold) return;
    if (stream_.restoring()) swapped ? manifold->setBodies(b, a) : manifold->setBodies(a, b);
    found_.push_back({manifold, index});
  }

  static const btCompoundShape& shapeOf(const btCollisionObjectWrapper& object) {
    return static_cast<const btCompoundShape&>(*object.getCollisionShape());
  }

  void serializeCompound(CompoundAlgorithm& algorithm, const btCollisionObjectWrapper& first,
                         const btCollisionObjectWrapper& second) {
    const bool swapped = algorithm.*memberOf(IsSwappedMember());
    const btCollisionObjectWrapper &whole = swapped ? second : first, &other = swapped ? first : second;
    auto& children = algorithm.*memberOf(ChildrenMember());
    const btCompoundShape& shape = shapeOf(whole);
    if (shape.getUpdateRevision() != algorithm.*memberOf(RevisionMember())) {
      return stream_.refuse("a compound whose children have been changed since the last step: take a step before");
    }
    const auto count = static_cast<std::size_t>(children.size());
    if (stream_.length(count) != count) return stream_.fail();
    for (int k = 0; k < children.size(); ++k) {
      const btTransform place = whole.getWorldTransform() * shape.getChildTransform(k);
      const btCollisionObjectWrapper child(&whole, shape.getChildShape(k), whole.getCollisionObject(), place, -1, k);
      visit(children[k], child, other);
    }
  }

  void serializeTwo(TwoCompoundsAlgorithm& algorithm, const btCollisionObjectWrapper& first,
                    const btCollisionObjectWrapper& second) {
    btHashedSimplePairCache& pairs = *(algorithm.*memberOf(ChildPairsMember()));
    const auto count = static_cast<int>(stream_.length(static_cast<std::size_t>(pairs.getNumOverlappingPairs()), 9));
    for (int k = 0; k < count; ++k) {
      int a = 0, b = 0;
      btCollisionAlgorithm* child = nullptr;
      if (stream_.saving()) {
        const btSimplePair& pair = pairs.getOverlappingPairArray()[k];
        a = pair.m_indexA;
        b = pair.m_indexB;
        child = static_cast<btCollisionAlgorithm*>(pair.m_userPointer);
      }
      serializeAll(stream_, a, b);
      const btCompoundShape &shapeA = shapeOf(first), &shapeB = shapeOf(second);
      if (a < 0 || a >= shapeA.getNumChildShapes() || b < 0 || b >= shapeB.getNumChildShapes()) return stream_.fail();
      const btTransform placeA = first.getWorldTransform() * shapeA.getChildTransform(a);
      const btTransform placeB = second.getWorldTransform() * shapeB.getChildTransform(b);
      const btCollisionObjectWrapper childA(&first, shapeA.getChildShape(a), first.getCollisionObject(), placeA, -1, a);
      const btCollisionObjectWrapper childB(&second, shapeB.getChildShape(b), second.getCollisionObject(), placeB, -1,
                                            b);
      if (stream_.restoring() && pairs.findPair(a, b)) return stream_.fail();
      visit(child, childA, childB);
      if (!child) return stream_.fail();
      if (stream_.restoring()) pairs.addOverlappingPair(a, b)->m_userPointer = child;
    }
  }

  bool putInOrder(int count, btPersistentManifold** list) const {
    if (count != dispatcher_.getNumManifolds() || static_cast<std::size_t>(count) != found_.size()) return false;
    std::vector<btPersistentManifold*> order(found_.size(), nullptr);
    for (const Found& f : found_) {
      if (f.index < 0 || f.index >= count || order[static_cast<std::size_t>(f.index)]) return false;
      order[static_cast<std::size_t>(f.index)] = f.manifold;
    }
    for (int k = 0; k < count; ++k) {
      list[k] = order[static_cast<std::size_t>(k)];
      list[k]->m_index1a = k;
    }
    return true;
  }

  void serializeCache(btPersistentManifold& m) {
    int points = m.getNumContacts();
    btScalar breaking = m.getContactBreakingThreshold(), processing = m.getContactProcessingThreshold();
    serializeAll(stream_, points, breaking, processing, m.m_companionIdA, m.m_companionIdB);
    if (stream_.restoring()) {
      if (points < 0 || points > MANIFOLD_CACHE_SIZE) return stream_.fail();
      m.setContactBreakingThreshold(breaking);
      m.setContactProcessingThreshold(processing);
      m.setNumContacts(points);
    }
    for (int k = 0; k < points; ++k) serializePoint(m.getContactPoint(k));
  }

  /// `m_userPersistentData` belongs to the application, and is lost.
  void serializePoint(btManifoldPoint& p) {
    if (stream_.restoring()) p.m_userPersistentData = nullptr;
    serializeAll(stream_, p.m_localPointA, p.m_localPointB, p.m_positionWorldOnB, p.m_positionWorldOnA,
                 p.m_normalWorldOnB, p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction,
                 p.m_combinedSpinningFriction, p.m_combinedRestitution, p.m_partId0, p.m_partId1, p.m_index0,
                 p.m_index1, p.m_contactPointFlags, p.m_appliedImpulse, p.m_prevRHS, p.m_appliedImpulseLateral1,
                 p.m_appliedImpulseLateral2, p.m_contactMotion1, p.m_contactMotion2, p.m_contactCFM, p.m_contactERP,
                 p.m_frictionCFM, p.m_lifeTime, p.m_lateralFrictionDir1, p.m_lateralFrictionDir2);
  }

  WorldStream& stream_;
  btCollisionDispatcher& dispatcher_;
  std::vector<Found> found_;
};

/// Accepts pairs that a filter would refuse now but accepted when they were found.
class AllPairs : public btOverlapFilterCallback {
 public:
  explicit AllPairs(btOverlappingPairCache& cache) : cache_(cache), before_(cache.getOverlapFilterCallback()) {
    cache_.setOverlapFilterCallback(this);
  }
  ~AllPairs() override { cache_.setOverlapFilterCallback(before_); }
  AllPairs(const AllPairs&) = delete;
  AllPairs& operator=(const AllPairs&) = delete;
  bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override { return true; }

 private:
  btOverlappingPairCache& cache_;
  btOverlapFilterCallback* before_;
};

}  // namespace

void serializePairs(WorldStream& stream) {
  btOverlappingPairCache& cache = *stream.world().getPairCache();
  const btCollisionObjectArray& objects = stream.world().getCollisionObjectArray();
  const auto count = static_cast<int>(stream.length(static_cast<std::size_t>(cache.getNumOverlappingPairs()), 9));
  const AllPairs all(cache);
  PairVisitor visitor(stream);
  for (int k = 0; k < count; ++k) {
    int ends[2] = {0, 0};
    if (stream.saving()) {
      const btBroadphasePair& pair = cache.getOverlappingPairArray()[k];
      ends[0] = static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject)->getWorldArrayIndex();
      ends[1] = static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject)->getWorldArrayIndex();
    }
    serializeAll(stream, ends);
    if (stream.restoring()) {
      const auto exists = [&](int index) { return index >= 0 && index < objects.size(); };
      if (!exists(ends[0]) || !exists(ends[1]) || ends[0] == ends[1] || stream.failed()) return stream.fail();
      const int before = cache.getNumOverlappingPairs();
      cache.addOverlappingPair(objects[ends[0]]->getBroadphaseHandle(), objects[ends[1]]->getBroadphaseHandle());
      if (cache.getNumOverlappingPairs() == before) return stream.fail();  // it was there already
    }
    visitor.visit(cache.getOverlappingPairArray()[k]);
  }
  visitor.serializeCaches();
}

void removePairs(WorldStream& stream) {
  btOverlappingPairCache& cache = *stream.world().getPairCache();
  while (cache.getNumOverlappingPairs() > 0) {
    const btBroadphasePair last = cache.getOverlappingPairArray()[cache.getNumOverlappingPairs() - 1];
    cache.removeOverlappingPair(last.m_pProxy0, last.m_pProxy1, stream.world().getDispatcher());
  }
}

}  // namespace tetskin::bullet_detail
