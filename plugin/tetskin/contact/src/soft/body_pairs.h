// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: which bodies may touch.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <utility>
#include <vector>

namespace tetskin::contact_detail {

/// Pairs of places in the list of boxes that meet, both ways around and each with itself, in the order of their first
/// places and then of their second ones. Cost O(n log n) for bodies that lie apart along some axis.
std::vector<std::pair<std::size_t, std::size_t>> pairsOfBoxesThatMeet(const std::vector<ContactBox>& boxes);

}  // namespace tetskin::contact_detail
