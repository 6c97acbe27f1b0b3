// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tetskin::elastic_detail {

/// Pseudorandom numbers from -0.5 to 0.5 that are the same on every machine.
inline Eigen::MatrixXd startVectors(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd start(rows, columns);
  std::uint32_t state = 1;
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    state = 1664525u * state + 1013904223u;
    start.data()[k] = static_cast<double>(state >> 8) / (1 << 24) - 0.5;
  }
  return start;
}

}  // namespace tetskin::elastic_detail
