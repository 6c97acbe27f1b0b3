// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A whole run in one file: GLB, a skinned mesh that every engine and viewer plays, and PC2, a cache of all positions.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace tetskin {

/// The look of a material. Groups of a mesh refer to it by `TriangleGroup::material`.
struct SurfaceMaterial {
  std::string name;                                          ///< as groups name it
  Eigen::Vector3f colour = Eigen::Vector3f::Constant(0.8f);  ///< red, green and blue, 0 to 1, sRGB
  float opacity = 1.0f;                                      ///< below 1: transparent
  float roughness = 0.8f;                                    ///< 0: a mirror, 1: matt
};

/// Writes bodies that follow the nodes of their cages, and rigid objects, as one animation: binary glTF 2.0, which
/// holds each mesh once and the bones' motion per frame, in a hundredth of the size of an OBJ sequence.
///
/// Each node of a cage that carries a vertex is a bone, and each vertex follows the four bones of its tet:
/// - Linear: bones only translate, which is exactly linear skinning. The mesh has no normals, because bones that do not
///   turn would keep them as at rest: viewers shade such a mesh flat, by its triangles.
/// - Quadratic: bone i is the affine map [F_i / 2 | x_i - F_i X_i / 2], with its position x_i, X_i at rest, and the
///   deformation gradient F_i there. This is quadratic skinning, except where that limits its correction (`MeshSkin`),
///   and in quadratic tets, where it uses the tet's own map. A bone is two nodes, a rotation and a scale above a
///   rotation: as F = U S V^T, they can hold any F. The mesh has normals, which viewers turn with the bones, about as
///   the surface turns.
///
/// A vertex outside of its tet would need negative weights, which glTF does not allow: it gets those of the tet's
/// closest point (`EmbeddedPoint::clampedWeights`). A linear surface then keeps the vector from that point to the
/// vertex as at rest, instead of turning it with the tet; a quadratic one differs to second order in its length.
///
/// Coordinates are float. For bodies that are far from the origin for their size, they are relative to a nearby point,
/// stored as `origin` in the scene's `extras`.
/// Memory: the keyframes, 12 bytes per bone and frame, 56 if quadratic, until `finish`. Can be moved, not copied. After
/// `finish`, and after being moved from, every call returns FileNotWritable, or does nothing if it has no status.
class TETSKIN_IO_API GlbWriter {
 public:
  /// Why this build cannot write GLB: it was built without tinygltf. Empty if it can.
  static std::string whyNot();

  /// Creates a writer, still empty, and tests whether the file can be written.
  /// framesPerSecond  above 0
  /// Errors  UnsupportedFormat if `whyNot`; FileNotWritable; InvalidOption: an invalid rate
  static Result<GlbWriter> create(const std::string& path, double framesPerSecond);
  ~GlbWriter();
  GlbWriter(GlbWriter&& other) noexcept;
  GlbWriter& operator=(GlbWriter&& other) noexcept;

  /// Sets the looks of materials. Groups with other materials are light grey.
  void setMaterials(std::vector<SurfaceMaterial> materials);

  // The content, before the first frame.

  /// Adds a mesh in its cage at rest, which any number of bodies may share. Returns its number, from 0. Nothing is
  /// kept.
  /// embedding  of the mesh in the cage
  /// Errors     Empty for a mesh without triangles; those of `SkinBinding::create`; TooLarge: 65,536 bones or more
  Result<std::size_t> addModel(const std::string& name, const Cage& cage, const TriangleMesh& mesh,
                               const Embedding& embedding, Interpolation interpolation);
  /// Adds a body of a model, below the number of models.
  void addBody(std::size_t model, const std::string& name);
  /// Adds a rigid object, which moves or stays in place. Error: Empty for a mesh without triangles.
  Status addObject(const std::string& name, const TriangleMesh& mesh, bool moves);

  /// Approximate size of the file, in bytes, with this number of frames.
  double bytesFor(int frames) const;

  /// Adds the next frame.
  /// nodes   by body: its cage's nodes, nodeCount x 3, world space
  /// places  by moving object: a rigid motion
  /// Errors  SizeMismatch; NonFinite; TooLarge: beyond the 4 GB limit of a GLB
  Status addFrame(const std::vector<PointView<const double>>& nodes, const std::vector<Eigen::Affine3d>& places = {});

  /// Writes the file, complete or not at all. The writer is then empty. Cost: some 10 ns per byte.
  /// Errors: Empty without frames; FileNotWritable.
  Status finish();

 private:
  struct Impl;
  explicit GlbWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;  ///< null after `finish`
};

/// Writes the positions of a deforming mesh's vertices in every frame: the point cache PC2, which Blender (modifier
/// Mesh Cache), Maya and 3ds Max apply to a mesh with as many vertices in the same order. It holds any deformation, as
/// floats: 32 bytes, and 12 per vertex and frame. Can be moved, not copied; without `finish`, no file is left. After
/// `finish`, and after being moved from, every call returns FileNotWritable.
class TETSKIN_IO_API Pc2Writer {
 public:
  /// Creates a writer.
  /// vertexCount  of the mesh
  /// first, step  the number of the first frame, and from one frame to the next; Blender ignores both
  /// Errors       FileNotWritable, also for anything but a regular file; TooLarge: 2^31 vertices or more
  static Result<Pc2Writer> create(const std::string& path, std::size_t vertexCount, float first = 0.0f,
                                  float step = 1.0f);
  ~Pc2Writer();
  Pc2Writer(Pc2Writer&& other) noexcept;
  Pc2Writer& operator=(Pc2Writer&& other) noexcept;

  /// Appends a frame to the file, which does not have its final name yet. Positions are vertexCount x 3, finite.
  /// Errors: SizeMismatch; NonFinite; FileNotWritable.
  Status addFrame(PointView<const float> positions);
  /// Overload for positions in double, which are rounded to float.
  Status addFrame(PointView<const double> positions);

  /// Completes the file, and gives it its name. Errors: Empty without frames; FileNotWritable.
  Status finish();

 private:
  struct Impl;
  explicit Pc2Writer(std::unique_ptr<Impl> impl);
  template <class Scalar>
  Status add(PointView<const Scalar> positions);
  std::unique_ptr<Impl> impl_;  ///< null after `finish`
};

}  // namespace tetskin
