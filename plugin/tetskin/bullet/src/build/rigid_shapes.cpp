// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/src/build/rigid_shapes.h>
#include <tetskin/bullet/src/state/bullet_members.h>
#include <tetskin/bullet/src/state/saved_tree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace tetskin::bullet_detail {

struct CompoundScaling {
  friend btVector3 btCompoundShape::*memberOf(CompoundScaling);
};
template struct Opened<CompoundScaling, &btCompoundShape::m_localScaling>;
struct CompoundLow {
  friend btVector3 btCompoundShape::*memberOf(CompoundLow);
};
template struct Opened<CompoundLow, &btCompoundShape::m_localAabbMin>;
struct CompoundHigh {
  friend btVector3 btCompoundShape::*memberOf(CompoundHigh);
};
template struct Opened<CompoundHigh, &btCompoundShape::m_localAabbMax>;
struct PlaneNormal {
  friend btVector3 btStaticPlaneShape::*memberOf(PlaneNormal);
};
template struct Opened<PlaneNormal, &btStaticPlaneShape::m_planeNormal>;

namespace {

/// Compounds within compounds, in a file that is damaged.
constexpr int kMaxDepth = 16;

void requireFinite(BuildStream& stream, std::initializer_list<btVector3> numbers) {
  for (const btVector3& v : numbers) {
    for (int k = 0; k < 3; ++k) stream.require(std::isfinite(v[k]), "a shape is not finite");
  }
}

/// What a convex shape is beyond its class: exact, as its constructor's arguments would not be.
struct ConvexSize {
  btVector3 dimensions{0, 0, 0}, scaling{1, 1, 1};
  btScalar margin = 0;

  void visit(BuildStream& stream) {
    stream(dimensions);
    stream(scaling);
    stream(margin);
    requireFinite(stream, {dimensions, scaling, btVector3(margin, 0, 0)});
  }
};

ConvexSize sizeOf(const btConvexInternalShape& shape) {
  return {shape.getImplicitShapeDimensions(), shape.getLocalScalingNV(), shape.getMarginNV()};
}

/// By the functions of the base class: those of boxes and others change the dimensions by the margin.
void setSize(btConvexInternalShape& shape, const ConvexSize& size) {
  shape.btConvexInternalShape::setLocalScaling(size.scaling);
  shape.btConvexInternalShape::setMargin(size.margin);
  shape.setImplicitShapeDimensions(size.dimensions);
}

/// Of capsules, cylinders and cones, the axis.
int axisOf(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case CAPSULE_SHAPE_PROXYTYPE:
      return static_cast<const btCapsuleShape&>(shape).getUpAxis();
    case CYLINDER_SHAPE_PROXYTYPE:
      return static_cast<const btCylinderShape&>(shape).getUpAxis();
    case CONE_SHAPE_PROXYTYPE:
      return static_cast<const btConeShape&>(shape).getConeUpIndex();
    default:
      return 1;
  }
}

std::shared_ptr<btConvexInternalShape> alongAxis(int type, int axis, btScalar radius, btScalar height) {
  const btVector3 half(1, 1, 1);
  switch (type * 3 + axis) {
    case CAPSULE_SHAPE_PROXYTYPE * 3:
      return std::make_shared<btCapsuleShapeX>(btScalar(1), btScalar(1));
    case CAPSULE_SHAPE_PROXYTYPE * 3 + 1:
      return std::make_shared<btCapsuleShape>(btScalar(1), btScalar(1));
    case CAPSULE_SHAPE_PROXYTYPE * 3 + 2:
      return std::make_shared<btCapsuleShapeZ>(btScalar(1), btScalar(1));
    case CYLINDER_SHAPE_PROXYTYPE * 3:
      return std::make_shared<btCylinderShapeX>(half);
    case CYLINDER_SHAPE_PROXYTYPE * 3 + 1:
      return std::make_shared<btCylinderShape>(half);
    case CYLINDER_SHAPE_PROXYTYPE * 3 + 2:
      return std::make_shared<btCylinderShapeZ>(half);
    case CONE_SHAPE_PROXYTYPE * 3:
      return std::make_shared<btConeShapeX>(radius, height);
    case CONE_SHAPE_PROXYTYPE * 3 + 1:
      return std::make_shared<btConeShape>(radius, height);
    case CONE_SHAPE_PROXYTYPE * 3 + 2:
      return std::make_shared<btConeShapeZ>(radius, height);
    default:
      return nullptr;
  }
}

std::shared_ptr<btCollisionShape> buildConvex(BuildStream& stream, int type, const btCollisionShape* shape) {
  ConvexSize size;
  int axis = 1;
  btScalar radius = 1, height = 1;
  if (shape) {
    size = sizeOf(static_cast<const btConvexInternalShape&>(*shape));
    axis = axisOf(*shape);
    if (type == CONE_SHAPE_PROXYTYPE) {
      radius = static_cast<const btConeShape*>(shape)->getRadius();
      height = static_cast<const btConeShape*>(shape)->getHeight();
    }
  }
  size.visit(stream);
  visitAll(stream, axis, radius, height);
  stream.require(axis >= 0 && axis < 3 && std::isfinite(radius) && std::isfinite(height), "a shape is not finite");
  if (shape || stream.failed()) return nullptr;
  std::shared_ptr<btConvexInternalShape> made;
  if (type == BOX_SHAPE_PROXYTYPE) {
    made = std::make_shared<btBoxShape>(btVector3(1, 1, 1));
  } else if (type == SPHERE_SHAPE_PROXYTYPE) {
    made = std::make_shared<btSphereShape>(btScalar(1));
  } else {
    made = alongAxis(type, axis, radius, height);
  }
  setSize(*made, size);
  return made;
}

std::shared_ptr<btCollisionShape> buildPlane(BuildStream& stream, const btStaticPlaneShape* shape) {
  btVector3 normal = shape ? shape->getPlaneNormal() : btVector3(0, 1, 0);
  btVector3 scaling = shape ? shape->getLocalScaling() : btVector3(1, 1, 1);
  btScalar constant = shape ? shape->getPlaneConstant() : 0, margin = shape ? shape->getMargin() : 0;
  visitAll(stream, normal, scaling, constant, margin);
  requireFinite(stream, {normal, scaling, btVector3(constant, margin, 0)});
  if (shape || stream.failed()) return nullptr;
  auto made = std::make_shared<btStaticPlaneShape>(normal, constant);
  (*made).*memberOf(PlaneNormal()) = normal;  // the constructor has normalized it, which may change its last digit
  made->setLocalScaling(scaling);
  made->setMargin(margin);
  return made;
}

std::shared_ptr<btCollisionShape> buildHull(BuildStream& stream, const btConvexHullShape* shape) {
  if (shape && shape->getConvexPolyhedron()) stream.refuse("a convex hull with polyhedral features");
  std::vector<btVector3> points;
  for (int k = 0; shape && k < shape->getNumPoints(); ++k) points.push_back(shape->getUnscaledPoints()[k]);
  ConvexSize size;
  if (shape) size = sizeOf(*shape);
  stream.each(points, [&](btVector3& point) {
    stream(point);
    requireFinite(stream, {point});
  });
  size.visit(stream);
  if (shape || stream.failed()) return nullptr;
  auto made = std::make_shared<btConvexHullShape>();
  for (const btVector3& point : points) made->addPoint(point, false);
  made->setMargin(size.margin);
  made->setLocalScaling(size.scaling);
  made->recalcLocalAabb();
  return made;
}

/// The triangles of one part of a mesh.
struct MeshPart {
  std::vector<btScalar> positions;  ///< three per vertex, unscaled
  std::vector<int> indices;         ///< three per triangle
};

struct MeshData {
  std::vector<MeshPart> parts;
  btTriangleIndexVertexArray triangles;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
};

void readVertices(const unsigned char* from, int count, PHY_ScalarType type, int stride, std::vector<btScalar>& to) {
  for (int v = 0; v < count; ++v, from += stride) {
    for (int k = 0; k < 3; ++k) {
      to.push_back(type == PHY_DOUBLE ? static_cast<btScalar>(reinterpret_cast<const double*>(from)[k])
                                      : static_cast<btScalar>(reinterpret_cast<const float*>(from)[k]));
    }
  }
}

int indexAt(const unsigned char* from, PHY_ScalarType type, int k) {
  switch (type) {
    case PHY_SHORT:
      return reinterpret_cast<const unsigned short*>(from)[k];
    case PHY_UCHAR:
      return from[k];
    default:
      return reinterpret_cast<const int*>(from)[k];
  }
}

std::vector<MeshPart> partsOf(const btStridingMeshInterface& mesh) {
  std::vector<MeshPart> parts(static_cast<std::size_t>(mesh.getNumSubParts()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const unsigned char *vertices = nullptr, *indices = nullptr;
    int vertexCount = 0, vertexStride = 0, indexStride = 0, faces = 0;
    PHY_ScalarType vertexType = PHY_FLOAT, indexType = PHY_INTEGER;
    mesh.getLockedReadOnlyVertexIndexBase(&vertices, vertexCount, vertexType, vertexStride, &indices, indexStride,
                                          faces, indexType, static_cast<int>(p));
    readVertices(vertices, vertexCount, vertexType, vertexStride, parts[p].positions);
    for (int f = 0; f < faces; ++f, indices += indexStride) {
      for (int k = 0; k < 3; ++k) parts[p].indices.push_back(indexAt(indices, indexType, k));
    }
    mesh.unLockReadOnlyVertexBase(static_cast<int>(p));
  }
  return parts;
}

bool isValid(const std::vector<MeshPart>& parts) {
  std::size_t triangles = 0;
  for (const MeshPart& part : parts) {
    if (part.positions.size() % 3 != 0 || part.indices.size() % 3 != 0) return false;
    for (const btScalar x : part.positions) {
      if (!std::isfinite(x)) return false;
    }
    for (const int index : part.indices) {
      if (index < 0 || static_cast<std::size_t>(index) >= part.positions.size() / 3) return false;
    }
    triangles += part.indices.size() / 3;
  }
  return triangles > 0;
}

std::shared_ptr<btCollisionShape> buildMesh(BuildStream& stream, const btBvhTriangleMeshShape* shape) {
  auto data = std::make_shared<MeshData>();
  btVector3 scaling(1, 1, 1);
  btScalar margin = 0;
  bool quantized = true;
  if (shape) {
    data->parts = partsOf(*shape->getMeshInterface());
    scaling = shape->getMeshInterface()->getScaling();
    margin = shape->getMargin();
    quantized = shape->usesQuantizedAabbCompression();
  }
  visitAll(stream, scaling, margin, quantized);
  requireFinite(stream, {scaling, btVector3(margin, 0, 0)});
  stream.copied([&](BuildStream& bytes) {
    bytes.each(data->parts, [&](MeshPart& part) {
      bytes.array(part.positions);
      bytes.array(part.indices);
    });
  });
  stream.require(isValid(data->parts), "a mesh has triangles without corners, or none");
  if (shape || stream.failed()) return nullptr;
  for (MeshPart& part : data->parts) {
    btIndexedMesh mesh;
    mesh.m_numTriangles = static_cast<int>(part.indices.size() / 3);
    mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(part.indices.data());
    mesh.m_triangleIndexStride = 3 * sizeof(int);
    mesh.m_numVertices = static_cast<int>(part.positions.size() / 3);
    mesh.m_vertexBase = reinterpret_cast<const unsigned char*>(part.positions.data());
    mesh.m_vertexStride = 3 * sizeof(btScalar);
    mesh.m_vertexType = sizeof(btScalar) == sizeof(double) ? PHY_DOUBLE : PHY_FLOAT;
    data->triangles.addIndexedMesh(mesh);
  }
  data->triangles.setScaling(scaling);
  data->shape = std::make_unique<btBvhTriangleMeshShape>(&data->triangles, quantized);
  data->shape->setMargin(margin);
  return {data, data->shape.get()};
}

struct CompoundData {
  std::vector<std::shared_ptr<btCollisionShape>> children;
  std::unique_ptr<btCompoundShape> shape;
};

std::shared_ptr<btCollisionShape> buildAnyShape(BuildStream& stream, const btCollisionShape* shape, int depth);

std::shared_ptr<btCollisionShape> buildSharedShape(BuildStream& stream, const btCollisionShape* shape, int depth) {
  return stream.shared(SharedKind::CollisionShape, shape, [&] { return buildAnyShape(stream, shape, depth); });
}

/// Returns false if it is no tree of the children.
bool takeTree(const SavedTree& nodes, btCompoundShape& shape) {
  std::vector<char> taken(static_cast<std::size_t>(shape.getNumChildShapes()), 0);
  const auto takes = [&](int child) {
    return child < shape.getNumChildShapes() && !taken[static_cast<std::size_t>(child)]++;
  };
  if (!isTree(nodes, takes) || std::count(taken.begin(), taken.end(), 0) > 0) return false;
  makeTree(nodes, *shape.getDynamicAabbTree(), [&](int child, btDbvtNode& leaf) {
    leaf.data = nullptr;
    leaf.dataAsInt = child;
    shape.getChildList()[child].m_node = &leaf;
  });
  return true;
}

std::shared_ptr<btCollisionShape> buildCompound(BuildStream& stream, const btCompoundShape* shape, int depth) {
  auto data = std::make_shared<CompoundData>();
  bool tree = shape && shape->getDynamicAabbTree();
  btVector3 scaling = shape ? shape->getLocalScaling() : btVector3(1, 1, 1);
  btScalar margin = shape ? shape->getMargin() : 0;
  btVector3 low(0, 0, 0), high(0, 0, 0);
  SavedTree nodes;
  if (shape) {
    low = shape->*memberOf(CompoundLow());
    high = shape->*memberOf(CompoundHigh());
    if (tree)
      readTree(
          shape->getDynamicAabbTree()->m_root, [](const btDbvtNode& leaf) { return leaf.dataAsInt; }, nodes);
  }
  visitAll(stream, tree, scaling, margin, low, high);
  visitTree(stream, nodes);
  for (const SavedNode& node : nodes) requireFinite(stream, {node.low, node.high});
  requireFinite(stream, {scaling, low, high, btVector3(margin, 0, 0)});
  const std::size_t count = stream.length(shape ? static_cast<std::size_t>(shape->getNumChildShapes()) : 0);
  if (!shape) data->shape = std::make_unique<btCompoundShape>(tree);
  for (std::size_t k = 0; k < count && !stream.failed(); ++k) {
    const int child = static_cast<int>(k);
    btTransform place = shape ? shape->getChildTransform(child) : btTransform::getIdentity();
    stream(place);
    requireFinite(stream, {place.getBasis()[0], place.getBasis()[1], place.getBasis()[2], place.getOrigin()});
    std::shared_ptr<btCollisionShape> made =
        buildSharedShape(stream, shape ? shape->getChildShape(child) : nullptr, depth + 1);
    if (!made) continue;
    data->shape->addChildShape(place, made.get());
    data->children.push_back(std::move(made));
  }
  if (shape || stream.failed()) return nullptr;
  data->shape->setMargin(margin);
  // The children, and their places, are scaled already.
  (*data->shape).*memberOf(CompoundScaling()) = scaling;
  // Children that have been moved since have left another tree, and their box is the application's to renew.
  (*data->shape).*memberOf(CompoundLow()) = low;
  (*data->shape).*memberOf(CompoundHigh()) = high;
  if (tree && !takeTree(nodes, *data->shape)) stream.fail();
  if (stream.failed()) return nullptr;
  return {data, data->shape.get()};
}

std::shared_ptr<btCollisionShape> buildEmpty(BuildStream& stream, const btCollisionShape* shape) {
  btScalar margin = shape ? shape->getMargin() : 0;
  stream(margin);
  requireFinite(stream, {btVector3(margin, 0, 0)});
  if (shape || stream.failed()) return nullptr;
  auto made = std::make_shared<btEmptyShape>();
  made->setMargin(margin);
  return made;
}

std::shared_ptr<btCollisionShape> buildAnyShape(BuildStream& stream, const btCollisionShape* shape, int depth) {
  int type = shape ? shape->getShapeType() : 0;
  stream(type);
  stream.require(depth < kMaxDepth, "compounds are nested too deeply");
  if (stream.failed()) return nullptr;
  switch (type) {
    case BOX_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
    case CYLINDER_SHAPE_PROXYTYPE:
    case CONE_SHAPE_PROXYTYPE:
      return buildConvex(stream, type, shape);
    case STATIC_PLANE_PROXYTYPE:
      return buildPlane(stream, static_cast<const btStaticPlaneShape*>(shape));
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return buildHull(stream, static_cast<const btConvexHullShape*>(shape));
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
      return buildMesh(stream, static_cast<const btBvhTriangleMeshShape*>(shape));
    case COMPOUND_SHAPE_PROXYTYPE:
      return buildCompound(stream, static_cast<const btCompoundShape*>(shape), depth);
    case EMPTY_SHAPE_PROXYTYPE:
      return buildEmpty(stream, shape);
    default:
      stream.refuse(std::string("a collision shape of the kind ") + (shape ? shape->getName() : "of a later version"));
      return nullptr;
  }
}

}  // namespace

std::shared_ptr<btCollisionShape> buildShape(BuildStream& stream, const btCollisionShape* shape) {
  return buildSharedShape(stream, shape, 0);
}

}  // namespace tetskin::bullet_detail
