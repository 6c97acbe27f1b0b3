// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: how the points of one tet follow its nodes, W at a time.
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022 (linear)
//   Doug L. James, "Phong Deformation: A Better C0 Interpolant for Embedded Deformation", ACM TOG 39(4), 2020,
//   doi 10.1145/3386569.3392371 (quadratic; the node gradients are others, see quadratic_skinning.h)
//
// With b the weights of a tet's first three nodes, b3 = 1 - b0 - b1 - b2, and e_ij the vector of its edge (i, j):
//   x(b) = x3 + sum_k b_k (x_k - x3) + sum_{i<j} b_i b_j e_ij
// is a polynomial of degree 2 in b, whose ten coefficients are made once a run:
//   constant   x3
//   b_k        x_k - x3 + e_k3
//   b_k b_k    -e_k3
//   b_k b_l    e_kl - e_k3 - e_l3
// Its value and its derivatives are then the same few multiply-adds for every vertex.
#pragma once

#include <tetskin/core/kernels/lanes.h>
#include <tetskin/core/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// Columns of the map's gradient: derivatives by b0, b1 and b2.
template <class S, int W>
struct Gradient {
  Lanes<S, W> column[3][3];  ///< column, coordinate
};

template <class S>
Lanes<S, 4> nodeAt(const Work<S>& work, int node) {
  return loadPadded(work.nodes + 4 * static_cast<std::size_t>(node));
}

/// The vector of a cage edge; the fourth number is its rest length.
template <class S>
Lanes<S, 4> edgeAt(const Work<S>& work, std::uint32_t edge) {
  return loadPadded(work.edges + 4 * static_cast<std::size_t>(edge));
}

template <class S, int W>
void loadWeights(const float* const planes[3], std::uint32_t slot, Lanes<S, W> b[3]) {
  for (int k = 0; k < 3; ++k) b[k] = load<S, W>(planes[k] + slot);
}

// One tet under each kind of surface: `make` once a run, then its points, and the gradient for normals and tangents.

/// x(b) without the edges' vectors.
template <class S>
struct LinearTet {
  S base[4];
  S slope[3][4];

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    const Run& r = work.runs[run];
    const Lanes<S, 4> last = nodeAt(work, r.nodes[3]);
    storePadded<S>(last + shift, base);
    for (int n = 0; n < 3; ++n) storePadded<S>(nodeAt(work, r.nodes[n]) - last, slope[n]);
  }

  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    for (int k = 0; k < 3; ++k) x[k] = base[k] + (slope[0][k] * b[0] + slope[1][k] * b[1] + slope[2][k] * b[2]);
  }
};

/// The polynomial of the head of this file.
template <class S>
struct QuadraticMap {
  S base[4];
  S slope[3][4];    ///< of b_k: x_k - x3 + e_k3
  S bend[3][4];     ///< of -b_k b_k: e_k3
  S product[3][4];  ///< of b1 b2, b0 b2, b0 b1: the one without k

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    const Run& r = work.runs[run];
    const Lanes<S, 4> last = nodeAt(work, r.nodes[3]);
    storePadded<S>(last + shift, base);
    const std::uint32_t* ids = work.runEdges + 6 * run;
    const Lanes<S, 4> to3[3] = {edgeAt(work, ids[2]), edgeAt(work, ids[4]), edgeAt(work, ids[5])};
    const Lanes<S, 4> opposite[3] = {edgeAt(work, ids[3]), edgeAt(work, ids[1]), edgeAt(work, ids[0])};
    for (int n = 0; n < 3; ++n) {
      storePadded<S>(nodeAt(work, r.nodes[n]) - last + to3[n], slope[n]);
      storePadded<S>(to3[n], bend[n]);
      storePadded<S>(opposite[n] - to3[(n + 1) % 3] - to3[(n + 2) % 3], product[n]);
    }
  }

  /// x(b) without its base.
  template <class V>
  V fromBase(const V b[3], int k) const {
    return b[0] * (slope[0][k] - bend[0][k] * b[0] + product[2][k] * b[1] + product[1][k] * b[2]) +
           b[1] * (slope[1][k] - bend[1][k] * b[1] + product[0][k] * b[2]) + b[2] * (slope[2][k] - bend[2][k] * b[2]);
  }
  /// Derivative by b_n.
  template <class V>
  V derivative(const V b[3], int n, int k) const {
    const int p = (n + 1) % 3, q = (n + 2) % 3;
    return slope[n][k] - S(2) * bend[n][k] * b[n] + product[q][k] * b[p] + product[p][k] * b[q];
  }
  template <int W>
  void gradientAt(const Lanes<S, W> b[3], Gradient<S, W>& g) const {
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k) g.column[n][k] = derivative(b, n, k);
    }
  }
};

template <class S>
struct QuadraticTet : QuadraticMap<S> {
  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    for (int k = 0; k < 3; ++k) x[k] = this->base[k] + this->fromBase(b, k);
  }
  template <int W>
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> b[3];
    loadWeights<S, W>(work.weights, slot, b);
    this->template gradientAt<W>(b, g);
  }
};

template <class S>
struct QuadraticTetOutside : QuadraticMap<S> {
  S shortestRest;  ///< of the tet's edges

  void make(const Work<S>& work, std::size_t run, const Lanes<S, 4>& shift) {
    QuadraticMap<S>::make(work, run, shift);
    const std::uint32_t* ids = work.runEdges + 6 * run;
    shortestRest = edgeAt(work, ids[0])[3];
    for (int i = 1; i < 6; ++i) {
      const S rest = edgeAt(work, ids[i])[3];
      if (rest < shortestRest) shortestRest = rest;
    }
  }

  template <int W>
  void closest(const Work<S>& work, std::uint32_t slot, Lanes<S, W> c[3]) const {
    loadWeights<S, W>(work.closest, slot - work.closestBase, c);
  }
  /// What the quadratic part adds is taken, with its derivatives, at the closest point, and continued to first order. A
  /// crumpled cage would carry it far away: it is never longer than the tet's shortest edge at rest.
  template <int W>
  void positions(const Work<S>& work, std::uint32_t slot, Lanes<S, W> x[3]) const {
    using V = Lanes<S, W>;
    V b[3], c[3], added[3];
    loadWeights<S, W>(work.weights, slot, b);
    closest<W>(work, slot, c);
    for (int k = 0; k < 3; ++k) {
      V linear = all<S, W>(S(0));
      added[k] = this->fromBase(c, k);
      for (int n = 0; n < 3; ++n) {
        linear += (this->slope[n][k] - this->bend[n][k]) * b[n];
        added[k] += this->derivative(c, n, k) * (b[n] - c[n]);
      }
      added[k] -= linear;
      x[k] = this->base[k] + linear;
    }
    const V length = squareRoots<S, W>(added[0] * added[0] + added[1] * added[1] + added[2] * added[2]);
    const V limit = all<S, W>(shortestRest);
    const V scale = length > limit ? limit / length : all<S, W>(S(1));
    // Nodes so far apart that the length overflows leave no correction worth having.
    for (int k = 0; k < 3; ++k) x[k] += length * 0 == 0 ? added[k] * scale : all<S, W>(S(0));
  }
  template <int W>
  void gradient(const Work<S>& work, std::uint32_t slot, Gradient<S, W>& g) const {
    Lanes<S, W> c[3];
    closest<W>(work, slot, c);
    this->template gradientAt<W>(c, g);
  }
};

}  // namespace tetskin::kernels::TETSKIN_KERNELS
