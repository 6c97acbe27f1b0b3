// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/surface_errors.h"

#include <algorithm>
#include <cmath>

#include "report/cage_skin.h"
#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

/// Approximate number of samples of SampledErrors.
constexpr std::size_t kSamples = 1000;
constexpr double kDegrees = 57.29577951308232;

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A surface carried by a cage.
class CarriedSurface {
 public:
  CarriedSurface(const Cage& cage, const TriangleMesh& mesh, SurfaceKind kind) {
    BindingOptions options;
    options.interpolation = interpolationOf(kind);
    options.normals = Normals::Transformed;
    skin_ = skinOf(cage, mesh, options);
  }

  void update(const std::vector<Eigen::Vector3f>& nodes) {
    const Points current = toDouble(nodes);
    if (skin_.update(viewOf(current)) != StatusCode::Ok)
      throw scenes::InputError("a cage has node positions that are not finite");
  }
  Eigen::Vector3d position(std::size_t v) const { return Eigen::Map<const Eigen::Vector3d>(skin_.positions()[v]); }
  Eigen::Vector3d normal(std::size_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(skin_.normals()[v]).cast<double>();
  }

 private:
  MeshSkin<double> skin_;
};

}  // namespace

SurfaceErrors surfaceErrors(Reference& reference, const TriangleMesh& mesh, const Cage& cage, SurfaceKind kind,
                            const Trajectory& nodes) {
  const double diagonal = boundingBox(mesh.positions).diagonal().norm();
  const std::size_t count = mesh.vertexCount();
  CarriedSurface surface(cage, mesh, kind);
  SurfaceErrors errors;
  std::vector<double> squaredByVertex(count, 0.0);
  double squared = 0.0, degrees = 0.0;
  for (std::size_t frame = 1; frame < nodes.size(); ++frame) {
    const ReferenceSurface& right = reference.surfaceAt(static_cast<int>(frame));
    surface.update(nodes[frame]);
    double squaredInFrame = 0.0, moved = 0.0;
    for (std::size_t v = 0; v < count; ++v) {
      const double distance = (surface.position(v) - right.positions[v]).norm() / diagonal;
      squaredInFrame += distance * distance;
      squaredByVertex[v] += distance * distance;
      moved += ((right.positions[v] - mesh.positions[v]) / diagonal).squaredNorm();
      errors.max = std::max(errors.max, distance);
      degrees += angle(surface.normal(v), right.normals[v]);
    }
    squared += squaredInFrame;
    errors.amplitudeByFrame.push_back(std::sqrt(moved / static_cast<double>(count)));
    errors.rmsByFrame.push_back(std::sqrt(squaredInFrame / static_cast<double>(count)));
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(nodes.size(), 2) - 1);
  errors.rms = std::sqrt(squared / (frames * static_cast<double>(count)));
  errors.normalMeanDeg = degrees / (frames * static_cast<double>(count));
  for (const double s : squaredByVertex) errors.rmsByVertex.push_back(static_cast<float>(std::sqrt(s / frames)));
  return errors;
}

SampledErrors::SampledErrors(Reference& reference, const TriangleMesh& mesh, const Cage& cage)
    : cage_(cage), diagonal_(boundingBox(mesh.positions).diagonal().norm()) {
  const std::size_t stride = std::max<std::size_t>(1, mesh.vertexCount() / kSamples);
  const MeshSkin<double> skin = skinOf(cage, mesh, {});
  const auto& bindings = skin.binding()->embedding().bindings();
  for (std::size_t v = 0; v < mesh.vertexCount(); v += stride) samples_.push_back(bindings[v]);
  for (int frame = 0; frame < reference.frameCount(); ++frame) {
    const ReferenceSurface& surface = reference.surfaceAt(frame);
    Points& points = right_.emplace_back();
    for (std::size_t v = 0; v < mesh.vertexCount(); v += stride) points.push_back(surface.positions[v]);
  }
}

double SampledErrors::rms(const Trajectory& nodes) const {
  double squared = 0.0;
  for (std::size_t frame = 1; frame < nodes.size(); ++frame) {
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Tet& tet = cage_.mesh.tets[static_cast<std::size_t>(samples_[k].tet)];
      Eigen::Vector3d position = -right_[frame][k];
      for (std::size_t i = 0; i < 4; ++i) {
        position +=
            static_cast<double>(samples_[k].weights[i]) * nodes[frame][static_cast<std::size_t>(tet[i])].cast<double>();
      }
      squared += position.squaredNorm();
    }
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(nodes.size(), 2) - 1);
  return std::sqrt(squared / (frames * static_cast<double>(samples_.size()))) / diagonal_;
}

double surfaceDistance(const TriangleMesh& mesh, const Cage& cage, SurfaceKind kind, const Trajectory& nodes,
                       const Trajectory& others) {
  CarriedSurface surface(cage, mesh, kind), other(cage, mesh, kind);
  const std::size_t frames = std::min(nodes.size(), others.size());
  if (frames < 2) return 0.0;
  double squared = 0.0;
  for (std::size_t frame = 1; frame < frames; ++frame) {
    surface.update(nodes[frame]);
    other.update(others[frame]);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
      squared += (surface.position(v) - other.position(v)).squaredNorm();
  }
  return std::sqrt(squared / static_cast<double>((frames - 1) * mesh.vertexCount())) /
         boundingBox(mesh.positions).diagonal().norm();
}

double nodeErrors(const Trajectory& nodes, const Trajectory& driven, const TriangleMesh& mesh) {
  double squared = 0.0;
  std::size_t count = 0;
  for (std::size_t frame = 1; frame < nodes.size(); ++frame) {
    for (std::size_t n = 0; n < nodes[frame].size(); ++n) {
      squared += static_cast<double>((nodes[frame][n] - driven[frame][n]).squaredNorm());
    }
    count += nodes[frame].size();
  }
  if (count == 0) return 0.0;
  return std::sqrt(squared / static_cast<double>(count)) / boundingBox(mesh.positions).diagonal().norm();
}

}  // namespace tetskin::report
