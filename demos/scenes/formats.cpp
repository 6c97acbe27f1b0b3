// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/formats.h"

#include <tetskin/io/animation.h>

#include <algorithm>
#include <cstdio>

#include "scenes/input_error.h"

namespace tetskin::scenes {

Formats formatsOf(const OutputOptions& options) {
  if (options.formats.empty()) return {true, GlbWriter::whyNot().empty(), false};
  const auto has = [&](const char* name) {
    return std::count(options.formats.begin(), options.formats.end(), name) > 0;
  };
  return {has("obj"), has("glb"), has("pc2")};
}

std::string firstFileOf(const OutputOptions& options) {
  const Formats formats = formatsOf(options);
  return options.out + (formats.obj ? "/frame_0000.obj" : formats.glb ? "/animation.glb" : "/animation.pc2");
}

void requireFormats(const OutputOptions& options) {
  const std::string reason = GlbWriter::whyNot();
  if (reason.empty()) return;
  if (options.formats.empty() && !options.quiet) std::printf("no GLB is written: %s\n", reason.c_str());
  if (formatsOf(options).glb) throw InputError("--format glb: " + reason);
}

}  // namespace tetskin::scenes
