// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Cages and surfaces computed from integers, quotients and square roots, which are the same on every machine.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/core/mesh.h>

#include <memory>

namespace tetskin::test {

/// A surface in a cage, about the origin.
struct ReplayModel {
  TetMesh cage;
  TriangleMesh mesh;
  std::shared_ptr<const SoftBodyBinding> binding;
  /// Created by the first call.
  const std::shared_ptr<const ContactShape>& shape();

 private:
  std::shared_ptr<const ContactShape> shape_;
};

/// A ball of radius 0.46875 in a cage of `cubes`^3 cubes, 1 long: a cube whose sides have `squares`^2 squares, pushed
/// out.
ReplayModel ballModel(int cubes, int squares);
/// A bar along x of `length` x `width` x `width` cubes of this edge, whose surface is a third of a cube inside of it.
ReplayModel barModel(int length, int width, double edge);

TetMesh movedBy(TetMesh mesh, const Eigen::Vector3d& offset);

}  // namespace tetskin::test
