// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: corotated linear elasticity at W points at a time, for tets of any kind.
//
// This work is based on:
//   Matthias Müller, Markus Gross, "Interactive Virtual Materials", Graphics Interface 2004 (corotated stiffness)
//   Matthias Müller, Jan Bender, Nuttapong Chentanez, Miles Macklin, "A Robust Method to Extract the Rotational Part of
//   Deformations", MIG 2016, doi 10.1145/2994258.2994269 (a quaternion, turned along; here by Newton's step)
//
// With F the deformation gradient, R the rotation that maximises tr(R^T F), S = R^T F, E = sym(S) - 1, and g_a the
// gradient of the shape function of node a:
//   energy = V (mu E : E + lambda / 2 tr(E)^2),  force on node a = -V R (2 mu E + lambda tr(E)) g_a
// which is the gradient of the energy where R is that maximum: S is then symmetric. An inverted tet also has such a
// rotation.
//
// If points are displacements from a frame Q, with gradient G, then F = Q + G. In this sum, a strain below the last
// digit of 1 is lost, so E is computed without it, from the vector v of the quaternion of R^T Q:
//   E = sym(R^T G) + 2 (v v^T - (v . v) 1)
#pragma once

#include <tetskin/elastic/src/kernels/wide.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// The squared angle (radians) below which a Newton step is the last one: the next one would be of the order of its
/// square. And the largest number of steps, beyond which `findRotation` is faster.
template <class S>
constexpr S kLastStep = sizeof(S) == sizeof(float) ? S(1e-4) : S(1e-8);
constexpr int kMaxSteps = 8;

template <class S, int W>
struct Quaternions {
  Lanes<S, W> w, x, y, z;
};

template <class S, int W>
TETSKIN_INLINE Quaternions<S, W> quaternions(const S* from) {
  return {wide<S, W>(from), wide<S, W>(from + kGroup), wide<S, W>(from + 2 * kGroup), wide<S, W>(from + 3 * kGroup)};
}

/// The difference of two rotations, whatever the quaternions' signs: 4 sin^2 of a quarter of the angle between them.
/// Unlike 1 minus the quaternions' dot product, it is precise for nearly equal rotations.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> squaredDifference(const Quaternions<S, W>& p, const Quaternions<S, W>& q) {
  using V = Lanes<S, W>;
  const auto opposite = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < S(0);
  const V sign = opposite ? all<S, W>(-1) : all<S, W>(1);
  const V w = p.w - sign * q.w, x = p.x - sign * q.x, y = p.y - sign * q.y, z = p.z - sign * q.z;
  return w * w + x * x + y * y + z * z;
}

/// W matrices of 3 x 3, row by row.
template <class S, int W>
struct WideMatrix {
  Lanes<S, W> at[9];
};

template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> rotationOf(const Quaternions<S, W>& q) {
  using V = Lanes<S, W>;
  const V x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const V xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const V wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {{S(1) - (yy + zz), xy - wz, xz + wy, xy + wz, S(1) - (xx + zz), yz - wx, xz - wy, yz + wx, S(1) - (xx + yy)}};
}

template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> transposedProduct(const WideMatrix<S, W>& r, const WideMatrix<S, W>& f) {
  WideMatrix<S, W> s;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      s.at[3 * i + j] = r.at[i] * f.at[j] + r.at[3 + i] * f.at[3 + j] + r.at[6 + i] * f.at[6 + j];
    }
  }
  return s;
}

/// Properties of a step towards the rotation, by tet.
template <class S, int W>
struct RotationStep {
  Lanes<S, W> squaredAngle;
  Lanes<S, W> unsafe;  ///< 1 for a gradient step, 0 for a Newton step
};

/// One Newton step on tr(R^T F): (tr(S) - sym(S)) w = axial(S - S^T), in the frame of the body; a gradient step if that
/// matrix is not safely positive.
template <class S, int W>
TETSKIN_INLINE RotationStep<S, W> turnAlong(Quaternions<S, W>& q, const WideMatrix<S, W>& s) {
  using V = Lanes<S, W>;
  const V* a = s.at;
  const V bx = a[7] - a[5], by = a[2] - a[6], bz = a[3] - a[1];
  const V m00 = a[4] + a[8], m11 = a[0] + a[8], m22 = a[0] + a[4];
  const V m01 = S(-0.5) * (a[1] + a[3]), m02 = S(-0.5) * (a[2] + a[6]), m12 = S(-0.5) * (a[5] + a[7]);
  const V c00 = m11 * m22 - m12 * m12, c01 = m02 * m12 - m01 * m22, c02 = m01 * m12 - m02 * m11;
  const V c11 = m00 * m22 - m02 * m02, c12 = m01 * m02 - m00 * m12, c22 = m00 * m11 - m01 * m01;
  const V det = m00 * c00 + m01 * c01 + m02 * c02;
  const V size = absolute<S, W>(a[0] + a[4] + a[8]) + S(1e-9);
  const auto good = (det > S(0.02) * size * size * size) & (c22 > S(0)) & (m00 > S(0));
  const V inverseDet = S(1) / (good ? det : all<S, W>(1)), inverseSize = S(1) / size;
  const V wx = good ? (c00 * bx + c01 * by + c02 * bz) * inverseDet : bx * inverseSize;
  const V wy = good ? (c01 * bx + c11 * by + c12 * bz) * inverseDet : by * inverseSize;
  const V wz = good ? (c02 * bx + c12 * by + c22 * bz) * inverseDet : bz * inverseSize;
  // q <- q (1, w / 2), normalised
  const V hx = S(0.5) * wx, hy = S(0.5) * wy, hz = S(0.5) * wz;
  const V w = q.w - q.x * hx - q.y * hy - q.z * hz, x = q.x + q.w * hx + q.y * hz - q.z * hy;
  const V y = q.y + q.w * hy + q.z * hx - q.x * hz, z = q.z + q.w * hz + q.x * hy - q.y * hx;
  // The squared length is at least 1 for finite values; a tet with values that are not finite starts again.
  const V squared = w * w + x * x + y * y + z * z;
  const auto finite = (squared > S(0.5)) & (squared < S(1e18));
  const V unit = S(1) / squareRoots<S, W>(finite ? squared : all<S, W>(1));
  q = {finite ? w * unit : all<S, W>(1), finite ? x * unit : V{}, finite ? y * unit : V{}, finite ? z * unit : V{}};
  return {wx * wx + wy * wy + wz * wz, good ? V{} : all<S, W>(1)};
}

/// 1 if the rotation is at a saddle point or at the minimum of tr(R^T F), where tr(S) - sym(S) has a negative
/// eigenvalue. An eigenvalue of 0, as for a mirrored tet, means many maxima; the present one is as good as any.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> atNoMaximum(const WideMatrix<S, W>& s) {
  using V = Lanes<S, W>;
  const V* a = s.at;
  const V trace = a[0] + a[4] + a[8], diagonal = S(1 + 1e-3) * trace;
  const V m00 = diagonal - a[0], m11 = diagonal - a[4], m22 = diagonal - a[8];
  const V m01 = S(-0.5) * (a[1] + a[3]), m02 = S(-0.5) * (a[2] + a[6]), m12 = S(-0.5) * (a[5] + a[7]);
  const V c00 = m11 * m22 - m12 * m12, c01 = m02 * m12 - m01 * m22, c02 = m01 * m12 - m02 * m11;
  const V det = m00 * c00 + m01 * c01 + m02 * c02;
  const auto negative = (m00 < S(0)) | (m00 * m11 < m01 * m01) | (det < S(0)) | (trace < S(0));
  return negative ? all<S, W>(1) : V{};
}

/// Diagonalises a symmetric 4x4 matrix by Jacobi's method; its eigenvectors become the columns of `vectors`.
TETSKIN_NOINLINE inline void diagonalise(double (&a)[4][4], double (&vectors)[4][4]) {
  constexpr int kSweeps = 8;  // convergence is quadratic: three or four sweeps suffice
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < 3; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        if (a[i][j] * a[i][j] < 1e-36) continue;
        const double half = (a[j][j] - a[i][i]) / (2 * a[i][j]), size = half < 0 ? -half : half;
        const double tangent = (half < 0 ? -1.0 : 1.0) / (size + squareRoot(half * half + 1));
        const double c = 1 / squareRoot(tangent * tangent + 1), s = tangent * c;
        const auto turn = [&](double& x, double& y) {
          const double before = x;
          x = c * before - s * y;
          y = s * before + c * y;
        };
        for (auto& row : a) turn(row[i], row[j]);
        for (int k = 0; k < 4; ++k) turn(a[i][k], a[j][k]);
        for (auto& row : vectors) turn(row[i], row[j]);
      }
    }
  }
}

/// The quaternion w x y z of the rotation that maximises tr(R^T F), from any start: the first eigenvector of that form
/// (Berthold K. P. Horn, "Closed-form solution of absolute orientation using unit quaternions", J. Opt. Soc. Am. A 4,
/// 1987, doi 10.1364/JOSAA.4.000629). It takes about 1 us. The quaternion stays unchanged if F is 0 or not finite.
TETSKIN_NOINLINE inline void findRotation(const double (&f)[9], double (&q)[4]) {
  double squared = 0.0;
  for (const double x : f) squared += x * x;
  if (!(squared > 0.0 && squared < 1e300)) return;
  const double unit = 1 / squareRoot(squared);
  double m[9];
  for (int k = 0; k < 9; ++k) m[k] = unit * f[k];
  const double t = m[0] + m[4] + m[8];
  const double x = m[7] - m[5], y = m[2] - m[6], z = m[3] - m[1];
  const double xy = m[1] + m[3], xz = m[2] + m[6], yz = m[5] + m[7];
  double a[4][4] = {{t, x, y, z}, {x, 2 * m[0] - t, xy, xz}, {y, xy, 2 * m[4] - t, yz}, {z, xz, yz, 2 * m[8] - t}};
  double vectors[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  diagonalise(a, vectors);
  int first = 0;
  for (int k = 1; k < 4; ++k) first = a[k][k] > a[first][first] ? k : first;
  // Of several equally good rotations, as for an inverted body, chooses the one nearest to the last rotation, or to a
  // fixed one: neighbouring tets must not choose by their rounding.
  constexpr double kAsGood = 1e-3, kHasPart = 1e-3;
  const double fixed[4] = {0, 1, 0, 0};
  const auto project = [&](const double* wanted, double* to) {
    double length = 0.0;
    for (int k = 0; k < 4; ++k) to[k] = 0.0;
    for (int n = 0; n < 4; ++n) {
      if (a[n][n] < a[first][first] - kAsGood) continue;
      double part = 0.0;
      for (int k = 0; k < 4; ++k) part += wanted[k] * vectors[k][n];
      for (int k = 0; k < 4; ++k) to[k] += part * vectors[k][n];
      length += part * part;
    }
    length = squareRoot(length);
    if (!(length > kHasPart)) return false;
    for (int k = 0; k < 4; ++k) to[k] /= length;
    return true;
  };
  double found[4];
  const bool chosen = project(q, found) || project(fixed, found);
  for (int k = 0; k < 4; ++k) q[k] = chosen ? found[k] : vectors[k][first];
}

/// Repairs the rotations of those tets that have lost their maximum.
template <class S, int W>
TETSKIN_NOINLINE void findRotations(const WideMatrix<S, W>& f, const Lanes<S, W>& lost, Quaternions<S, W>& q) {
  S from[9][W], to[4][W], which[W];
  for (int k = 0; k < 9; ++k) put<S, W>(f.at[k], from[k]);
  put<S, W>(q.w, to[0]), put<S, W>(q.x, to[1]), put<S, W>(q.y, to[2]), put<S, W>(q.z, to[3]);
  put<S, W>(lost, which);
  for (int i = 0; i < W; ++i) {
    if (!(which[i] > S(0))) continue;
    double gradient[9], found[4];
    for (int k = 0; k < 9; ++k) gradient[k] = static_cast<double>(from[k][i]);
    for (int k = 0; k < 4; ++k) found[k] = static_cast<double>(to[k][i]);
    findRotation(gradient, found);
    for (int k = 0; k < 4; ++k) to[k][i] = static_cast<S>(found[k]);
  }
  q = {wide<S, W>(to[0]), wide<S, W>(to[1]), wide<S, W>(to[2]), wide<S, W>(to[3])};
}

/// The rotations that maximise tr(R^T F), starting from those of the last step; s becomes R^T F. As a quadratic form of
/// R's quaternion, it has no other maxima, but it has saddle points which steps hardly leave: a tet that has been
/// rotated by 180 degrees starts at one.
template <class S, int W>
TETSKIN_INLINE void turnToMaximum(const WideMatrix<S, W>& f, Quaternions<S, W>& q, WideMatrix<S, W>& r,
                                  WideMatrix<S, W>& s) {
  const auto follow = [&] {
    r = rotationOf<S, W>(q);
    s = transposedProduct<S, W>(r, f);
  };
  follow();
  RotationStep<S, W> step{};
  bool turning = true;
  for (int k = 0; k < kMaxSteps && turning; ++k) {
    step = turnAlong<S, W>(q, s);
    follow();
    turning = anyAbove<S, W>(step.squaredAngle, kLastStep<S>);
  }
  if (!turning && !anyAbove<S, W>(step.unsafe, S(0.5))) return;
  const Lanes<S, W> stillTurning = (step.squaredAngle > kLastStep<S>) ? all<S, W>(1) : Lanes<S, W>{};
  const Lanes<S, W> lost = larger(atNoMaximum<S, W>(s), stillTurning);
  if (!anyAbove<S, W>(lost, S(0.5))) return;
  findRotations<S, W>(f, lost, q);
  follow();
}

template <class S, int W>
TETSKIN_INLINE WideVector<S, W> rotated(const WideMatrix<S, W>& r, const Lanes<S, W>& x, const Lanes<S, W>& y,
                                        const Lanes<S, W>& z) {
  return {r.at[0] * x + r.at[1] * y + r.at[2] * z, r.at[3] * x + r.at[4] * y + r.at[5] * z,
          r.at[6] * x + r.at[7] * y + r.at[8] * z};
}

/// V R (2 mu E + lambda tr(E)): maps a vector to the rotated stress times the vector.
template <class S, int W>
struct RotatedStress {
  WideMatrix<S, W> r, stress;

  TETSKIN_INLINE WideVector<S, W> operator()(const Lanes<S, W>& x, const Lanes<S, W>& y, const Lanes<S, W>& z) const {
    const auto* t = stress.at;
    return rotated<S, W>(r, t[0] * x + t[1] * y + t[2] * z, t[3] * x + t[4] * y + t[5] * z,
                         t[6] * x + t[7] * y + t[8] * z);
  }
};

/// The parts of `TetFindings`.
template <class S, int W>
struct WideFindings {
  Lanes<S, W> squashed{}, maxTurned{}, turned{};  ///< the first one: 1 - the ratio of volumes
  double energy = 0.0;
  bool yields = false;

  TetFindings<S> all() const {
    return {S(1) - largest<S, W>(squashed), largest<S, W>(maxTurned), static_cast<double>(laneSum<S, W>(turned)),
            energy, yields};
  }
};

/// Stores the rotations of W points.
/// assembled  rotations with which the matrix was assembled
template <class S, int W>
TETSKIN_INLINE void keepRotations(const Quaternions<S, W>& q, S* rotations, const S* assembled,
                                  WideFindings<S, W>& findings) {
  put<S, W>(q.w, rotations);
  put<S, W>(q.x, rotations + kGroup);
  put<S, W>(q.y, rotations + 2 * kGroup);
  put<S, W>(q.z, rotations + 3 * kGroup);
  const Lanes<S, W> turn = squaredDifference<S, W>(q, quaternions<S, W>(assembled));
  findings.maxTurned = larger(turn, findings.maxTurned);
  findings.turned += turn;
}

/// The stress of strains E with these traces, and its energy; `shear` and `bulk` are 2 mu V and lambda V.
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> stressOf(const WideMatrix<S, W>& strain, const Lanes<S, W>& trace,
                                         const Lanes<S, W>& shear, const Lanes<S, W>& bulk, bool withEnergy,
                                         WideFindings<S, W>& findings) {
  using V = Lanes<S, W>;
  const V pressure = bulk * trace;
  const auto* e = strain.at;
  if (withEnergy) {
    V squares{};
    for (int k = 0; k < 9; ++k) squares += e[k] * e[k];
    findings.energy += 0.5 * static_cast<double>(laneSum<S, W>(shear * squares + pressure * trace));
  }
  return {{shear * e[0] + pressure, shear * e[1], shear * e[2], shear * e[3], shear * e[4] + pressure, shear * e[5],
           shear * e[6], shear * e[7], shear * e[8] + pressure}};
}

/// The frames of W tets, see above; without frames, everything is 0, and G is F.
template <class S, int W>
struct WideFrames {
  Quaternions<S, W> q;
  WideMatrix<S, W> rotation;
  Lanes<S, W> one;  ///< to subtract from the diagonal of sym(R^T G)
};

template <class S, int W>
TETSKIN_INLINE WideFrames<S, W> framesOf(const Quaternions<S, W>& q) {
  return WideFrames<S, W>{q, rotationOf<S, W>(q), Lanes<S, W>{}};
}

/// The frame of all tets, if there is only one.
template <class S, int W, class Work>
TETSKIN_INLINE WideFrames<S, W> commonFrame(const Work& work) {
  if (!work.frames) {
    WideFrames<S, W> none{};
    none.one = all<S, W>(1);
    return none;
  }
  const S* q = work.frames;
  return framesOf<S, W>({all<S, W>(q[0]), all<S, W>(q[1]), all<S, W>(q[2]), all<S, W>(q[3])});
}

/// common  see `commonFrame`
template <class S, int W, class Work, class Pack>
TETSKIN_INLINE WideFrames<S, W> framesAt(const Work& work, const Pack& pack, int lane, const WideFrames<S, W>& common) {
  if (!work.frames || !work.partOf) return common;
  std::uint32_t parts[W];
  for (int i = 0; i < W; ++i) parts[i] = work.partOf[pack.nodes[0][lane + i]];
  const WidePoints<S, W> q = pointsAt<S, W>(work.frames, parts);
  return framesOf<S, W>({q.x, q.y, q.z, q.w});
}

/// F of a tet that has collapsed to a point, within the rounding of G + Q: its rotation is undefined.
template <class S>
constexpr S kCollapsed = sizeof(S) == sizeof(float) ? S(1e-5) : S(1e-13);

/// F
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> deformationGradient(const WideMatrix<S, W>& g, const WideFrames<S, W>& frame) {
  using V = Lanes<S, W>;
  WideMatrix<S, W> f;
  V squared{};
  for (int k = 0; k < 9; ++k) {
    f.at[k] = g.at[k] + frame.rotation.at[k];
    squared += f.at[k] * f.at[k];
  }
  const auto collapsed = (squared < kCollapsed<S> * kCollapsed<S>)&(frame.one < S(0.5));
  for (V& x : f.at) x = collapsed ? V{} : x;
  return f;
}

/// E
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> strainOf(const Quaternions<S, W>& q, const WideMatrix<S, W>& r,
                                         const WideMatrix<S, W>& g, const WideFrames<S, W>& frame) {
  using V = Lanes<S, W>;
  const Quaternions<S, W>& p = frame.q;
  const V x = q.w * p.x - p.w * q.x - (q.y * p.z - q.z * p.y), y = q.w * p.y - p.w * q.y - (q.z * p.x - q.x * p.z);
  const V z = q.w * p.z - p.w * q.z - (q.x * p.y - q.y * p.x);
  const V xx = S(2) * x * x, yy = S(2) * y * y, zz = S(2) * z * z;
  const WideMatrix<S, W> s = transposedProduct<S, W>(r, g);
  const V xy = S(0.5) * (s.at[1] + s.at[3]) + S(2) * x * y, xz = S(0.5) * (s.at[2] + s.at[6]) + S(2) * x * z;
  const V yz = S(0.5) * (s.at[5] + s.at[7]) + S(2) * y * z;
  return {{s.at[0] - (yy + zz) - frame.one, xy, xz, xy, s.at[4] - (xx + zz) - frame.one, yz, xz, yz,
           s.at[8] - (xx + yy) - frame.one}};
}

template <class S, int W>
TETSKIN_INLINE Lanes<S, W> traceOf(const WideMatrix<S, W>& a) {
  return a.at[0] + a.at[4] + a.at[8];
}

template <class S, int W>
TETSKIN_INLINE Lanes<S, W> determinantOf(const WideMatrix<S, W>& matrix) {
  const auto* a = matrix.at;
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

/// stretch  R^T F
/// shear    0 where there is no tet
template <class S, int W>
TETSKIN_INLINE void noteVolumes(const WideMatrix<S, W>& stretch, const Lanes<S, W>& shear,
                                WideFindings<S, W>& findings) {
  const Lanes<S, W> squashed = all<S, W>(S(1)) - determinantOf<S, W>(stretch);
  findings.squashed = larger(shear > S(0) ? squashed : findings.squashed, findings.squashed);
}

/// Adds the forces on the nodes of W tets to the points of these nodes, tet by tet.
/// from  by tet and node
template <class S, int W, class Pack>
TETSKIN_INLINE void addToNodes(const Pack& pack, int lane, const S* from, S* sums) {
  using V = Lanes<S, 4>;
  for (int i = 0; i < W; ++i) {
    for (std::size_t a = 0; a < Pack::kNodes; ++a) {
      S* const to = sums + 4 * static_cast<std::size_t>(pack.nodes[a][lane + i]);
      V force, sum;
      ::memcpy(&force, from + 4 * (Pack::kNodes * static_cast<std::size_t>(i) + a), sizeof force);
      ::memcpy(&sum, to, sizeof sum);
      sum += force;
      ::memcpy(to, &sum, sizeof sum);
    }
  }
}

/// The factor of the stiffness in the matrix, beside that of its tets.
/// at        index in `alphas`
/// gradient  returns F
template <class S, int W, class Pack, class Gradient>
TETSKIN_INLINE Lanes<S, W> alphaOf(const TetWork<S, Pack>& work, std::size_t at, Gradient&& gradient) {
  if (work.flatAlpha == work.alpha) return all<S, W>(work.alpha);
  if (!work.points) return wide<S, W>(work.alphas + at);
  const Lanes<S, W> ratio = determinantOf<S, W>(gradient());
  const Lanes<S, W> alpha = ratio < S(kFlatVolume) ? all<S, W>(work.flatAlpha) : all<S, W>(work.alpha);
  put<S, W>(alpha, work.alphas + at);
  return alpha;
}

/// What gradients of shape functions are multiplied by, for the matrix.
/// mu  mu V
template <class S, int W, class Pack>
TETSKIN_INLINE Lanes<S, W> gradientFactor(const TetWork<S, Pack>& work, std::size_t pack, int lane,
                                          const Lanes<S, W>& alpha, const Lanes<S, W>& mu) {
  Lanes<S, W> squared = alpha * mu;
  if (work.factors) squared *= wide<S, W>(work.factors + kGroup * pack + static_cast<std::size_t>(lane));
  return squareRoots<S, W>(squared);
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
