// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds which bodies may touch.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <utility>
#include <vector>

namespace tetskin::contact_detail {

/// Pairs of indices of boxes that overlap, each pair once, and each index with itself; sorted by the smaller index and
/// then by the larger one. Cost O(n log n) for bodies that are spread along some axis.
std::vector<std::pair<std::size_t, std::size_t>> overlappingBoxPairs(const std::vector<ContactBox>& boxes);

}  // namespace tetskin::contact_detail
