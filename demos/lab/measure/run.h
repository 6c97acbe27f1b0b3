// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene with measurements, and its run: the solver that it uses, and the results.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tetskin::measure {

/// The solver of soft bodies, and which of their points touch rigid bodies.
enum class Kind {
  Surface,  ///< the library's solver, and the visual surface
  Nodes,    ///< the library's solver, and the cage's nodes
  Bullet,   ///< Bullet's solver and linear elasticity, and the cage's nodes
};

struct Figure {
  std::string name;
  double value = 0.0;
};

/// A number as it stands in names: "50", "0.05".
std::string text(double value);

/// Filled in by a scene.
struct Run {
  explicit Run(Kind which) : kind(which) {}

  /// Drops the sign of NaN, which is not reproducible.
  void report(const std::string& name, double value) {
    figures.push_back({name, std::isnan(value) ? std::nan("") : value});
  }

  /// In words, independent of the promises about figures.
  void expect(bool condition, const std::string& what) {
    if (!condition && std::count(broken.begin(), broken.end(), what) == 0) broken.push_back(what);
  }

  Kind kind;
  std::vector<Figure> figures;
  std::vector<std::string> broken;  ///< the expectations that were not met
  long steps = 0, iterations = 0;   ///< of all worlds; iterations are those of the library's solver
  std::string promised;             ///< the scene by whose name promises are found; empty: its own
  std::string status;               ///< how it ended, in a word, where expectations count rather than figures
  std::uint64_t hash = 0;           ///< of nodes, if it has one
};

enum class Often { Quick, Usual, Long };

/// A function that makes its own world.
struct MeasuredScene {
  std::string name;
  std::function<void(Run&)> run;
  /// the kinds with which it can be run
  std::vector<Kind> kinds = {Kind::Surface, Kind::Nodes, Kind::Bullet};
  Often often = Often::Usual;  ///< Quick: also in small selections; Long: only where asked for

  bool isFor(Kind kind) const { return std::count(kinds.begin(), kinds.end(), kind) > 0; }
};
using MeasuredScenes = std::vector<MeasuredScene>;

}  // namespace tetskin::measure
