// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

namespace tetskin::bench {

/// What trees of faces cost a body, and what they give: FaceTree, Ray, Step.
void registerBodyCases();

}  // namespace tetskin::bench
