// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "shapes.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <algorithm>

namespace tetskin::facade {
namespace {

/// Bullet's hulls are rounded by their margin; this share of their size is invisible.
constexpr btScalar kHullMargin = btScalar(0.01);

/// A mesh's arrays, to which Bullet refers.
struct MeshArrays {
  std::vector<float> vertices;
  std::vector<int> indices;
  std::unique_ptr<btTriangleIndexVertexArray> interface;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
};

}  // namespace

double positive(double value, const char* name) {
  if (!(value > 0.0 && value < 1e9)) throw std::invalid_argument(std::string(name) + ": must be above 0, and finite");
  return value;
}

ShapeModel plane(const Vec3& normal, double offset) {
  const btVector3 n = toBullet(normal, "normal");
  if (!(n.length2() > 0)) throw std::invalid_argument("normal: must not be 0");
  finite({offset, 0, 0}, "offset");
  return {std::make_shared<btStaticPlaneShape>(n.normalized(), static_cast<btScalar>(offset))};
}
ShapeModel box(const Vec3& halfExtents) {
  for (const double half : halfExtents) positive(half, "half_extents");
  return {std::make_shared<btBoxShape>(toBullet(halfExtents, "half_extents"))};
}
ShapeModel sphere(double radius) {
  return {std::make_shared<btSphereShape>(static_cast<btScalar>(positive(radius, "radius")))};
}
ShapeModel capsule(double radius, double height) {
  return {std::make_shared<btCapsuleShape>(static_cast<btScalar>(positive(radius, "radius")),
                                           static_cast<btScalar>(positive(height, "height")))};
}
ShapeModel cylinder(double radius, double height) {
  const auto r = static_cast<btScalar>(positive(radius, "radius"));
  return {std::make_shared<btCylinderShape>(btVector3(r, static_cast<btScalar>(0.5 * positive(height, "height")), r))};
}

ShapeModel convexHull(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 4) fail(StatusCode::Empty, "points: a hull needs four or more");
  auto hull = std::make_shared<btConvexHullShape>();
  for (const Eigen::Vector3d& p : points) hull->addPoint(toBullet(Vec3{p.x(), p.y(), p.z()}, "points"), false);
  hull->recalcLocalAabb();
  const Eigen::Vector3d sizes = boundingBox(points).sizes();
  if (!(sizes.minCoeff() > 1e-9 * sizes.maxCoeff())) fail(StatusCode::Degenerate, "points: they are in one plane");
  hull->setMargin(std::min(CONVEX_DISTANCE_MARGIN, kHullMargin * static_cast<btScalar>(sizes.maxCoeff())));
  return {std::move(hull)};
}

ShapeModel meshShape(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) fail(StatusCode::Empty, "the mesh has no triangles");
  auto arrays = std::make_shared<MeshArrays>();
  for (const Eigen::Vector3d& p : mesh.positions)
    arrays->vertices.insert(arrays->vertices.end(),
                            {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  for (const auto& triangle : mesh.triangles)
    arrays->indices.insert(arrays->indices.end(), triangle.begin(), triangle.end());
  btIndexedMesh part;
  part.m_numTriangles = static_cast<int>(mesh.triangleCount());
  part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(arrays->indices.data());
  part.m_triangleIndexStride = 3 * sizeof(int);
  part.m_numVertices = static_cast<int>(mesh.vertexCount());
  part.m_vertexBase = reinterpret_cast<const unsigned char*>(arrays->vertices.data());
  part.m_vertexStride = 3 * sizeof(float);
  part.m_vertexType = PHY_FLOAT;
  arrays->interface = std::make_unique<btTriangleIndexVertexArray>();
  arrays->interface->addIndexedMesh(part, PHY_INTEGER);
  arrays->shape = std::make_unique<btBvhTriangleMeshShape>(arrays->interface.get(), true);
  return {std::shared_ptr<btCollisionShape>(arrays, arrays->shape.get())};
}

}  // namespace tetskin::facade
