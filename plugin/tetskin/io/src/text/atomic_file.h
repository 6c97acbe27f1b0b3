// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>
#include <string_view>

namespace tetskin::io {

/// Writes a whole file under the name `path.part` and renames it, so that a file called `path` is always complete: an
/// interrupted run leaves the earlier one, or none, and perhaps a `.part`. Writes through symbolic links, and straight
/// into what is no regular file (/dev/stdout). No wait for the disk, so a power cut is not covered.
/// Errors: FileNotWritable; the `.part` is removed.
Status writeFile(const std::string& path, std::string_view bytes);

}  // namespace tetskin::io
