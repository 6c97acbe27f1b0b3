// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/lists.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/component_unknown.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Rounding in the matrix's products with translations, relative to these, from which on all products with rigid
/// motions are left out. From 0.5 on, a cube of 1e9 Pa that lands does not rest, or is thrown off.
constexpr double kRounded = 0.01;

using Span = ComponentUnknown::Span;
constexpr auto kLanes = static_cast<std::size_t>(kernels::kGroup);
/// A slot without a node.
constexpr std::size_t kNoComponent = ~std::size_t{0};

int indexOf(std::size_t k) {
  return static_cast<int>(k);
}

/// Calls call(i, lane) for each scalar of a component, in the order of the wide layout.
template <class Call>
void forScalars(const std::vector<Span>& spans, Call&& call) {
  for (const Span& span : spans) {
    for (std::size_t i = span.first; i < span.last; i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) call(i + lane, lane);
    }
    if (span.first < span.last) continue;
    const std::size_t lane = span.first % kLanes;
    for (std::size_t k = 0; k < 3; ++k) call(span.first + k * kLanes, lane);
  }
}

/// The products of six wide vectors with another one. There is a sum for each lane, as compilers do not change the
/// order of sums.
Small6 productsOf(const MotionFields& fields, const std::vector<Span>& spans, const btScalar* wide) {
  Small6 products;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    const btScalar* field = fields[k].data();
    double sums[kLanes] = {};
    forScalars(spans, [&](std::size_t i, std::size_t lane) {
      sums[lane] += static_cast<double>(field[i]) * static_cast<double>(wide[i]);
    });
    products[indexOf(k)] = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  }
  return products;
}

/// Adds the sum of the fields, each times its factor.
void addFields(const MotionFields& fields, const std::vector<Span>& spans, const Small6& factors, btScalar* wide) {
  btScalar q[Dynamics::kRigidMotions];
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) q[k] = static_cast<btScalar>(factors[indexOf(k)]);
  const btScalar *a = fields[0].data(), *b = fields[1].data(), *c = fields[2].data(), *d = fields[3].data(),
                 *e = fields[4].data(), *f = fields[5].data();
  const auto sum = [&](std::size_t i) {
    return wide[i] + q[0] * a[i] + q[1] * b[i] + q[2] * c[i] + q[3] * d[i] + q[4] * e[i] + q[5] * f[i];
  };
  for (const Span& span : spans) {
    for (std::size_t i = span.first; i < span.last; i += kLanes) {
      btScalar sums[kLanes];
      for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] = sum(i + lane);
      for (std::size_t lane = 0; lane < kLanes; ++lane) wide[i + lane] = sums[lane];
    }
    if (span.first < span.last) continue;
    for (std::size_t k = 0; k < 3; ++k) wide[span.first + k * kLanes] = sum(span.first + k * kLanes);
  }
}

/// The component of a chunk's nodes; none if there are several.
std::size_t componentOfChunk(const std::size_t* componentAt) {
  std::size_t one = kNoComponent;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (componentAt[lane] == kNoComponent) continue;
    if (one != kNoComponent && one != componentAt[lane]) return kNoComponent;
    one = componentAt[lane];
  }
  return one;
}

/// By component: where its nodes are.
std::vector<std::vector<Span>> spansOf(const Dynamics& dynamics) {
  const auto& matrix = dynamics.matrix();
  std::vector<std::size_t> componentAt(matrix.slotCount(), kNoComponent);
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) componentAt[matrix.slotOf(n)] = dynamics.componentOf(n);
  std::vector<std::vector<Span>> spans(dynamics.componentCount());
  for (std::size_t slot = 0; slot < matrix.slotCount(); slot += kLanes) {
    const std::size_t one = componentOfChunk(&componentAt[slot]), chunk = matrix.wideOfSlot(slot);
    if (one == kNoComponent) {
      for (std::size_t s = slot; s < slot + kLanes; ++s) {
        const std::size_t at = matrix.wideOfSlot(s);
        if (componentAt[s] != kNoComponent) spans[componentAt[s]].push_back({at, at});
      }
      continue;
    }
    if (spans[one].empty() || spans[one].back().last != chunk) spans[one].push_back({chunk, chunk});
    spans[one].back().last = chunk + kernels::kWideVector;
  }
  return spans;
}

}  // namespace

std::vector<ComponentUnknown> ComponentUnknown::makeAll(const Dynamics& dynamics, std::size_t most,
                                                        ParallelFor* threads) {
  std::vector<ComponentUnknown> unknowns;
  MotionFields points;  // 4 scalars per slot
  for (std::size_t component = 0; component < std::min(dynamics.componentCount(), most); ++component) {
    if (dynamics.rigidMotions(component, points)) unknowns.emplace_back().component = component;
  }
  if (unknowns.empty()) return unknowns;
  // For all components at once: the matrix does not connect them.
  const auto& matrix = dynamics.matrix();
  const auto fields = std::make_shared<ComponentFields>();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    AlignedVector<btScalar> product(matrix.wideSize(), btScalar(0));
    if (!dynamics.isStretched()) matrix.multiply(points[k].data(), product.data(), threads);  // else left out
    fields->motions[k].assign(matrix.wideSize(), btScalar(0));
    fields->images[k].assign(matrix.wideSize(), btScalar(0));
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
      const std::size_t at = matrix.wideOf(n);
      toWide(fromPoint(&points[k][4 * matrix.slotOf(n)]), &fields->motions[k][at]);
      toWide(fromWide(&product[at]), &fields->images[k][at]);
    }
  }
  const Lists<std::size_t> nodes = packLists<std::size_t>(dynamics.componentCount(), [&](auto&& visit) {
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) visit(dynamics.componentOf(n), n);
  });
  std::vector<std::vector<Span>> spans = spansOf(dynamics);
  AlignedVector<btScalar> right(matrix.wideSize(), btScalar(0));
  for (ComponentUnknown& unknown : unknowns) {
    unknown.fields_ = fields;
    unknown.spans_ = std::move(spans[unknown.component]);
    unknown.nodes_.assign(nodes.values.begin() + nodes.starts[unknown.component],
                          nodes.values.begin() + nodes.starts[unknown.component + 1]);
    const bool rounded = dynamics.isStretched() || unknown.rounding(dynamics) > kRounded;
    if (rounded) unknown.leaveOutElasticity(dynamics);
    unknown.findMass(dynamics, !rounded, right);
  }
  return unknowns;
}

/// What rounding has added to the images of translations, relative to these: nothing elastic resists a translation, so
/// that A Z = M Z. It grows with the stiffness of the tets, in relation to their mass.
double ComponentUnknown::rounding(const Dynamics& dynamics) const {
  const auto& matrix = dynamics.matrix();
  double added = 0.0, all = 0.0;
  for (std::size_t k = 0; k < Dynamics::kTranslations; ++k) {
    for (const std::size_t n : nodes_) {
      const std::size_t at = matrix.wideOf(n);
      const btVector3 exact = matrix.mass(n) * fromWide(&fields_->motions[k][at]);
      added += squaredNorm(toSmall(fromWide(&fields_->images[k][at])) - toSmall(exact));
      all += squaredNorm(toSmall(exact));
    }
  }
  return std::sqrt(added / all);
}

/// Elasticity resists rigid motions as far as the matrix belongs to other rotations than the body's, or to a deformed
/// body: little, in a body so stiff that rounding matters.
void ComponentUnknown::leaveOutElasticity(const Dynamics& dynamics) {
  const auto& matrix = dynamics.matrix();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    for (const std::size_t n : nodes_) {
      const std::size_t at = matrix.wideOf(n);
      toWide(matrix.mass(n) * fromWide(&fields_->motions[k][at]), &fields_->images[k][at]);
    }
  }
}

/// elastic  whether the elastic forces count for the momentum; their sum is 0 but for rounding
/// right    scratch of the wide layout
void ComponentUnknown::findMass(const Dynamics& dynamics, bool elastic, AlignedVector<btScalar>& right) {
  const auto& matrix = dynamics.matrix();
  for (const std::size_t n : nodes_) {
    btVector3 own = matrix.mass(n) * fromWide(dynamics.deviation() + matrix.wideOf(n));
    if (elastic) dynamics.rightSide(n, own.m_floats);
    toWide(own, &right[matrix.wideOf(n)]);
  }
  began = motionProducts(right.data());
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    mass.setColumn(indexOf(k), motionProducts(fields_->images[k].data()));
  }
  mass = 0.5 * (mass + transposed(mass));
}

Small6 ComponentUnknown::imageProducts(const btScalar* wide) const {
  return productsOf(fields_->images, spans_, wide);
}

Small6 ComponentUnknown::motionProducts(const btScalar* wide) const {
  return productsOf(fields_->motions, spans_, wide);
}

void ComponentUnknown::addImages(const Small6& q, btScalar* wide) const {
  addFields(fields_->images, spans_, q, wide);
}

void ComponentUnknown::addMotions(const Small6& q, Dynamics& dynamics) const {
  addFields(fields_->motions, spans_, q, dynamics.matrix().solution());
}

RowMotions ComponentUnknown::motionsAt(const Dynamics& dynamics, const CarriedPoint& point) const {
  assert(point.count > 0);
  RowMotions at;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    const btVector3 motion = point.sum([&](int n) {
      const auto node = static_cast<std::size_t>(n);
      if (dynamics.componentOf(node) != component) return btVector3(0, 0, 0);
      return fromWide(&fields_->motions[k][dynamics.matrix().wideOf(node)]);
    });
    at.setColumn(indexOf(k), toSmall(motion));
  }
  return at;
}

}  // namespace tetskin::bullet_detail
