// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/tetskin.h>

#include <cstdio>

int main() {
  const tetskin::TetMesh cage{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  const std::vector<Eigen::Vector3d> vertices{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.9}};
  tetskin::EmbedReport report;
  const auto embedding = tetskin::embed(cage, tetskin::viewOf(vertices), {}, &report);
  std::printf("%s", report.describe().c_str());
  return embedding.ok() && report.inside == 1 && report.outside == 1 ? 0 : 1;
}
