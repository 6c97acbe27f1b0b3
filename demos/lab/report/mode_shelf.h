// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <memory>

#include "scenes/reduction.h"

namespace tetskin::report {

/// The vibration modes of the reference, which the reduced bodies of one scene share.
class ModeShelf {
 public:
  /// maximum  the largest number of modes that any body uses
  explicit ModeShelf(int maximum) : max_(maximum) {}

  /// The reduction for the bodies of a cage. Throws InputError.
  /// reference  the same in all calls
  std::shared_ptr<scenes::Reduction> reductionOf(const TriangleMesh& mesh, const Cage& reference, const Cage& cage);

 private:
  int max_;
  std::shared_ptr<scenes::Reduction> reduction_;
};

}  // namespace tetskin::report
