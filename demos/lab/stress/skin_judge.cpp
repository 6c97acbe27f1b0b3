// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/skin_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tetskin::stress {
namespace {

/// A body larger than this many times the size that its scene gives it is not bounded, though Bullet's clamps may keep
/// it finite.
constexpr double kBounded = 2.0;
/// Share of a rest edge that quadratic skinning may add inside a cage: 3/8 of half of it; outside, the whole edge.
constexpr double kQuadraticFraction = 0.1875;
/// Tolerance of the lengths of normals, which are floats.
constexpr double kUnitTolerance = 1e-5;
/// Tolerance of the sum of weights stored as floats, over the largest of them.
constexpr double kWeightTolerance = 1e-6;
/// Rounding errors of a position, in units of the scalar's epsilon times the largest coordinate involved.
constexpr double kRoundings = 32.0;
/// Rounding of weights, which are stored as floats whatever Bullet's precision is.
constexpr double kWeightRounding = 6e-8;
/// Share of the body's size that a node must have moved for an amplification to be meaningful.
constexpr double kSmallDirection = 0.001;

template <class Scalar>
std::vector<Scalar> copyOf(PointView<const Scalar> points) {
  std::vector<Scalar> copy;
  copy.reserve(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) copy.insert(copy.end(), points[i], points[i] + 3);
  return copy;
}

/// True if all values have the same bits, NaN included.
template <class Scalar>
bool same(const std::vector<Scalar>& a, const std::vector<Scalar>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Scalar)) == 0);
}

Eigen::Vector3d pointAt(const btScalar* p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// Largest distance of a point from its initial position.
double longestDirection(PointView<const btScalar> now, const std::vector<btScalar>& start) {
  double longest = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    longest = std::max(longest, (pointAt(now[i]) - pointAt(start.data() + 3 * i)).norm());
  }
  return longest;
}

double maxCoordinate(PointView<const btScalar> points) {
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    largest = std::max(largest, pointAt(points[i]).cwiseAbs().maxCoeff());
  }
  return largest;
}

double longestEdgeOf(const TetMesh& cage) {
  double longest = 0.0;
  for (const auto& e : uniqueEdges(cage)) longest = std::max(longest, (cage.nodes[e[0]] - cage.nodes[e[1]]).norm());
  return longest;
}

}  // namespace

void Verdict::expect(bool condition, const std::string& what) {
  if (condition || std::find(broken.begin(), broken.end(), what) != broken.end()) return;
  broken.push_back(what);
}

SkinJudge::SkinJudge(const StressCase& stressCase, const StressModel& model, const scenes::Scene& scene,
                     SoftBodySkin& skin, Verdict& verdict)
    : case_(stressCase),
      model_(model),
      scene_(scene),
      body_(scene.body()),
      skin_(skin),
      verdict_(verdict),
      startNodes_(copyOf(nodePositions(body_))),
      startSurface_(copyOf(skin.positions())),
      diagonal_(boundingBox(model.mesh.positions).diagonal().norm()),
      longestEdge_(longestEdgeOf(model.cage.mesh)) {
  lastSurface_ = startSurface_;
  lastNormals_ = copyOf(skin.normals());
  verdict_.status = toString(StatusCode::Ok);
  judgeWeights();
}

void SkinJudge::judgeWeights() {
  for (const VertexBinding& binding : skin_.binding()->embedding().bindings()) {
    double sum = 0.0, absolute = 0.0, largest = 0.0;
    for (const float w : binding.weights) {
      sum += static_cast<double>(w);
      absolute += std::abs(static_cast<double>(w));
      largest = std::max(largest, std::abs(static_cast<double>(w)));
    }
    verdict_.weightError = std::max(verdict_.weightError, std::abs(sum - 1.0) / largest);
    inside_.push_back(binding.inside);
    reach_.push_back(std::max(1.0, absolute));
  }
  verdict_.expect(verdict_.weightError <= kWeightTolerance, "weights sum to 1");
}

void SkinJudge::update() {
  judgeNodes();
  const StatusCode status = skin_.update();
  const std::size_t bad = firstUnusable(nodePositions(body_));
  if (bad < static_cast<std::size_t>(body_.m_nodes.size())) {
    verdict_.status = toString(StatusCode::NonFinite);
    verdict_.expect(status == StatusCode::NonFinite, "the update reports nodes that are not finite");
    verdict_.expect(skin_.firstNonFiniteNode() == bad, "the update names the first node that is not finite");
    verdict_.expect(same(copyOf(skin_.positions()), lastSurface_) && same(copyOf(skin_.normals()), lastNormals_),
                    "the last valid surface is kept");
    return;
  }
  verdict_.expect(status == StatusCode::Ok, "the surface is updated whenever all nodes are finite");
  if (status != StatusCode::Ok) verdict_.status = toString(status);
  judgeFollowing();
  judgeNormals();
  lastSurface_ = copyOf(skin_.positions());
  lastNormals_ = copyOf(skin_.normals());
}

void SkinJudge::judgeNodes() {
  const scenes::Findings found = scene_.check();
  verdict_.simulationFinite = verdict_.simulationFinite && found.finite;
  if (found.finite) verdict_.extentMax = std::max(verdict_.extentMax, found.box.sizes().maxCoeff() / model_.size);
  verdict_.simulationBounded = verdict_.simulationFinite && verdict_.extentMax <= kBounded * scene_.extent;
}

void SkinJudge::judgeFollowing() {
  const PointView<const btScalar> nodes = nodePositions(body_), surface = skin_.positions();
  const bool finite = firstNonFinite(surface) == surface.size();
  verdict_.skinFinite = verdict_.skinFinite && finite;
  verdict_.expect(finite, "the surface is finite");
  if (!finite) return;
  const double nodeDirection = longestDirection(nodes, startNodes_);
  const double largest = std::max({maxCoordinate(nodes), maxCoordinate(surface), nodeDirection});
  const double rounding = kRoundings * static_cast<double>(std::numeric_limits<btScalar>::epsilon()) * largest;
  const bool quadratic = case_.interpolation == Interpolation::Quadratic;
  double surfaceDirection = 0.0;
  bool carried = true;
  for (std::size_t v = 0; v < surface.size(); ++v) {
    const double direction = (pointAt(surface[v]) - pointAt(startSurface_.data() + 3 * v)).norm();
    const double added = !quadratic ? 0.0 : inside_[v] ? kQuadraticFraction * longestEdge_ : longestEdge_;
    carried = carried && direction <= reach_[v] * (nodeDirection + rounding) + added;
    surfaceDirection = std::max(surfaceDirection, direction);
  }
  verdict_.expect(carried, "no vertex moves farther than its nodes do");
  if (nodeDirection > kSmallDirection * model_.size) {
    verdict_.amplification = std::max(verdict_.amplification, surfaceDirection / nodeDirection);
  }
}

void SkinJudge::judgeNormals() {
  const PointView<const float> normals = skin_.normals();
  verdict_.expect(normals.size() == (case_.normals == Normals::None ? 0 : skin_.positions().size()),
                  "there are normals if requested");
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const double error = std::abs(Eigen::Map<const Eigen::Vector3f>(normals[v]).cast<double>().norm() - 1.0);
    if (!(error <= verdict_.normalError)) verdict_.normalError = error;  // NaN counts as the largest
  }
  verdict_.expect(verdict_.normalError <= kUnitTolerance, "normals are unit vectors");
}

void SkinJudge::judgeShape() {
  const auto count = static_cast<Eigen::Index>(lastSurface_.size() / 3);
  const auto points = [count](const std::vector<btScalar>& from) {
    return Eigen::Matrix3Xd(
        Eigen::Map<const Eigen::Matrix<btScalar, 3, Eigen::Dynamic>>(from.data(), 3, count).cast<double>());
  };
  const Eigen::Matrix3Xd rest = points(startSurface_), now = points(lastSurface_);
  const Eigen::Matrix4d motion = Eigen::umeyama(rest, now, false);
  const Eigen::Matrix3Xd moved = (motion.topLeftCorner<3, 3>() * rest).colwise() + motion.topRightCorner<3, 1>();
  verdict_.shapeError = std::sqrt((moved - now).squaredNorm() / static_cast<double>(count)) / diagonal_;
}

void SkinJudge::judgeRest() {
  skin_.markMoved();
  verdict_.expect(skin_.update() == StatusCode::Ok, "the skin recovers when all nodes are finite again");
  const PointView<const btScalar> surface = skin_.positions();
  double squared = 0.0;
  for (std::size_t v = 0; v < surface.size(); ++v) {
    squared += (pointAt(surface[v]) - model_.mesh.positions[v]).squaredNorm();
  }
  verdict_.restError = std::sqrt(squared / static_cast<double>(surface.size())) / diagonal_;
  double nodesSquared = 0.0;  // initial positions against the cage: far from the origin, nodes are rounded
  for (std::size_t n = 0; n < model_.cage.mesh.nodeCount(); ++n) {
    nodesSquared += (pointAt(startNodes_.data() + 3 * n) - model_.offset - model_.cage.mesh.nodes[n]).squaredNorm();
  }
  const double nodeError = std::sqrt(nodesSquared / static_cast<double>(model_.cage.mesh.nodeCount())) / diagonal_;
  const double rounding =
      *std::max_element(reach_.begin(), reach_.end()) * longestEdge_ / diagonal_ *
      (kWeightRounding + kRoundings * static_cast<double>(std::numeric_limits<btScalar>::epsilon()));
  verdict_.expect(verdict_.restError <= 2.0 * nodeError + rounding, "the rest shape is recovered");
  verdict_.expect(same(copyOf(surface), startSurface_), "the rest shape is recovered bit for bit");
}

}  // namespace tetskin::stress
