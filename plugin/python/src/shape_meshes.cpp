// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "shape_meshes.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tetskin::python {
namespace {

constexpr int kSides = 48;         // of round shapes
constexpr int kQuarterRings = 12;  // from a pole to the equator
constexpr double kPi = 3.14159265358979323846;

/// A point of a profile: its distance from the axis y, and its position along the axis.
struct ProfilePoint {
  double radius, y;
};

/// Revolves a profile, from the bottom to the top, about y.
TriangleMesh turned(const std::vector<ProfilePoint>& profile) {
  TriangleMesh mesh;
  for (const ProfilePoint& point : profile) {
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * kPi * side / kSides;
      mesh.positions.emplace_back(point.radius * std::cos(angle), point.y, -point.radius * std::sin(angle));
    }
  }
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    const int low = static_cast<int>(ring) * kSides, high = low + kSides;
    for (int side = 0; side < kSides; ++side) {
      const int next = (side + 1) % kSides;
      if (profile[ring].radius > 0.0) mesh.triangles.push_back({low + side, low + next, high + side});
      if (profile[ring + 1].radius > 0.0) mesh.triangles.push_back({low + next, high + next, high + side});
    }
  }
  return mesh;
}

/// Hemispheres at the ends of a line of this half length: a ball if it is 0.
std::vector<ProfilePoint> roundedProfile(double radius, double half) {
  std::vector<ProfilePoint> profile;
  for (int end = -1; end <= 1; end += 2) {
    for (int k = 0; k <= kQuarterRings; ++k) {
      const int fromPole = end < 0 ? k : kQuarterRings - k;
      const double angle = 0.5 * kPi * fromPole / kQuarterRings;
      if (end > 0 && k == 0 && half == 0.0) continue;  // the equator exists already
      profile.push_back({fromPole == 0 ? 0.0 : radius * std::sin(angle), end * (half + radius * std::cos(angle))});
    }
  }
  return profile;
}

TriangleMesh boxMesh(const btVector3& half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.positions.emplace_back(half.x() * (k & 1 ? 1 : -1), half.y() * (k & 2 ? 1 : -1), half.z() * (k & 4 ? 1 : -1));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Eigen::Vector3d pointOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

TriangleMesh hullMesh(const btConvexHullShape& shape) {
  btConvexHullComputer hull;
  hull.compute(&shape.getUnscaledPoints()[0].x(), sizeof(btVector3), shape.getNumPoints(), 0, 0);
  TriangleMesh mesh;
  for (int v = 0; v < hull.vertices.size(); ++v) mesh.positions.push_back(pointOf(hull.vertices[v]));
  for (int face = 0; face < hull.faces.size(); ++face) {
    const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[face]];
    const int corner = first->getSourceVertex();
    for (const auto* edge = first->getNextEdgeOfFace(); edge->getTargetVertex() != corner;
         edge = edge->getNextEdgeOfFace()) {
      mesh.triangles.push_back({corner, edge->getSourceVertex(), edge->getTargetVertex()});
    }
  }
  return mesh;
}

struct Gathered : btTriangleCallback {
  void processTriangle(btVector3* corners, int, int) override {
    const auto first = static_cast<int>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(pointOf(corners[k]));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  TriangleMesh mesh;
};

TriangleMesh compoundMesh(const btCompoundShape& compound) {
  TriangleMesh all;
  for (int child = 0; child < compound.getNumChildShapes(); ++child) {
    const TriangleMesh part = meshOf(*compound.getChildShape(child));
    const btTransform& place = compound.getChildTransform(child);
    const auto shift = static_cast<int>(all.positions.size());
    for (const Eigen::Vector3d& p : part.positions) {
      all.positions.push_back(pointOf(
          place * btVector3(static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()), static_cast<btScalar>(p.z()))));
    }
    for (const auto& [a, b, c] : part.triangles) all.triangles.push_back({a + shift, b + shift, c + shift});
  }
  return all;
}

}  // namespace

TriangleMesh meshOf(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return boxMesh(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
    case SPHERE_SHAPE_PROXYTYPE:
      return turned(roundedProfile(static_cast<double>(static_cast<const btSphereShape&>(shape).getRadius()), 0.0));
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return turned(
          roundedProfile(static_cast<double>(capsule.getRadius()), static_cast<double>(capsule.getHalfHeight())));
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
      const auto radius = static_cast<double>(half.x()), y = static_cast<double>(half.y());
      return turned({{0, -y}, {radius, -y}, {radius, y}, {0, y}});
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return hullMesh(static_cast<const btConvexHullShape&>(shape));
    case TRIANGLE_MESH_SHAPE_PROXYTYPE: {
      Gathered gathered;
      const btScalar everywhere = btScalar(1e18);
      static_cast<const btBvhTriangleMeshShape&>(shape).processAllTriangles(
          &gathered, btVector3(-everywhere, -everywhere, -everywhere), btVector3(everywhere, everywhere, everywhere));
      return std::move(gathered.mesh);
    }
    case COMPOUND_SHAPE_PROXYTYPE:
      return compoundMesh(static_cast<const btCompoundShape&>(shape));
    default:
      return {};
  }
}

}  // namespace tetskin::python
