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

/// Runs of bytes that differ, each with its place and its bytes; or, where the lengths differ, the one run between what
/// both begin and end with. Empty if they are equal. Cost O(length)
Bytes differenceOf(const Bytes& from, const Bytes& to);

/// `to`, from `from` and the difference; empty if the difference does not belong to `from`.
std::optional<Bytes> applied(const Bytes& difference, const Bytes& from);

}  // namespace tetskin::bullet_detail
