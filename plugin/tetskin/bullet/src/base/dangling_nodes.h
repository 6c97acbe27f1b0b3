// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Tets of Bullet's that point to nodes which are not there any more.
#pragma once

#include <tetskin/bullet/soft_body.h>

namespace tetskin::bullet_detail {

/// IndexOutOfRange if there are such tets in what `readTetMesh` has read: how many, why, and what to do.
TETSKIN_BULLET_API Status checkDangling(const TetMesh& read);

}  // namespace tetskin::bullet_detail
