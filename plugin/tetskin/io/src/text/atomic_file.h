// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>
#include <string_view>

namespace tetskin::io {

/// Writes a whole file, under the name `path.part` until it is complete, so that a file called `path` is always
/// complete: an interrupted run leaves the earlier one, or none, and perhaps a `.part`. It writes through symbolic
/// links, and directly to anything that is no regular file (/dev/stdout). It does not wait for the disk, so that a
/// power failure may lose the file. Errors: FileNotWritable; the `.part` is removed.
Status writeFile(const std::string& path, std::string_view bytes);

/// Whether `writeFile` could begin. Leaves no file. Errors: FileNotWritable.
Status checkWritable(const std::string& path);

}  // namespace tetskin::io
