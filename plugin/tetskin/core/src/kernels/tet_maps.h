// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: how the points of one tet follow its nodes.
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022 (linear)
//   Doug L. James, "Phong Deformation: A Better C0 Interpolant for Embedded Deformation", ACM TOG 39(4), 2020,
//   doi 10.1145/3386569.3392371 (quadratic; the edges' vectors are others, see quadratic_skinning.h)
//
// With b the weights of a tet's first three nodes, b3 = 1 - b0 - b1 - b2, and e_ij the vector of its edge (i, j):
//   x(b) = x3 + sum_k b_k (x_k - x3) + sum_{i<j} b_i b_j e_ij
// is a polynomial of degree 2 in b, whose ten coefficients are computed once per run:
//   constant   x3
//   b_k        x_k - x3 + e_k3
//   b_k b_k    -e_k3
//   b_k b_l    e_kl - e_k3 - e_l3
// Its value and its derivatives are then the same few multiply-adds for every vertex.
#pragma once

#include <tetskin/core/src/kernels/points.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int P>
Points<S, P> nodeAt(const Work<S>& work, int node) {
  return repeated<S, P>(work.nodes + 4 * static_cast<std::size_t>(node));
}

/// The vector of a cage edge; the fourth number is its rest length.
template <class S>
const S* edgeAt(const Work<S>& work, std::uint32_t edge) {
  return work.edges + 4 * static_cast<std::size_t>(edge);
}

/// The values of P vertices in three arrays.
template <class S, int P>
struct Weights {
  Points<S, P> item[3];

  Weights(const float* const planes[3], std::size_t slot)
      : item{spread<S, P>(planes[0] + slot), spread<S, P>(planes[1] + slot), spread<S, P>(planes[2] + slot)} {}
  const Points<S, P>& operator[](int k) const { return item[k]; }
};

// A tet with each kind of surface: computed once per run; then gives x(b) - x3 of its points, and the columns of the
// gradient (derivatives by b0, b1 and b2) for normals and tangents. The differences are summed before x3, which may be
// far from the origin, is added.

/// x(b) of the linear map, without the edges' vectors.
template <class S, int P>
struct LinearTet {
  Points<S, P> last, slope[3];

  LinearTet(const Work<S>& work, std::size_t run) {
    const Run& r = work.runs[run];
    last = nodeAt<S, P>(work, r.nodes[3]);
    for (int n = 0; n < 3; ++n) slope[n] = nodeAt<S, P>(work, r.nodes[n]) - last;
  }
  Points<S, P> fromLast(const Work<S>& work, std::size_t slot) const {
    const Weights<S, P> b(work.weights, slot);
    return slope[0] * b[0] + slope[1] * b[1] + slope[2] * b[2];
  }
};

/// The polynomial given at the beginning of this file.
template <class S, int P>
struct QuadraticMap {
  Points<S, P> last;
  Points<S, P> slope[3];    ///< coefficients of b_k: x_k - x3 + e_k3
  Points<S, P> bend[3];     ///< coefficients of -b_k b_k: e_k3
  Points<S, P> product[3];  ///< coefficients of b1 b2, b0 b2, b0 b1: entry k is that without b_k

  QuadraticMap(const Work<S>& work, std::size_t run) {
    const Run& r = work.runs[run];
    const std::uint32_t* ids = work.runEdges + 6 * run;
    const std::uint32_t to3[3] = {ids[2], ids[4], ids[5]}, opposite[3] = {ids[3], ids[1], ids[0]};
    last = nodeAt<S, P>(work, r.nodes[3]);
    for (int n = 0; n < 3; ++n) bend[n] = repeated<S, P>(edgeAt(work, to3[n]));
    for (int n = 0; n < 3; ++n) {
      slope[n] = nodeAt<S, P>(work, r.nodes[n]) - last + bend[n];
      product[n] = repeated<S, P>(edgeAt(work, opposite[n])) - bend[(n + 1) % 3] - bend[(n + 2) % 3];
    }
  }

  Points<S, P> fromLast(const Weights<S, P>& b) const {
    return (slope[0] - bend[0] * b[0] + product[2] * b[1] + product[1] * b[2]) * b[0] +
           (slope[1] - bend[1] * b[1] + product[0] * b[2]) * b[1] + (slope[2] - bend[2] * b[2]) * b[2];
  }
  /// Derivative by b_n.
  Points<S, P> derivative(const Weights<S, P>& b, int n) const {
    const int p = (n + 1) % 3, q = (n + 2) % 3;
    return slope[n] - bend[n] * (b[n] + b[n]) + product[q] * b[p] + product[p] * b[q];
  }
};

template <class S, int P>
struct QuadraticTet : QuadraticMap<S, P> {
  using QuadraticMap<S, P>::QuadraticMap;

  Points<S, P> fromLast(const Work<S>& work, std::size_t slot) const {
    return QuadraticMap<S, P>::fromLast(Weights<S, P>(work.weights, slot));
  }
  void gradient(const Work<S>& work, std::size_t slot, Points<S, P> column[3]) const {
    const Weights<S, P> b(work.weights, slot);
    for (int n = 0; n < 3; ++n) column[n] = this->derivative(b, n);
  }
};

template <class S, int P>
struct QuadraticTetOutside : QuadraticMap<S, P> {
  S longestSquared;  ///< bound of the quadratic part: the squared length of the shortest edge at rest

  QuadraticTetOutside(const Work<S>& work, std::size_t run) : QuadraticMap<S, P>(work, run) {
    const std::uint32_t* ids = work.runEdges + 6 * run;
    S shortest = edgeAt(work, ids[0])[3];
    for (int i = 1; i < 6; ++i) {
      const S rest = edgeAt(work, ids[i])[3];
      if (rest < shortest) shortest = rest;
    }
    longestSquared = shortest * shortest;
  }

  /// The quadratic part, with its derivatives, is evaluated at the closest point, and continued to first order. On a
  /// crumpled cage it would become very long, so it is limited to the length of the tet's shortest edge at rest.
  Points<S, P> fromLast(const Work<S>& work, std::size_t slot) const {
    const Weights<S, P> b(work.weights, slot), c(work.closest, slot - work.closestBase);
    Points<S, P> linear = {}, added = QuadraticMap<S, P>::fromLast(c);
    for (int n = 0; n < 3; ++n) {
      linear += (this->slope[n] - this->bend[n]) * b[n];
      added += this->derivative(c, n) * (b[n] - c[n]);
    }
    added -= linear;
    const Points<S, P> squared = squaredLengths<S, P>(added);
    if (!allBetween<S, P>(squared, S(-1), longestSquared)) added = shortened(added, squared);
    return linear + added;
  }
  void gradient(const Work<S>& work, std::size_t slot, Points<S, P> column[3]) const {
    const Weights<S, P> c(work.closest, slot - work.closestBase);
    for (int n = 0; n < 3; ++n) column[n] = this->derivative(c, n);
  }

 private:
  /// If nodes are so far apart that the length overflows, the correction is 0.
  TETSKIN_NOINLINE Points<S, P> shortened(Points<S, P> added, Points<S, P> squared) const {
    for (int i = 0; i < 4 * P; ++i) {
      const S q = squared[i];
      if (q < longestSquared) continue;
      added[i] = q * 0 == 0 ? added[i] * squareRoot(longestSquared / q) : S(0);
    }
    return added;
  }
};

}  // namespace tetskin::kernels::TETSKIN_KERNELS
