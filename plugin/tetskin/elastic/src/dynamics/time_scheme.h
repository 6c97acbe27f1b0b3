// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The weights of a step in time, dt.
//
// A velocity u is the displacement of a step over dt, and so belongs to the middle of the step. The impulse between two
// of them belongs to the instant between, at which positions are known: dt f(x) is of second order. Backward Euler
// takes the forces a step later, which damps as much as a material whose damping is longer by dt. Here a step adds to
// dt f(x)
//   - dt damping K u' - a (dt (dt - damping) K u' - H)
// with u' the new velocity: the material's damping, and a difference that settles vibrations which are too fast for
// dt. H is the mean of dt (dt - damping) K u over the steps before, with weights (1 - a) a^k, so that the difference is
// small for what is smooth:
//   alpha = dt ((1 - a) damping + a dt),   (M + alpha K) u' = M u + dt f(x) + a H
//   H <- a H + (1 - a) dt (dt - damping) K u'
// An undamped step is stable for a from 1/3 on; with 1/2 it is Houbolt's, which leaves nothing of the fastest
// vibrations. Longer damping takes another a, for which it acts at the instant of the forces, too. A step of first
// order has no H: a is 0, or, where the damping is shorter than dt, 1, which is backward Euler's step without damping.
// See impulse_history.h for when it is taken.
//
// This work is based on:
//   John C. Houbolt, "A Recurrence Matrix Solution for the Dynamic Response of Elastic Aircraft", Journal of the
//   Aeronautical Sciences 17(9), 1950, doi 10.2514/8.1722
#pragma once

namespace tetskin::elastic_detail {

struct TimeScheme {
  double filter = 0.0;   ///< a, from 0 to 1
  double damping = 0.0;  ///< seconds; at least the material's
  double carried = 0.0;  ///< share of alpha K w that the right side has beside M u: see `carryingOn`

  double alpha(double seconds) const { return seconds * ((1.0 - filter) * damping + filter * seconds); }
};

/// seconds  above 0;  damping  the material's, in seconds, at least 0
TimeScheme secondOrder(double seconds, double damping);
/// Where there is no step before, or steps do not follow the motion: see impulse_history.h.
TimeScheme firstOrder(double seconds, double damping);
/// Where contacts come and go. The step begins with u, and carries on w, the deviation from rigid motion with which the
/// last one has ended, by its own matrix:
///   (M + dt (damping + dt / 2) K) u' = M u + theta dt^2 / 2 K w + dt f(x)
/// For a vibration and theta = 1, this is Newmark's method with beta = gamma = 1/2: of second order, without damping of
/// its own. The forces may be up to twice as stiff as K. A smaller theta damps by (1 - theta) dt / 2.
/// theta  from 0 to 1
TimeScheme carryingOn(double seconds, double damping, double theta);
/// Where something holds the body flat, as flat tets are stiffer than K by any factor; for stiff bodies; and in contact
/// where steps vary in length.
TimeScheme backwardEuler(double seconds, double damping);

}  // namespace tetskin::elastic_detail
