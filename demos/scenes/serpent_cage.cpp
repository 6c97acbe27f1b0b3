// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The cage: a triangulated disc, swept along the spine; each of its triangles sweeps prisms of three tets.
//
// This work is based on:
//   Julien Dompierre, Paul Labbé, Marie-Gabrielle Vallet, Ricardo Camarero, "How to Subdivide Pyramids, Prisms and
//   Hexahedra into Tetrahedra", 1999 (the smallest node of each quad decides its diagonal, so neighbours agree)
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "scenes/serpent.h"
#include "scenes/serpent_shape.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

constexpr double kThinnest = 0.035;    ///< radius of the cage at least, and what its rings' distance follows
constexpr double kBeyondEnds = 0.012;  ///< how far the cage reaches beyond tail and snout
constexpr double kMargin = 0.03;       ///< of the cage around the relief, over the radius
constexpr double kSpikeCover = 0.35;   ///< share of a spike that is inside
constexpr double kFlatBend = 0.5, kSharpBend = 2.0;  ///< curvatures between which the cage lets go of spikes
constexpr double kHeadRelief = 0.03;                 ///< height of the brows and horns' roots, which the cage covers
constexpr int kTetsPerPrism = 3;

/// A disc of `layers` rings about a centre node, `sectors` x j nodes in ring j: sectors x layers^2 triangles.
struct Disc {
  int sectors = 6;
  int layers = 1;

  struct Node {
    double radius = 0.0, theta = 0.0;  ///< radius 1 on the rim
  };
  int triangleCount() const { return sectors * layers * layers; }
  int number(int layer, int i) const {
    return layer == 0 ? 0 : 1 + sectors * layer * (layer - 1) / 2 + i % (sectors * layer);
  }
  std::vector<Node> nodes() const;
  std::vector<std::array<int, 3>> triangles() const;
  /// Distance of the rim's corners such that its edges stay outside of the unit circle.
  double corner() const { return 1.0 / std::cos(kPi / (sectors * layers)); }
};

std::vector<Disc::Node> Disc::nodes() const {
  std::vector<Node> all = {{}};
  for (int layer = 1; layer <= layers; ++layer) {
    const int count = sectors * layer;
    for (int i = 0; i < count; ++i) all.push_back({static_cast<double>(layer) / layers, 2.0 * kPi * i / count});
  }
  return all;
}

std::vector<std::array<int, 3>> Disc::triangles() const {
  std::vector<std::array<int, 3>> all;
  for (int layer = 1; layer <= layers; ++layer) {
    for (int sector = 0; sector < sectors; ++sector) {
      const int inner = sector * (layer - 1), outer = sector * layer;
      for (int i = 0; i < layer; ++i) {
        all.push_back({number(layer - 1, inner + i), number(layer, outer + i), number(layer, outer + i + 1)});
        if (i + 1 == layer) continue;
        all.push_back({number(layer - 1, inner + i), number(layer, outer + i + 1), number(layer - 1, inner + i + 1)});
      }
    }
  }
  return all;
}

/// How close rings should be at t, where `step` is their distance if they were evenly spread: closer where the body is
/// thin, so that tets keep their shape, and where it bends, which matters most when there are few rings.
double ringDensity(const SerpentShape& shape, double t, double step) {
  constexpr double kNear = 0.006;            ///< in t, for the curvature
  constexpr double kThinnestPerStep = 0.35;  ///< a few rings must not all go to the tail
  constexpr double kBendWeight = 2.0;
  const Vector3d bend = shape.spine().frame(t + kNear).tangent - shape.spine().frame(t - kNear).tangent;
  const double curvature = bend.norm() / (2.0 * kNear * shape.spine().length());
  return 1.0 / std::max({shape.radius(t), kThinnest, kThinnestPerStep * step}) + kBendWeight * curvature;
}

/// Length of the spine, in local radii.
double slenderness(const SerpentShape& shape) {
  constexpr int kSamples = 256;
  double sum = 0.0;
  for (int k = 0; k < kSamples; ++k) sum += 1.0 / std::max(shape.radius((k + 0.5) / kSamples), kThinnest);
  return sum / kSamples * shape.spine().length();
}

/// The disc and the number of prisms along the spine with which edges across and along it are most alike.
std::pair<Disc, int> cageGrid(const SerpentShape& shape, double targetTets) {
  const double length = slenderness(shape);
  std::pair<Disc, int> best;
  double bestMismatch = 0.0;
  for (int layers = 1; layers <= 4; ++layers) {
    for (int sectors : {5, 6, 8, 10}) {
      const Disc disc{sectors, layers};
      const int prisms = static_cast<int>(std::lround(targetTets / (kTetsPerPrism * disc.triangleCount())));
      if (prisms < 1) continue;
      const double across = 2.0 * kPi / (sectors * layers), along = length / prisms;
      const double mismatch = std::abs(std::log(along / across));
      if (best.second == 0 || mismatch < bestMismatch) best = {disc, prisms}, bestMismatch = mismatch;
    }
  }
  return best;
}

/// The smallest enlarged section that contains the relief halfway to the neighbouring rings at `before` and `after`.
Section cageSection(const SerpentShape& shape, const Disc& disc, double before, double t, double after) {
  constexpr int kSamples = 8;
  Section ring{shape.spine().frame(t), kThinnest, kThinnest, kThinnest};
  const double first = 0.5 * (before + t), last = 0.5 * (t + after);
  // Between rings the cage is straight where the spine bends, and cuts the corner by an eighth of chord x angle. So a
  // ring moves outwards by half of that, and has the other half to spare.
  const Vector3d bend = shape.spine().frame(last).tangent - shape.spine().frame(first).tangent;
  const double chord = (last - first) * shape.spine().length(), halfCut = bend.norm() * chord / 16.0;
  ring.frame.origin -= halfCut * bend.normalized();
  // Where the spine bends backwards the rings' tops draw together, and would be crowded if they reached up to spikes.
  const double cover = kSpikeCover * (1.0 - smoothStep(kFlatBend, kSharpBend, bend.dot(ring.frame.up) / chord));
  for (int k = 0; k <= kSamples; ++k) {
    const double at = std::clamp(first + (last - first) * k / kSamples, 0.0, 1.0);
    const Section body = shape.section(at);
    const double head = smoothStep(-0.1, 0.1, (at - shape.headStart()) / (1.0 - shape.headStart()));
    const double relief = shape.scaleHeight(at) + head * kHeadRelief + kMargin * body.halfWidth + halfCut;
    ring.halfWidth = std::max(ring.halfWidth, body.halfWidth + relief);
    ring.above = std::max(ring.above, body.above + std::max(relief, (1.0 - head) * cover * shape.spikeLength(at)));
    ring.below = std::max(ring.below, body.below + relief);
  }
  for (double* extent : {&ring.halfWidth, &ring.above, &ring.below}) *extent *= disc.corner();
  return ring;
}

/// The tets of the prism with the positively oriented base (n0, n1, n2) and the top (n3, n4, n5) along its normal.
void appendPrism(std::vector<Tet>& tets, std::array<int, 6> n) {
  // Turned so that the smallest node is n[0] (as it is at the base, whose nodes come before the top's), both quads at
  // n[0] have their diagonal there; the third quad has it at its own smallest node, n[1] or n[2].
  std::rotate(n.begin(), std::min_element(n.begin(), n.begin() + 3), n.begin() + 3);
  std::rotate(n.begin() + 3, std::min_element(n.begin() + 3, n.end()), n.end());
  tets.push_back({n[0], n[4], n[5], n[3]});
  if (n[1] < n[2]) {
    tets.push_back({n[0], n[1], n[2], n[5]});
    tets.push_back({n[0], n[1], n[5], n[4]});
  } else {
    tets.push_back({n[0], n[1], n[2], n[4]});
    tets.push_back({n[0], n[4], n[2], n[5]});
  }
}

}  // namespace

TetMesh makeSerpentCage(std::size_t targetTets) {
  const SerpentShape shape;
  const double target = static_cast<double>(std::clamp(targetTets, kMinSerpentTets, kMaxSerpentTets));
  const auto [disc, prisms] = cageGrid(shape, target);
  const double step = shape.spine().length() / prisms;
  const double beyond = kBeyondEnds / shape.spine().length();
  const std::vector<double> places = spread(static_cast<std::size_t>(prisms) + 1, -beyond, 1.0 + beyond,
                                            [&](double t) { return ringDensity(shape, t, step); });
  const std::vector<Disc::Node> discNodes = disc.nodes();
  const std::vector<std::array<int, 3>> triangles = disc.triangles();
  const int stride = static_cast<int>(discNodes.size());
  TetMesh cage;
  for (int i = 0; i <= prisms; ++i) {
    const Section ring =
        cageSection(shape, disc, places[std::max(i - 1, 0)], places[i], places[std::min(i + 1, prisms)]);
    for (const Disc::Node& node : discNodes) {
      cage.nodes.push_back((1.0 - node.radius) * ring.frame.origin + node.radius * ring.point(node.theta));
    }
    if (i == prisms) break;
    for (const std::array<int, 3>& t : triangles) {
      const int base = i * stride, top = base + stride;
      appendPrism(cage.tets, {base + t[0], base + t[1], base + t[2], top + t[0], top + t[1], top + t[2]});
    }
  }
  return cage;
}

}  // namespace tetskin::scenes
