// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Small cages and meshes with arbitrary coordinates and indices: accepted input gives finite weights that sum to 1 and
// survive save and load, and refused input gives a message. The remaining bytes are loaded as an embedding.
#include "fuzz.h"

#include <tetskin/core/embedding.h>

#include <algorithm>
#include <cmath>

#include "support/embed_into.h"

namespace {

using namespace tetskin;
using test::FuzzedBytes;

constexpr int kMaxFuzzNodes = 12, kMaxFuzzTets = 12, kMaxFuzzVertices = 24;

/// Points at a scale that the bytes choose: 1, tiny or huge.
std::vector<Eigen::Vector3d> points(FuzzedBytes& bytes, int most) {
  const double scales[] = {1.0, 1e-12, 1e12, 1e150};
  const double scale = scales[bytes.number(3)];
  std::vector<Eigen::Vector3d> made(static_cast<std::size_t>(bytes.number(most)));
  for (Eigen::Vector3d& p : made) {
    for (int k = 0; k < 3; ++k) p[k] = scale * bytes.coordinate();
  }
  return made;
}

TetMesh takeCage(FuzzedBytes& bytes) {
  TetMesh cage;
  cage.nodes = points(bytes, kMaxFuzzNodes);
  cage.tets.resize(static_cast<std::size_t>(bytes.number(kMaxFuzzTets)));
  for (Tet& tet : cage.tets) {
    for (int& node : tet) node = bytes.number(kMaxFuzzNodes + 1) - 1;
  }
  return cage;
}

TriangleMesh takeMesh(FuzzedBytes& bytes) {
  TriangleMesh mesh;
  mesh.positions = points(bytes, kMaxFuzzVertices);
  mesh.triangles.resize(static_cast<std::size_t>(bytes.number(kMaxFuzzTets)));
  for (auto& triangle : mesh.triangles) {
    for (int& v : triangle) v = bytes.number(kMaxFuzzVertices);
  }
  return mesh;
}

void expectSound(const Embedding& embedding, const EmbedReport& report) {
  TETSKIN_FUZZ_EXPECT(report.inside + report.outside == report.vertexCount && report.unbound == 0);
  TETSKIN_FUZZ_EXPECT(embedding.vertexCount() == report.vertexCount);
  TETSKIN_FUZZ_EXPECT(std::isfinite(report.restErrorMax) && std::isfinite(report.maxDistance));
  TETSKIN_FUZZ_EXPECT(std::isfinite(report.maxWeight) && report.reassignedByWeight <= report.outside);
  for (const VertexBinding& binding : embedding.bindings()) {
    float sum = 0.0f, largest = 1.0f;
    for (const float w : binding.weights) {
      sum += w;
      largest = std::max(largest, std::abs(w));
    }
    TETSKIN_FUZZ_EXPECT(std::isfinite(largest) && std::abs(sum - 1.0f) <= 4e-7f * largest);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedBytes bytes(data, size);
  EmbedOptions options;
  if (bytes.number(1) == 1) options.outside = OutsideRule::Barycentric;
  const TetMesh cage = takeCage(bytes);
  const TriangleMesh mesh = takeMesh(bytes);
  Embedding embedding;
  const Fit report = embedInto(cage, mesh, options, embedding);
  (void)Embedding::load(bytes.data(), bytes.size(), cage);
  if (!report.ok()) {
    TETSKIN_FUZZ_EXPECT(!report.status.message.empty() && embedding.empty());
    return 0;
  }
  expectSound(embedding, report);
  std::vector<unsigned char> saved = embedding.save(cage);
  TETSKIN_FUZZ_EXPECT(Embedding::load(saved.data(), saved.size(), cage).ok());
  saved[bytes.take<std::uint16_t>() % saved.size()] ^= bytes.take<std::uint8_t>();
  (void)Embedding::load(saved.data(), saved.size(), cage);
  return 0;
}
