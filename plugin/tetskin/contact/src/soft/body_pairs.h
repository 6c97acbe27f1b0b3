// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: which bodies may touch.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <utility>
#include <vector>

namespace tetskin::contact_detail {

/// Pairs of places in the list of boxes that meet, each once, and each place with itself, in the order of the smaller
/// places and then of the larger ones. Cost O(n log n) for bodies that lie apart along some axis.
std::vector<std::pair<std::size_t, std::size_t>> pairsOfBoxesThatMeet(const std::vector<ContactBox>& boxes);

}  // namespace tetskin::contact_detail
