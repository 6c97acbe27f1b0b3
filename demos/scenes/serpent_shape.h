// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The serpent's shape, independent of any mesh: a spine, cross-sections along it, and the relief on their outline.
// Angles theta go around a cross-section in radians: 0 at the belly, pi/2 on the left, pi at the back.
#pragma once

#include "scenes/serpent_spine.h"

namespace tetskin::scenes {

/// A smooth cross-section: two half ellipses that meet at the sides.
struct Section {
  Frame frame;
  double halfWidth = 0.0;
  double above = 0.0;  ///< from the spine to the back
  double below = 0.0;  ///< from the spine to the belly

  Eigen::Vector3d point(double theta) const;
};

/// A point on the smooth surface, with the directions there.
struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;    ///< outwards
  Eigen::Vector3d backward;  ///< along the surface, towards the tail
};

class SerpentShape {
 public:
  SerpentShape();

  const Spine& spine() const { return spine_; }
  /// Half the thickness of the body, including the head and the rounded ends.
  double radius(double t) const;
  Section section(double t) const;
  SurfacePoint surface(double t, double theta) const;

  /// The t at which the head begins.
  double headStart() const { return headStart_; }
  /// The t of the position that lies a share h of the head's length in front of the neck.
  double inHead(double h) const { return headStart_ + h * (1.0 - headStart_); }
  /// Height of brows, nostrils, jaw and mouth above the smooth surface, in units of length; 0 on the body.
  double headRelief(double t, double theta) const;
  /// Upper bound of a scale's height, in units of length.
  double scaleHeight(double t) const;
  /// Length of the spikes on the back at t, measured from the smooth surface.
  double spikeLength(double t) const;

 private:
  Spine spine_;
  double headStart_ = 0.0;
};

/// Relief of overlapping scales, in [0, 1]. `row` counts scales from tail to head, `column` those around the body, of
/// `columns` in total from belly to belly; the belly has broad plates instead.
double scalePattern(double row, double column, int columns);

}  // namespace tetskin::scenes
