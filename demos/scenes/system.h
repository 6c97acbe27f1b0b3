// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Everything that the demos need from the operating system beyond the standard library.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace tetskin::scenes {

/// True if the stream is written to a terminal.
bool isTerminal(std::FILE* stream);
/// True if files can be made in a folder that exists.
bool mayWriteInto(const std::filesystem::path& folder);
/// Bytes allocated at present; 0 where the C library does not report it.
std::size_t heapBytes();
/// Size of the last-level cache; 0 where the system does not report it.
std::size_t lastLevelCacheBytes();
/// Runs a command found in the path, and waits for it. Returns its exit status; below 0: it could not be run, or was
/// killed.
/// silent  without its output
int runCommand(const std::vector<std::string>& command, bool silent = false);

}  // namespace tetskin::scenes
