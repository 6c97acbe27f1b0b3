// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's tets that point to nodes which no longer exist.
#pragma once

#include <tetskin/bullet/soft_body.h>

namespace tetskin::bullet_detail {

/// IndexOutOfRange if `readTetMesh` has read such tets: how many, why, and what to do.
TETSKIN_BULLET_API Status checkDangling(const TetMesh& read);

}  // namespace tetskin::bullet_detail
