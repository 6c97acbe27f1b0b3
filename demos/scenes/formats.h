// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <string>

#include "scenes/command_line.h"

namespace tetskin::scenes {

/// The files that a run writes besides its summary and its page.
struct Formats {
  bool obj = true;   ///< every n-th frame in a separate file
  bool glb = false;  ///< all frames in one file
  bool pc2 = false;  ///< every n-th frame in one file, and the mesh in another
};

/// The formats that the command line requests; without a request, OBJ and, if this build can write it, GLB.
Formats formatsOf(const OutputOptions& options);

/// The first file that a run writes, for its summary.
std::string firstFileOf(const OutputOptions& options);

/// Throws InputError if a requested format cannot be written; prints why a default one is not.
void requireFormats(const OutputOptions& options);

}  // namespace tetskin::scenes
