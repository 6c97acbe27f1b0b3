// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: laws that are not linear in the strain, at W points at a time. With F = R U, C = F^T F and
// J = det F, the energy per volume at rest is Yeoh's, neo-Hookean without its last two terms:
//   mu / 2 (I - 3 + b + c2 K^2 + c3 K^3) - mu (J - 1) + (lambda + mu) / 2 (J - 1)^2
// with I = tr C and K = I - 3 J^(2/3), which is 0 where only the volume changes, and I - 3 where it does not. K has the
// power of J up to second order, as it then holds for inverted tets, too. At rest there is no stress, and small strains
// have the given mu and lambda. Forces follow from F alone, and need no rotation: they are R T g with
//   T = mu (1 - b' + 2 w) U + ((lambda + mu) (J - 1) - mu - 2 (1 - (J - 1) / 3) w) cof U
//   w = mu (c2 K + 3/2 c3 K^2)
// computed from E = U - 1 without losing the digits of small strains. b = max(3 - I, 0)^3 / 27 takes from what has
// nearly collapsed to a point the force that would keep it there. It is pushed apart where tr U < 1, by an energy of
// mu / 2 (1 - tr U)^2.
//
// This work is based on:
//   Breannan Smith, Fernando de Goes, Theodore Kim, "Stable Neo-Hookean Flesh Simulation", ACM Transactions on Graphics
//   37 (2018), doi 10.1145/3180491 (the terms in J, and the conversion of their parameters; b is a logarithm there)
//   Oon H. Yeoh, "Some forms of the strain energy function for rubber", Rubber Chemistry and Technology 66 (1993),
//   doi 10.5254/1.3538343
#pragma once

#include <tetskin/elastic/src/kernels/corotation.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// The law of W tets; 0 in lanes with the corotated one.
template <class S, int W>
struct WideLaw {
  Lanes<S, W> shear, bulk;    ///< 2 mu V, lambda V
  Lanes<S, W> second, third;  ///< c2, c3
  Lanes<S, W> most;           ///< see `largestDistortion`
};

/// The largest of the three numbers whose squares and fourth powers have these sums, from below: exact if they are
/// equal, or if one is far larger than the others.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> largestSquare(const WideMatrix<S, W>& symmetric) {
  using V = Lanes<S, W>;
  const auto* a = symmetric.at;
  const V xx = a[0] * a[0] + a[1] * a[1] + a[2] * a[2], yy = a[1] * a[1] + a[4] * a[4] + a[5] * a[5];
  const V zz = a[2] * a[2] + a[5] * a[5] + a[8] * a[8];
  const V xy = a[0] * a[1] + a[1] * a[4] + a[2] * a[5], xz = a[0] * a[2] + a[1] * a[5] + a[2] * a[8];
  const V yz = a[1] * a[2] + a[4] * a[5] + a[5] * a[8];
  const V squares = xx + yy + zz, fourths = xx * xx + yy * yy + zz * zz + S(2) * (xy * xy + xz * xz + yz * yz);
  return fourths / larger(squares, all<S, W>(S(1e-6)));
}

/// Adds T V to a stress, and its energy to the findings. Returns how much stiffer than at rest the law is there, about;
/// at least 1.
template <class S, int W>
TETSKIN_NOINLINE Lanes<S, W> addLaw(const WideLaw<S, W>& law, const WideMatrix<S, W>& strain, bool withEnergy,
                                    WideMatrix<S, W>& stress, WideFindings<S, W>& findings) {
  using V = Lanes<S, W>;
  constexpr S kThird = S(1) / S(3);  // of polynomials
  const auto* e = strain.at;
  const V zero{}, one = all<S, W>(1), trace = traceOf<S, W>(strain);
  const V squares = e[0] * e[0] + e[4] * e[4] + e[8] * e[8] + S(2) * (e[1] * e[1] + e[2] * e[2] + e[5] * e[5]);
  const V c0 = e[4] * e[8] - e[5] * e[5], c1 = e[2] * e[5] - e[1] * e[8], c2 = e[1] * e[5] - e[2] * e[4];
  const V c4 = e[0] * e[8] - e[2] * e[2], c5 = e[1] * e[2] - e[0] * e[5], c8 = e[0] * e[4] - e[1] * e[1];
  const V cofE[9] = {c0, c1, c2, c1, c4, c5, c2, c5, c8};
  const V determinant = e[0] * c0 + e[1] * c1 + e[2] * c2;
  const V grown = trace + S(0.5) * (trace * trace - squares) + determinant;  // J - 1
  const V sheared = S(2) * (squares - determinant) - trace * trace;          // I - 3 - 2 (J - 1)
  // The power of J is constant from J = 4 on, where its parabola would fall.
  const V bounded = smaller(grown, all<S, W>(S(3)));
  const V distortion = larger(sheared + (grown < S(3) ? kThird * grown * grown : grown + grown - S(3)), zero);  // K
  // Beyond, w stays what it is there.
  const V measured = smaller(distortion, law.most);
  const V mu = S(0.5) * law.shear, volume = law.bulk + mu;
  const V w = mu * measured * (law.second + S(1.5) * law.third * measured);
  const V collapsed = larger(-kThird * (trace + trace + squares), zero), lost = mu * collapsed * collapsed;
  const V apart = larger(S(-2) - trace, zero);  // 1 - tr U
  if (withEnergy) {
    const V stiffened = measured * measured * (law.second + law.third * measured);
    const V cubes = collapsed * collapsed * collapsed;
    const V energy = S(0.5) * (mu * (sheared + cubes + stiffened + apart * apart) + volume * grown * grown);
    findings.energy += static_cast<double>(laneSum<S, W>(energy + w * (distortion - measured)));
  }
  // T = shape (U - cof U) - lost U + pressure cof U - mu apart
  const V shape = mu + S(2) * w, bulging = S(2) * kThird * bounded, pressure = volume * grown + bulging * w;
  WideMatrix<S, W> stretch, cof;
  V direction{};  // the square of the derivative of K
  for (int k = 0; k < 9; ++k) {
    const bool diagonal = k % 4 == 0;
    stretch.at[k] = diagonal ? one + e[k] : e[k];
    cof.at[k] = diagonal ? one + trace - e[k] + cofE[k] : cofE[k] - e[k];
    const V difference = diagonal ? e[k] + e[k] - trace - cofE[k] : e[k] + e[k] - cofE[k];
    stress.at[k] += shape * difference - lost * stretch.at[k] + pressure * cof.at[k];
    if (diagonal) stress.at[k] -= mu * apart;
    const V along = difference + difference + bulging * cof.at[k];
    direction += along * along;
  }
  // The largest second derivatives by stretches that keep the volume, and by others.
  const V slope = distortion < law.most ? mu * (law.second + S(3) * law.third * distortion) : zero;
  const V own = shape - lost, squeezed = larger(shape - pressure, zero);
  const V sideways = own + squeezed * squareRoots<S, W>(largestSquare<S, W>(stretch)) + slope * direction;
  const V along = own + (volume + S(2) * kThird * w) * largestSquare<S, W>(cof);
  const auto has = law.shear > S(0);
  const V perShear = one / (has ? law.shear : one), perBulk = one / (has ? law.bulk + law.shear : one);
  const V stiffer = larger(larger(sideways * perShear, along * perBulk), one);
  return has ? stiffer : one;
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
