// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body.h>

namespace tetskin::test {

/// The options for a body of 1 kg, unless they set its mass: tests compare momenta and forces.
inline SoftBodyOptions oneKilogram(SoftBodyOptions options = {}) {
  if (!options.mass && options.density == SoftBodyOptions().density) options.mass = 1.0;
  return options;
}

}  // namespace tetskin::test
