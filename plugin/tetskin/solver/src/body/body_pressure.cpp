// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/solver/src/body/body_in_world.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tetskin {

using namespace bullet_detail;

namespace {

Result<elastic_detail::PressureSurface> embeddedSurface(const TriangleMesh& mesh, const Embedding& embedding,
                                                        const Dynamics& dynamics) {
  if (embedding.vertexCount() != mesh.vertexCount() || embedding.nodeCount() != dynamics.nodeCount()) {
    return Status{StatusCode::SizeMismatch, "the mesh, its embedding and the body do not belong together"};
  }
  if (Status status = validate(mesh); !status.ok()) return status;
  std::vector<std::array<double, 3>> positions;
  std::vector<elastic_detail::SurfaceVertex> vertices;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const EmbeddedPoint<double> point = embedding.at(v);
    const Eigen::Vector3d& x = mesh.positions[v];
    positions.push_back({x[0], x[1], x[2]});
    auto& vertex = vertices.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) vertex[k] = {point.nodes[k], point.weights[k]};
  }
  const auto partOf = [&](int vertex) {
    return dynamics.componentOf(static_cast<std::size_t>(vertices[static_cast<std::size_t>(vertex)][0].first));
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (partOf(a) != partOf(b) || partOf(b) != partOf(c))
      return invalid("the mesh joins parts of the cage that are not connected");
  }
  return elastic_detail::PressureSurface::ofMesh(positions, mesh.triangles, vertices);
}

}  // namespace

Status DeformableBody::setPressure(double pressure) {
  if (Status status = impl_->checkPressed("setPressure"); !status.ok()) return status;
  if (Status status = checkPressure(body(), pressure); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  if (Status status = forced.pressure.setConstant(pressure, *forced.dynamics); !status.ok()) return status;
  body().activate();
  return {};
}

Status DeformableBody::setGas(double pressure, double outside) {
  if (Status status = impl_->checkPressed("setGas"); !status.ok()) return status;
  if (Status status = checkGas(body(), pressure, outside); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  if (Status status = forced.pressure.setGas(pressure, outside, forced.probe(), *forced.dynamics); !status.ok())
    return status;
  body().activate();
  return {};
}

double DeformableBody::pressure() const {
  if (!impl_->corotated() || !impl_->corotated()->body().hasOwnCounts()) return 0.0;
  ForcedBody& forced = impl_->corotated()->body();
  return forced.pressure.pressure(forced.probe(), *forced.dynamics);
}

double DeformableBody::volume() const {
  if (!impl_->corotated() || !impl_->corotated()->body().hasOwnCounts()) return 0.0;
  ForcedBody& forced = impl_->corotated()->body();
  return forced.pressure.volume(forced.probe(), *forced.dynamics);
}

Status DeformableBody::setPressureSurface(const TriangleMesh& mesh, const Embedding& embedding) {
  if (Status status = impl_->checkPressed("setPressureSurface"); !status.ok()) return status;
  ForcedBody& forced = impl_->corotated()->body();
  std::shared_ptr<elastic_detail::PressureSurface> surface;
  if (!embedding.empty() || mesh.vertexCount() > 0 || !mesh.triangles.empty()) {
    Result<elastic_detail::PressureSurface> made = embeddedSurface(mesh, embedding, *forced.dynamics);
    if (!made.ok()) return {made.status().code, "setPressureSurface: " + made.status().message};
    surface = std::make_shared<elastic_detail::PressureSurface>(std::move(made).value());
  }
  if (Status status = forced.pressure.setSurface(std::move(surface), forced.probe(), *forced.dynamics); !status.ok())
    return status;
  body().activate();
  return {};
}

void DeformableBody::preparePressureSurface(std::shared_ptr<const TriangleMesh> mesh, const Embedding& embedding) {
  if (!impl_->corotated() || !mesh) return;
  ForcedBody& forced = impl_->corotated()->body();
  forced.pressure.offerSurface(
      [&forced, mesh = std::move(mesh), embedding] { return embeddedSurface(*mesh, embedding, *forced.dynamics); });
}

}  // namespace tetskin
