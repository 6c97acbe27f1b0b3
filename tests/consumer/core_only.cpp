// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/skinning/linear_skinning.h>

#include <cstdio>

int main() {
  const tetskin::TetMesh cage{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  const std::vector<Eigen::Vector3d> vertices{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.9}};
  tetskin::Embedding embedding;
  const tetskin::EmbedReport report = tetskin::embed(cage, tetskin::viewOf(vertices), {}, embedding);
  std::printf("%s", report.describe().c_str());
  return report.inside == 1 && report.outside == 1 ? 0 : 1;
}
