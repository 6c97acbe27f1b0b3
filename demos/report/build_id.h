// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <string>

namespace tetskin::report {

/// Tells builds of this program apart: a hash over the bytes of the running executable, and of the libraries of tetskin
/// and Bullet that are loaded with it. It is the same for every run of one build, where these files can be read.
const std::string& buildId();

}  // namespace tetskin::report
