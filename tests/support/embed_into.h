// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>

namespace tetskin {

/// The report of an attempt to embed, and its status.
struct Fit : EmbedReport {
  Status status;
  bool ok() const { return status.ok(); }
};

/// `embed` with report and status in one; leaves the embedding unchanged on an error.
template <class Points>
Fit embedInto(const TetMesh& cage, const Points& points, const EmbedOptions& options, Embedding& embedding) {
  Fit fit;
  Result<Embedding> made = embed(cage, points, options, &fit);
  fit.status = made.status();
  if (made.ok()) embedding = std::move(made).value();
  return fit;
}

/// The report alone.
template <class Points>
Fit embedInto(const TetMesh& cage, const Points& points, const EmbedOptions& options = {}) {
  Embedding embedding;
  return embedInto(cage, points, options, embedding);
}

/// The part of the options that concerns one skin of a binding.
inline const InstanceOptions& instanceOf(const SkinOptions& options) {
  return options;
}

}  // namespace tetskin
