// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <memory>

#include "scenes/reduction.h"

namespace tetskin::report {

/// The vibrations of the reference, which reduced bodies of one scene share.
class ModeShelf {
 public:
  /// most  modes that any body takes
  explicit ModeShelf(int most) : most_(most) {}

  /// For the bodies of a cage. Throws InputError.
  /// reference  the same in all calls
  std::shared_ptr<scenes::Reduction> of(const TriangleMesh& mesh, const Cage& reference, const Cage& cage);

 private:
  int most_;
  std::shared_ptr<scenes::Reduction> reduction_;
};

}  // namespace tetskin::report
