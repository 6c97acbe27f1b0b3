// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For other libraries: the checks of a SurfaceContact's options that need no body.
#pragma once

#include <tetskin/contact/surface_contact.h>

namespace tetskin {

/// Ok if a surface can have contact with these options. Cost O(triangles)
/// mesh  valid
TETSKIN_CONTACT_API Status checkContactOptions(const SurfaceContactOptions& options, const TriangleMesh& mesh);

}  // namespace tetskin
