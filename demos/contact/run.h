// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One scene's run: which solver it uses, and what was measured in it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace tetskin::contact_demo {

/// What solves soft bodies, and which points of them meet rigid bodies.
enum class Kind {
  Surface,  ///< the library's solver, and the visual surface
  Nodes,    ///< the library's solver, and the cage's nodes
  Bullet,   ///< Bullet's solver and linear elasticity, and the cage's nodes
};

struct Figure {
  std::string name;
  double value = 0.0;
};

/// Filled in by a scene.
struct Run {
  explicit Run(Kind which) : kind(which) {}

  /// Drops the sign of NaN, which is not reproducible.
  void report(const std::string& name, double value) {
    figures.push_back({name, std::isnan(value) ? std::nan("") : value});
  }

  Kind kind;
  std::vector<Figure> figures;
  long steps = 0, iterations = 0;  ///< of all worlds; iterations are those of the library's solver
};

}  // namespace tetskin::contact_demo
