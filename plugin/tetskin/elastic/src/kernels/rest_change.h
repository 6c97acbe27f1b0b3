// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: rest shapes that change, at W points at a time.
//
// With D the deformation gradient from a tet's first rest shape to a given one (it grows, contracts), and P that of its
// plastic flow, what is elastic of F is F (P D)^-1. The energy is that of corotation.h for it, times det D: it counts
// by the volume to which the tet has grown. So gradients g of shape functions become (P D)^-T g.
//
// Plastic flow is von Mises's with isotropic hardening: the deviator of E is returned to the yield surface along
// itself, and the elastic stretch U = 1 + E keeps its volume. P becomes P times the inverse of what is left of U.
//
// This work is based on:
//   Juan C. Simo, Thomas J. R. Hughes, "Computational Inelasticity", 1998, chapter 3 (radial return)
//   Geoffrey Irving, Joseph Teran, Ronald Fedkiw, "Invertible Finite Elements For Robust Simulation of Large
//   Deformation", SCA 2004, doi 10.1145/1028523.1028541 (multiplicative plasticity)
#pragma once

#include <tetskin/elastic/src/kernels/hyperelasticity.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> product(const WideMatrix<S, W>& a, const WideMatrix<S, W>& b) {
  WideMatrix<S, W> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      c.at[3 * i + j] = a.at[3 * i] * b.at[j] + a.at[3 * i + 1] * b.at[3 + j] + a.at[3 * i + 2] * b.at[6 + j];
    }
  }
  return c;
}

/// a + a b^T
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> plusTransposedProduct(const WideMatrix<S, W>& a, const WideMatrix<S, W>& b) {
  WideMatrix<S, W> c;
  for (int i = 0; i < 3; ++i) {
    const auto* row = a.at + 3 * i;
    for (int j = 0; j < 3; ++j) {
      c.at[3 * i + j] = row[j] + (row[0] * b.at[3 * j] + row[1] * b.at[3 * j + 1] + row[2] * b.at[3 * j + 2]);
    }
  }
  return c;
}

/// The inverse of a matrix times its determinant.
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> adjugateOf(const WideMatrix<S, W>& matrix) {
  const auto* a = matrix.at;
  return {{a[4] * a[8] - a[5] * a[7], a[2] * a[7] - a[1] * a[8], a[1] * a[5] - a[2] * a[4], a[5] * a[6] - a[3] * a[8],
           a[0] * a[8] - a[2] * a[6], a[2] * a[3] - a[0] * a[5], a[3] * a[7] - a[4] * a[6], a[1] * a[6] - a[0] * a[7],
           a[0] * a[4] - a[1] * a[3]}};
}

/// Of x from 0.01 to 1 to the last digits, of 0.001 to a hundredth (Halley's steps).
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> cubeRoots(const Lanes<S, W>& x) {
  Lanes<S, W> root = S(1) / S(3) * x + S(2) / S(3);
  for (int k = 0; k < 5; ++k) {
    const Lanes<S, W> cube = root * root * root;
    root *= (cube + x + x) / (cube + cube + x);
  }
  return root;
}

/// (P D)^-1 - 1, and det D.
template <class S, int W>
struct WideChange {
  WideMatrix<S, W> inverse;
  Lanes<S, W> volume;
};

template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> wideMatrix(const S* from) {
  WideMatrix<S, W> matrix;
  for (int k = 0; k < 9; ++k) matrix.at[k] = wide<S, W>(from + k * kGroup);
  return matrix;
}

template <class S, int W>
TETSKIN_INLINE WideChange<S, W> changeOf(const S* from) {
  return {wideMatrix<S, W>(from), wide<S, W>(from + 9 * kGroup)};
}

/// The changes of W tets at one of their points.
/// at  number of the pack's point, see TetWork::changes
template <class S, int W, class Work>
TETSKIN_INLINE WideChange<S, W> changesAt(const Work& work, std::size_t at, int lane) {
  return changeOf<S, W>(work.changes + kChange * at + static_cast<std::size_t>(lane));
}

/// The elastic part of a gradient: F (P D)^-1 - Q
/// g  F - Q
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> elasticPart(const WideMatrix<S, W>& g, const WideFrames<S, W>& frame,
                                            const WideChange<S, W>& change) {
  WideMatrix<S, W> f;
  for (int k = 0; k < 9; ++k) f.at[k] = g.at[k] + frame.rotation.at[k];
  WideMatrix<S, W> part = product<S, W>(f, change.inverse);
  for (int k = 0; k < 9; ++k) part.at[k] += g.at[k];
  return part;
}

/// Adds how far the rest shapes are from those of the matrix, as an angle would count: strains for radians.
template <class S, int W>
TETSKIN_INLINE void noteChange(const WideChange<S, W>& change, const S* assembled, WideFindings<S, W>& findings) {
  Lanes<S, W> squared{};
  for (int k = 0; k < 9; ++k) {
    const Lanes<S, W> difference = change.inverse.at[k] - wide<S, W>(assembled + k * kGroup);
    squared += difference * difference;
  }
  const Lanes<S, W> turn = S(0.25) * squared;
  findings.maxTurned = larger(turn, findings.maxTurned);
  findings.turned += turn;
}

/// The square of the plastic strain that remains: that of a logarithmic one, |log P|^2 times 2/3, up to its fourth
/// power. CorotatedTets::setPlasticity gives its limit in this measure.
/// inverse  of P, whose volume is 1
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> squaredPlasticStrain(const WideMatrix<S, W>& inverse) {
  const WideMatrix<S, W> own = adjugateOf<S, W>(inverse);
  Lanes<S, W> squares{};
  for (int k = 0; k < 9; ++k) squares += inverse.at[k] * inverse.at[k] + own.at[k] * own.at[k];
  return S(1) / S(6) * (squares - S(6));
}

/// What flows at W points.
template <class S, int W>
struct WideFlow {
  WideMatrix<S, W> strain, inverse;  ///< E and (P D)^-1 - 1 after it
};

/// part  of the deviator that flows, 0 to 1
template <class S, int W>
TETSKIN_INLINE WideFlow<S, W> flowBy(const Lanes<S, W>& part, const WideMatrix<S, W>& strain, const Lanes<S, W>& volume,
                                     const WideChange<S, W>& change) {
  using V = Lanes<S, W>;
  const V mean = S(1) / S(3) * traceOf<S, W>(strain);
  WideMatrix<S, W> stretch = strain, left, total = change.inverse;
  for (int k = 0; k < 9; ++k) {
    const V one = all<S, W>(S(k % 4 == 0 ? 1 : 0));
    stretch.at[k] += one;
    total.at[k] += one;
    left.at[k] = stretch.at[k] - part * (strain.at[k] - one * mean);
  }
  // The volume is kept; that of P, which rounding changes in many steps, is led back to 1.
  const V drift =
      smaller(larger(change.volume * determinantOf<S, W>(total) - S(1), all<S, W>(S(-0.5))), all<S, W>(S(0.5)));
  const V scale =
      cubeRoots<S, W>(larger(volume / determinantOf<S, W>(left), all<S, W>(S(1e-3)))) * (S(1) - S(1) / S(3) * drift);
  WideFlow<S, W> flow;
  for (int k = 0; k < 9; ++k) {
    left.at[k] *= scale;
    flow.strain.at[k] = left.at[k] - S(k % 4 == 0 ? 1 : 0);
    left.at[k] -= stretch.at[k];
  }
  const V inverseVolume = S(1) / volume;
  WideMatrix<S, W> inverse = adjugateOf<S, W>(stretch);
  for (V& x : inverse.at) x *= inverseVolume;
  flow.inverse = product<S, W>(total, product<S, W>(inverse, left));
  for (int k = 0; k < 9; ++k) flow.inverse.at[k] += change.inverse.at[k];
  return flow;
}

/// The inverse of P.
/// given  D; null: 1
template <class S, int W>
TETSKIN_INLINE WideMatrix<S, W> plasticInverse(const S* given, WideMatrix<S, W> inverse) {
  for (int k = 0; k < 9; k += 4) inverse.at[k] += S(1);
  return given ? product<S, W>(wideMatrix<S, W>(given), inverse) : inverse;
}

/// The part of a flow up to which no more plastic strain remains than `largest`.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> allowedPart(S largest, const WideMatrix<S, W>& before, const WideMatrix<S, W>& after) {
  using V = Lanes<S, W>;
  const V squaredBefore = squaredPlasticStrain<S, W>(before), squaredAfter = squaredPlasticStrain<S, W>(after);
  const V old = squareRoots<S, W>(larger(squaredBefore, V{})), next = squareRoots<S, W>(larger(squaredAfter, V{}));
  const V over = next - larger(old, all<S, W>(largest)), way = next - old;
  const auto tooFar = (over > S(0)) & (way > S(0));
  return tooFar ? larger(S(1) - over / (way > S(0) ? way : all<S, W>(1)), V{}) : all<S, W>(1);
}

/// Twice the energy of strains.
template <class S, int W>
TETSKIN_INLINE Lanes<S, W> twiceEnergyOf(const WideMatrix<S, W>& strain, const Lanes<S, W>& shear,
                                         const Lanes<S, W>& bulk) {
  const Lanes<S, W> trace = traceOf<S, W>(strain);
  Lanes<S, W> squares{};
  for (int k = 0; k < 9; ++k) squares += strain.at[k] * strain.at[k];
  return shear * squares + bulk * trace * trace;
}

/// Lets W points flow whose strains are beyond the yield surface: changes strains, rest shapes, and what has flowed.
/// norm, limit  of the deviator of E, and the one at which it yields
template <class S, int W, class Work>
TETSKIN_NOINLINE void flow(const Work& work, std::size_t at, int lane, const Lanes<S, W>& shear,
                           const Lanes<S, W>& bulk, const Lanes<S, W>& norm, const Lanes<S, W>& limit,
                           const Lanes<S, W>& hardening, WideMatrix<S, W>& strain, WideChange<S, W>& change) {
  using V = Lanes<S, W>;
  constexpr S kRoot = S(1.224744871391589);  // of 3/2: the norm of a deviator over its equivalent strain
  // What is nearly flat, or inverted, does not flow.
  constexpr S kLeastVolume = S(0.05);
  WideMatrix<S, W> stretch = strain;
  for (int k = 0; k < 9; k += 4) stretch.at[k] += S(1);
  const V volume = determinantOf<S, W>(stretch);
  auto flows = (norm > limit) & (volume > kLeastVolume);
  V amount = work.flowShare * (norm - limit) / (kRoot + hardening);
  amount = flows ? amount : V{};
  const V safeNorm = flows ? norm : all<S, W>(1), safeVolume = flows ? volume : all<S, W>(1);
  V part = kRoot * amount / safeNorm;
  WideFlow<S, W> next = flowBy<S, W>(part, strain, safeVolume, change);
  S* const flowed = work.flowed + kGroup * at + static_cast<std::size_t>(lane);
  const V before = wide<S, W>(flowed);
  // So much flow leaves less strain than is allowed, in any directions and down to the least volume.
  constexpr S kCertain = S(0.12);
  if (anyAbove<S, W>(before + amount - kCertain * work.largestStrain, S(0))) {
    const S* given = work.given ? work.given + 9 * kGroup * at + static_cast<std::size_t>(lane) : nullptr;
    const V allowed = allowedPart<S, W>(work.largestStrain, plasticInverse<S, W>(given, change.inverse),
                                        plasticInverse<S, W>(given, next.inverse));
    if (anyAbove<S, W>(S(1) - allowed, S(0))) {
      part *= allowed;
      amount *= allowed;
      next = flowBy<S, W>(part, strain, safeVolume, change);
    }
  }
  // Where a tet is pressed nearly flat, keeping the volume would cost more than the flow releases.
  flows &= !(twiceEnergyOf<S, W>(next.strain, shear, bulk) > twiceEnergyOf<S, W>(strain, shear, bulk));
  put<S, W>(before + (flows ? amount : V{}), flowed);
  S* const to = work.changes + kChange * at + static_cast<std::size_t>(lane);
  for (int k = 0; k < 9; ++k) {
    strain.at[k] = flows ? next.strain.at[k] : strain.at[k];
    change.inverse.at[k] = flows ? next.inverse.at[k] : change.inverse.at[k];
    put<S, W>(change.inverse.at[k], to + k * kGroup);
  }
}

/// Lets those of W points flow that yield. Returns false if there is none.
/// lost  1 for tets that do not flow
template <class S, int W, class Work>
TETSKIN_INLINE bool flowWhereYielding(const Work& work, std::size_t pack, std::size_t at, int lane,
                                      const Lanes<S, W>& lost, const Lanes<S, W>& shear, const Lanes<S, W>& bulk,
                                      WideMatrix<S, W>& strain, WideChange<S, W>& change,
                                      WideFindings<S, W>& findings) {
  using V = Lanes<S, W>;
  if (!work.yields) return false;
  const auto* e = strain.at;
  const V mean = S(1) / S(3) * traceOf<S, W>(strain), x = e[0] - mean, y = e[4] - mean, z = e[8] - mean;
  V squared = x * x + y * y + z * z + S(2) * (e[1] * e[1] + e[2] * e[2] + e[5] * e[5]);
  const S* yields = work.yields + 2 * kGroup * pack + static_cast<std::size_t>(lane);
  const V yield = wide<S, W>(yields), hardening = wide<S, W>(yields + kGroup);
  const V flowed = wide<S, W>(work.flowed + kGroup * at + static_cast<std::size_t>(lane));
  const V limit = yield + hardening * flowed;
  squared = ((lost > S(0)) | !(shear > S(0))) ? V{} : squared;  // nor do those that repeat the last tet
  if (!anyAbove<S, W>(squared - limit * limit, S(0))) return false;
  findings.yields = true;
  if (work.flowShare == S(0)) return false;
  flow<S, W>(work, at, lane, shear, bulk, squareRoots<S, W>(squared), limit, hardening, strain, change);
  return true;
}

/// F, of its elastic part
template <class S, int W, class Work>
TETSKIN_INLINE WideMatrix<S, W> elasticGradient(const Work& work, std::size_t at, int lane, WideMatrix<S, W> g,
                                                const WideFrames<S, W>& frame) {
  if (work.changes) g = elasticPart<S, W>(g, frame, changesAt<S, W>(work, at, lane));
  return deformationGradient<S, W>(g, frame);
}

/// What rotates the gradients of shape functions, and mu V, for the rest shapes of the matrix.
template <class S, int W, class Work>
TETSKIN_INLINE void changeRest(const Work& work, std::size_t at, int lane, WideMatrix<S, W>& r, Lanes<S, W>& mu) {
  const WideChange<S, W> change = changeOf<S, W>(work.assembledChanges + kChange * at + static_cast<std::size_t>(lane));
  r = plusTransposedProduct<S, W>(r, change.inverse);
  mu *= change.volume;
}

/// The stress of strains E by the law of each tet.
/// first  no point of this pack was asked before in this pass
/// lost   1 for tets that are corotated at present, whatever their law
template <class S, int W, class Work>
TETSKIN_INLINE WideMatrix<S, W> stressByLaw(const Work& work, std::size_t pack, bool first, int lane,
                                            const Lanes<S, W>& lost, const WideMatrix<S, W>& strain,
                                            const Lanes<S, W>& trace, const Lanes<S, W>& shear, const Lanes<S, W>& bulk,
                                            bool withEnergy, WideFindings<S, W>& findings) {
  using V = Lanes<S, W>;
  if (!work.laws) return stressOf<S, W>(strain, trace, shear, bulk, withEnergy, findings);
  const S* from = work.laws + kLaw * pack + static_cast<std::size_t>(lane);
  const auto other = (wide<S, W>(from) > S(0)) & !(lost > S(0));
  const WideLaw<S, W> law{other ? shear : V{}, other ? bulk : V{}, wide<S, W>(from + kGroup),
                          wide<S, W>(from + 2 * kGroup), wide<S, W>(from + 3 * kGroup)};
  WideMatrix<S, W> stress =
      stressOf<S, W>(strain, trace, other ? V{} : shear, other ? V{} : bulk, withEnergy, findings);
  const V stiffer = addLaw<S, W>(law, strain, withEnergy, stress, findings);
  if (!work.stiffer) return stress;
  S* const to = work.stiffer + kGroup * pack + static_cast<std::size_t>(lane);
  put<S, W>(first ? stiffer : larger(stiffer, wide<S, W>(to)), to);
  return stress;
}

/// Updates the rotations of W points, and what flows there.
/// pack, at     number of the pack, and of its point
/// g            gradients of points
/// shear, bulk  2 mu V and lambda V
template <class S, int W, class Work>
TETSKIN_INLINE RotatedStress<S, W> rotatedStress(const Work& work, std::size_t pack, std::size_t at, int lane,
                                                 WideMatrix<S, W> g, const WideFrames<S, W>& frame, Lanes<S, W> shear,
                                                 Lanes<S, W> bulk, bool withEnergy, WideFindings<S, W>& findings) {
  const std::size_t rotations = 4 * kGroup * at + static_cast<std::size_t>(lane);
  WideChange<S, W> change{};
  if (work.changes) {
    change = changesAt<S, W>(work, at, lane);
    g = elasticPart<S, W>(g, frame, change);
  }
  Quaternions<S, W> q = quaternions<S, W>(work.rotations + rotations);
  WideMatrix<S, W> r, s;
  turnToMaximum<S, W>(deformationGradient<S, W>(g, frame), q, r, s);
  keepRotations<S, W>(q, work.rotations + rotations, work.assembled + rotations, findings);
  noteVolumes<S, W>(s, shear, findings);
  WideMatrix<S, W> strain = strainOf<S, W>(q, r, g, frame);
  if (work.changes) {
    flowWhereYielding<S, W>(work, pack, at, lane, Lanes<S, W>{}, shear, bulk, strain, change, findings);
    noteChange<S, W>(change, work.assembledChanges + kChange * at + static_cast<std::size_t>(lane), findings);
    shear *= change.volume;
    bulk *= change.volume;
  }
  RotatedStress<S, W> stress{r, stressByLaw<S, W>(work, pack, true, lane, Lanes<S, W>{}, strain, traceOf<S, W>(strain),
                                                  shear, bulk, withEnergy, findings)};
  if (work.changes) stress.stress = plusTransposedProduct<S, W>(stress.stress, change.inverse);
  return stress;
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
