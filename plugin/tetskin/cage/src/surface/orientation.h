// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/src/surface/surface.h>

namespace tetskin::cage_detail {

/// Makes the triangles' orientation as consistent as possible, in three steps, and sets `openEdges` and `oriented`:
/// - a patch (triangles connected by edges with exactly two triangles) with inconsistent neighbours is made consistent,
///   then turned so that its volume is positive;
/// - a closed patch of negative volume is a cavity if it lies inside another patch; otherwise it was inside out, and is
///   turned;
/// - consistent open patches are left as they are: their author may know better.
/// Cost: linear, plus a winding number tree if there are closed patches of negative volume.
void orient(Surface& surface);

}  // namespace tetskin::cage_detail
