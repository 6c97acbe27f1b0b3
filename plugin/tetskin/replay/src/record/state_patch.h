// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to Recorder: the difference of two snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tetskin::bullet_detail {

using Bytes = std::vector<unsigned char>;

/// Runs of differing bytes, each with its position and its bytes; if the lengths differ, one run between the common
/// beginning and the common end. Empty if they are equal. Cost O(length)
Bytes differenceOf(const Bytes& from, const Bytes& to);

/// Computes `to` from the difference and `from`; empty if the difference does not belong to `from`.
std::optional<Bytes> applied(const Bytes& difference, const Bytes& from);

}  // namespace tetskin::bullet_detail
