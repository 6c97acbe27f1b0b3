// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/state/world_state.h>

namespace tetskin::bullet_detail {

void visitSoftBodies(WorldStream& /*stream*/) {}

}  // namespace tetskin::bullet_detail
