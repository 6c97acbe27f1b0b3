// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "models.h"

#include <tetskin/io/files.h>

namespace tetskin::python {
namespace {

template <class Vector>
std::vector<Vector> floatRows(const std::optional<ArrayLike>& array, const char* name, int columns) {
  std::vector<Vector> rows;
  if (!array) return rows;
  const Numbers<double> numbers(*array, name, columns);
  rows.resize(numbers.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (int k = 0; k < columns; ++k)
      rows[i][k] =
          static_cast<float>(numbers.data()[i * static_cast<std::size_t>(columns) + static_cast<std::size_t>(k)]);
  }
  return rows;
}

/// names  of positions and triangles, as the caller knows them
MeshModel made(const ArrayLike& positions, const ArrayLike& triangles, const std::optional<ArrayLike>& normals,
               const std::optional<ArrayLike>& texcoords,
               const std::array<const char*, 2>& names = {"positions", "triangles"}) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = pointsOf(positions, names[0]);
  mesh->triangles = indexRowsOf<3>(triangles, names[1]);
  mesh->normals = floatRows<Eigen::Vector3f>(normals, "normals", 3);
  mesh->texcoords = floatRows<Eigen::Vector2f>(texcoords, "texcoords", 2);
  checkMesh(*mesh);
  return {std::move(mesh)};
}

MeshModel loaded(const PathLike& path) {
  MeshFileReport report;
  Result<TriangleMesh> mesh = released([&, name = path.text()] { return loadMesh(name, &report); });
  if (mesh.status().code == StatusCode::UnsupportedFormat) {
    fail(StatusCode::UnsupportedFormat, mesh.status().message +
                                            "\nThis package reads OBJ, PLY, STL, OFF and glTF 2.0. trimesh reads more: "
                                            "tetskin.create_cage(trimesh.load_mesh(path)), for one, takes its meshes");
  }
  return {std::make_shared<const TriangleMesh>(take(std::move(mesh)))};
}

/// The texture coordinates of a trimesh mesh, if it has a pair for each vertex.
std::optional<ArrayLike> texcoordsOf(const nb::object& mesh) {
  const nb::object visual = nb::getattr(mesh, "visual", nb::none());
  const nb::object uv = nb::getattr(visual, "uv", nb::none());
  if (uv.is_none()) return {};
  const nb::object array = nb::module_::import_("numpy").attr("asarray")(uv);
  const nb::object shape = nb::make_tuple(nb::len(nb::object(mesh.attr("vertices"))), 2);
  if (!array.attr("shape").equal(shape)) return {};
  return ArrayLike{array};
}

}  // namespace

MeshModel meshOf(const MeshLike& mesh) {
  if (nb::isinstance<MeshModel>(mesh.object)) return nb::cast<MeshModel>(mesh.object);
  if (nb::hasattr(mesh.object, "geometry") && nb::hasattr(mesh.object, "to_mesh")) {
    throw nb::type_error("mesh: a scene of trimesh; scene.to_mesh() joins its meshes into one, which is taken here");
  }
  const auto has = [&](const char* attribute) { return nb::hasattr(mesh.object, attribute); };
  const auto plain = [](const nb::object& array) {
    return ArrayLike{nb::module_::import_("numpy").attr("asarray")(array)};
  };
  for (const char* const triangles : {"faces", "triangles"}) {
    if (!has("vertices") || !has(triangles)) continue;
    return made(plain(mesh.object.attr("vertices")), plain(mesh.object.attr(triangles)), {}, texcoordsOf(mesh.object),
                {"vertices", triangles});
  }
  if (has("points") && has("get_cells_type")) {
    return made(plain(mesh.object.attr("points")), plain(mesh.object.attr("get_cells_type")("triangle")), {}, {},
                {"points", "cells"});
  }
  throw nb::type_error(
      "mesh: neither a tetskin.TriangleMesh nor a mesh with `vertices` and `faces`, as trimesh has them, `vertices` "
      "and `triangles` (Open3D), or `points` and `cells` (meshio)");
}

void bindMeshes(nb::module_& module) {
  Class<MeshModel>(module, "TriangleMesh",
                   "A render mesh at rest. Immutable; can be pickled. Vertices may coincide, surfaces may be open, "
                   "and there may be several components.")
      .words([](const MeshModel& m) {
        return counted(m.mesh->vertexCount(), "vertex", "vertices") + ", " +
               counted(m.mesh->triangleCount(), "triangle", "triangles");
      })
      .pickled(meshOfBytes)
      .def(
          "__init__",
          [](MeshModel* self, const ArrayLike& positions, const ArrayLike& triangles,
             const std::optional<ArrayLike>& normals, const std::optional<ArrayLike>& texcoords) {
            new (self) MeshModel(made(positions, triangles, normals, texcoords));
          },
          "positions"_a, "triangles"_a, nb::kw_only(), "normals"_a = nb::none(), "texcoords"_a = nb::none(),
          "positions: (n, 3) numbers, any unit; triangles: (m, 3) integers, counter-clockwise from outside; "
          "normals: (n, 3), unit length, or None; texcoords: (n, 2), or None.")
      .def_prop_ro(
          "positions", [](const MeshModel& m) { return view3(viewOf(m.mesh->positions), m.mesh); },
          "(n, 3) float64, rest space, the file's own unit. A read-only view.")
      .def_prop_ro(
          "triangles",
          [](const MeshModel& m) {
            return view3<int>(m.mesh->triangles.empty() ? nullptr : m.mesh->triangles[0].data(),
                              m.mesh->triangleCount(), m.mesh);
          },
          "(m, 3) int32 vertex indices, counter-clockwise from outside. A read-only view.")
      .def_prop_ro(
          "normals", [](const MeshModel& m) { return view3(viewOf(m.mesh->normals), m.mesh); },
          "(n, 3) float32 authored unit normals, or (0, 3). A read-only view.")
      .def_prop_ro(
          "texcoords",
          [](const MeshModel& m) {
            const std::size_t shape[2] = {m.mesh->texcoords.size(), 2};
            static const float none[2] = {};
            return Row2<float>(m.mesh->texcoords.empty() ? none : m.mesh->texcoords[0].data(), 2, shape, kept(m.mesh));
          },
          "(n, 2) float32 texture coordinates, or (0, 2). A read-only view.")
      .def_prop_ro(
          "vertex_count", [](const MeshModel& m) { return m.mesh->vertexCount(); }, "Number of vertices.")
      .def_prop_ro(
          "triangle_count", [](const MeshModel& m) { return m.mesh->triangleCount(); }, "Number of triangles.");

  module.def(
      "load_vertex_map",
      [](const PathLike& path, const std::string& name) {
        return newColumn(released([&, file = path.text()] { return take(loadVertexMap(file, name)); }));
      },
      "path"_a, "name"_a,
      "Reads a map painted on the mesh of load_mesh: (vertices,) float64. name: a property of a .ply file's vertices; "
      "an attribute, such as _STIFFNESS, of a glTF file; or red, green, blue or alpha, of vertex colours of these and "
      ".obj, from 0 to 1.");
  module.def(
      "load_mesh", loaded, "path"_a,
      "Reads a render mesh: .obj, .ply, .stl, .off, and .gltf, .glb and .vrm of glTF 2.0. Other formats: trimesh, "
      "whose meshes, and those of Open3D and meshio, are taken wherever a TriangleMesh is.");
}

}  // namespace tetskin::python
