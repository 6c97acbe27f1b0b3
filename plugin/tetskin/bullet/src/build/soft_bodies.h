// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/src/build/rigid_objects.h>
#include <tetskin/bullet/src/exported/point_search.h>
#include <tetskin/bullet/src/forces/forced_bodies.h>

#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

/// What a DeformableBody was made of, by what is left of it in the body. The state of its nodes is that of the snapshot
/// that follows.
struct BodyParts {
  std::vector<btScalar> nodes;    ///< three per node: where it was created
  std::vector<int> tets;          ///< four per tet
  std::vector<btScalar> rest;     ///< ten per tet: the inverse of its rest matrix, by rows, and its measure
  std::vector<double> restNodes;  ///< three per node, or empty: see elastic_detail::RestTets
  int links = 0, faces = 0;       ///< how many there are
  std::vector<btScalar> masses;
  std::vector<double> stiffnessScale;
  std::vector<QuadraticShape> quadratic;
  ElasticMaterial material;
  SolverSettings settings;
  int forceModel = 0;
  bool faceTree = true;
  double weightPressure = 1.0;
  ObjectFilters filters;

  /// What is in the body itself. Refuses one that no cage could have made.
  void readFrom(BuildStream& stream, const btSoftBody& body);
  void visit(BuildStream& stream);
  /// The body, in no world yet; null: refused.
  std::unique_ptr<btSoftBody> build(BuildStream& stream, const SoftBodyOptions& options) const;
  SoftBodyOptions options() const;
};

/// Describes the contact of a body at its surface, if there is any, or builds it.
std::unique_ptr<PointSearch> buildSurfaceContact(BuildStream& stream, btSoftBody& body);

}  // namespace tetskin::bullet_detail

namespace tetskin {

/// For recorded runs.
template <>
struct Access<DeformableBody> {
  /// Builds a body and adds it to the world; null: refused.
  static std::unique_ptr<DeformableBody> build(bullet_detail::BuildStream& stream);
};

}  // namespace tetskin
