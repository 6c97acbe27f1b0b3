// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/cage/painted_maps.h>

namespace tetskin::cage_detail {

/// What `paintCage` says about maps before it looks at a cage.
Status checkMaps(const TriangleMesh& mesh, const PaintedMaps& maps);

}  // namespace tetskin::cage_detail
