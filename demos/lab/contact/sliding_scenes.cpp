// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A soft box that slides over grounds made of parts, and rigid bodies that slide on a soft slab, compared with
// Coulomb's law.
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "measure/obstacles.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

/// How something slides: it comes to rest after a distance of v^2 / (2 mu g).
struct Slide {
  double speed = 3.0, friction = 0.3;
  Vector3d direction = Vector3d::UnitX();

  double seconds() const { return speed / (friction * scenes::kEarth); }
  double distance() const { return 0.5 * speed * seconds(); }
};

/// Follows the centre of what slides until it rests.
/// size  of what slides
void measure(Run& run, MeasuringWorld& world, const Slide& slide, double size,
             const std::function<Vector3d()>& centre) {
  const Vector3d from = centre(), side = slide.direction.cross(Vector3d::UnitY());
  double aside = 0.0, jump = 0.0;
  Vector3d moved = Vector3d::Zero();
  world.simulate(1.1 * slide.seconds(), [&] {
    moved = centre() - from;
    raise(aside, std::abs(moved.dot(side)));
    raise(jump, moved.y());
  });
  run.report("distance over v^2 / (2 mu g)", moved.dot(slide.direction) / slide.distance());
  run.report("aside over v^2 / (2 mu g)", aside / slide.distance());
  run.report("jump, S", jump / size);
}

/// Shapes of rigid bodies, with what these refer to.
struct ShapeParts {
  std::vector<std::unique_ptr<btCollisionShape>> children;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes;
  std::vector<std::vector<float>> heights;
};

std::unique_ptr<btConvexHullShape> hullOfBox(const Vector3d& half) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (int k = 0; k < 8; ++k) {
    hull->addPoint(toBullet(half.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1))));
  }
  return hull;
}

/// A square mesh of equal cells around a point of the ground.
std::unique_ptr<btCollisionShape> gridShape(double side, int cells) {
  const auto corner = [&](int i, int k) {
    return toBullet(Vector3d(i, 0, k) * (side / cells) - Vector3d(0.5, 0, 0.5) * side);
  };
  return std::make_unique<TriangleShape>([&](btTriangleMesh& mesh) {
    for (int i = 0; i < cells; ++i) {
      for (int k = 0; k < cells; ++k) {
        mesh.addTriangle(corner(i, k), corner(i, k + 1), corner(i + 1, k));
        mesh.addTriangle(corner(i, k + 1), corner(i + 1, k + 1), corner(i + 1, k));
      }
    }
  });
}

std::unique_ptr<btCollisionShape> flatTerrain(ShapeParts& parts, double side, int cells) {
  parts.heights.emplace_back(static_cast<std::size_t>((cells + 1) * (cells + 1)), 0.0F);
  auto terrain = std::make_unique<btHeightfieldTerrainShape>(cells + 1, cells + 1, parts.heights.back().data(), 1, -1,
                                                             1, 1, PHY_FLOAT, false);
  terrain->setLocalScaling(toBullet(Vector3d(side / cells, 1, side / cells)));
  return terrain;
}

/// Calls for the centres of square tiles with their upper sides at y = 0; no tile begins where the box does.
void forTiles(const std::function<void(const Vector3d&)>& add) {
  constexpr int kTiles = 10;
  for (int i = -kTiles; i <= kTiles; ++i) {
    for (int k = -kTiles; k <= kTiles; ++k) add({0.5 * i + 0.13, -0.1, 0.5 * k + 0.21});
  }
}

const Vector3d kTileHalf(0.25, 0.1, 0.25);

void addTiles(MeasuringWorld& world, ShapeParts&) {
  forTiles([&](const Vector3d& centre) { world.addBox(centre, kTileHalf); });
}

void addHulls(MeasuringWorld& world, ShapeParts&) {
  forTiles([&](const Vector3d& centre) { world.addRigid(hullOfBox(kTileHalf), at(centre)); });
}

void addCompound(MeasuringWorld& world, ShapeParts& parts) {
  auto compound = std::make_unique<btCompoundShape>();
  forTiles([&](const Vector3d& centre) {
    parts.children.push_back(std::make_unique<btBoxShape>(toBullet(kTileHalf)));
    compound->addChildShape(at(centre), parts.children.back().get());
  });
  world.addRigid(std::move(compound), btTransform::getIdentity());
}

/// Two halves of the ground that meet between the start and the end.
void addHalves(MeasuringWorld& world, const std::function<std::unique_ptr<btCollisionShape>()>& half) {
  constexpr double kSide = 12.0, kSeam = 0.61;
  for (const double end : {-0.5, 0.5}) world.addRigid(half(), at(Vector3d(kSeam + end * kSide, 0, 0)));
}

void addTwoMeshes(MeasuringWorld& world, ShapeParts&) {
  addHalves(world, [cells = 7]() mutable { return gridShape(12, cells += 3); });
}

void addTwoTerrains(MeasuringWorld& world, ShapeParts& parts) {
  addHalves(world, [&] { return flatTerrain(parts, 12, 24); });
}

void addMesh(MeasuringWorld& world, int cells) {
  world.addRigid(gridShape(12, cells), btTransform::getIdentity());
}

using AddGround = std::function<void(MeasuringWorld&, ShapeParts&)>;

/// A soft box at rest is pushed.
void slideSoftBox(Run& run, const AddGround& addGround, const Slide& slide) {
  ShapeParts parts;
  MeasuringWorld world(run);
  addGround(world, parts);
  BodyOptions options;
  options.friction = slide.friction;
  SoftObject& box = world.addSoftOn(0.0, makeBox({0.5, 0.25, 0.5}), options);
  world.simulate(1);
  box.push(slide.speed * slide.direction);
  measure(run, world, slide, box.model().size, [&] { return box.motion().centroid; });
}

const Vector3d kRigidHalf(0.15, 0.1, 0.15);

/// Its lower side is smaller than its middle.
std::unique_ptr<btCollisionShape> bevelled() {
  auto hull = hullOfBox(kRigidHalf.cwiseProduct(Vector3d(0.8, 1, 0.8)));
  for (const double x : {-0.15, 0.15}) {
    for (const double z : {-0.15, 0.15}) hull->addPoint(toBullet(Vector3d(x, 0.02, z)));
  }
  return hull;
}

std::unique_ptr<btCollisionShape> nineBoxes(ShapeParts& parts) {
  auto compound = std::make_unique<btCompoundShape>();
  for (int i = -1; i <= 1; ++i) {
    for (int k = -1; k <= 1; ++k) {
      parts.children.push_back(std::make_unique<btBoxShape>(toBullet(Vector3d(0.05, 0.1, 0.05))));
      compound->addChildShape(at({0.1 * i, 0, 0.1 * k}), parts.children.back().get());
    }
  }
  return compound;
}

/// The surface of a box as a mesh that can move.
std::unique_ptr<btCollisionShape> movingMesh(ShapeParts& parts) {
  const ModelPtr box = makeBox(kRigidHalf, 6);
  parts.meshes.push_back(std::make_unique<btTriangleMesh>());
  for (const auto& t : box->mesh.triangles) {
    const auto corner = [&](std::size_t k) { return toBullet(box->mesh.positions[static_cast<std::size_t>(t[k])]); };
    parts.meshes.back()->addTriangle(corner(0), corner(1), corner(2));
  }
  auto mesh = std::make_unique<btGImpactMeshShape>(parts.meshes.back().get());
  mesh->updateBound();
  return mesh;
}

using MakeShape = std::function<std::unique_ptr<btCollisionShape>(ShapeParts&)>;

struct SlabKind {
  std::string name;
  int divisions = 96;    ///< of its longest edge
  bool isPinned = true;  ///< at its bottom; otherwise it lies on the floor
  double wave = 0.0;     ///< height of waves of its upper side, metres
};

/// A rigid body lies on a soft slab 3.2 m long, and is pushed along it.
void slideOnSlab(Run& run, const MakeShape& makeShape, const SlabKind& kind, const Slide& slide) {
  const Vector3d half(1.6, 0.2, 0.3);
  constexpr double kDensity = 100.0, kStart = 1.2;
  ShapeParts parts;
  MeasuringWorld world(run);
  const ModelPtr model = makeWavyBox(half, kind.divisions, kind.wave);
  BodyOptions options;
  options.youngsModulus = 1e6;
  options.mass = kDensity * model->volume;
  options.friction = slide.friction;
  options.sampleSpacing = kind.divisions < 96 ? 1.0 / 60 : 0.0;
  if (kind.isPinned) {
    options.pinned = [bottom = 0.01 - half.y()](const Vector3d& p) { return p.y() < bottom; };
  } else {
    world.addFloor().setFriction(100);
  }
  world.addSoftOn(0.0, model, options);
  const double height = 2 * half.y() + 2 * kMargin * model->size + kRigidHalf.y();
  const Vector3d start = Vector3d(0, height, 0) - kStart * slide.direction;
  btRigidBody& body = world.addRigid(makeShape(parts), at(start), kDensity * 8 * kRigidHalf.prod());
  const bool rolls = body.getCollisionShape()->getShapeType() == CAPSULE_SHAPE_PROXYTYPE;
  if (rolls) body.setAngularFactor(btVector3(0, 1, 1));  // aside, which nothing would resist
  world.simulate(1);
  body.setLinearVelocity(toBullet(Vector3d(slide.speed * slide.direction)));
  measure(run, world, slide, 2 * kRigidHalf.x(), [&] { return toEigen(body.getCenterOfMassPosition()); });
}

void addGroundScenes(ContactScenes& scenes) {
  const std::vector<std::pair<std::string, AddGround>> grounds = {
      {"tiles", addTiles},
      {"hulls", addHulls},
      {"compound", addCompound},
      {"two meshes", addTwoMeshes},
      {"two height fields", addTwoTerrains},
      {"mesh of 2", [](MeasuringWorld& world, ShapeParts&) { addMesh(world, 1); }},
      {"mesh of 20000", [](MeasuringWorld& world, ShapeParts&) { addMesh(world, 100); }},
  };
  const Slide along, across{2.0, 0.1, Vector3d(-0.6, 0, 0.8)};
  for (const auto& [name, add] : grounds) {
    scenes.push_back(
        {"slide over " + name + "/along", [add = add, along](Run& run) { slideSoftBox(run, add, along); }});
    scenes.push_back(
        {"slide over " + name + "/across", [add = add, across](Run& run) { slideSoftBox(run, add, across); }});
  }
}

void addSlabSlides(ContactScenes& scenes) {
  const std::vector<std::pair<std::string, MakeShape>> shapes = {
      {"box", [](ShapeParts&) { return std::make_unique<btBoxShape>(toBullet(kRigidHalf)); }},
      {"capsule", [](ShapeParts&) { return std::make_unique<btCapsuleShapeX>(btScalar(0.1), btScalar(0.3)); }},
      {"hull", [](ShapeParts&) { return bevelled(); }},
      {"compound", nineBoxes},
      {"mesh", movingMesh},
  };
  const auto add = [&](std::size_t shape, const SlabKind& kind, const Slide& slide) {
    scenes.push_back({"slide on slab/" + shapes[shape].first + "/" + kind.name,
                      [make = shapes[shape].second, kind, slide](Run& run) { slideOnSlab(run, make, kind, slide); }});
  };
  const Slide slide{2.0, 0.3};
  for (std::size_t k = 0; k < shapes.size(); ++k) add(k, {"pinned"}, slide);
  add(0, {"fast", 96}, {3.0, 0.3, -Vector3d::UnitX()});
  add(0, {"rough", 96}, {1.0, 0.5});
  add(0, {"free", 96, false}, slide);
  add(0, {"coarse", 16}, slide);
  add(0, {"wavy", 96, true, 0.004}, slide);
  add(0, {"wavelets", 96, true, 0.001}, {3.0, 0.3});
}

}  // namespace

void addSlidingScenes(ContactScenes& scenes) {
  addGroundScenes(scenes);
  addSlabSlides(scenes);
}

}  // namespace tetskin::contact_demo
