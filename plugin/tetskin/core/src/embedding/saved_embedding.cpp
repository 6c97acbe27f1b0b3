// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An embedding as bytes, little-endian on every machine:
//
//   bytes                  what
//   8                      "tetskemb"
//   8                      version
//   8                      hash of the cage, see hashOf
//   6 x 8                  nodeCount, tetCount, vertexCount, insideCount, number of runs, insideRunCount
//   8 per run              tet, first slot
//   4 per vertex           by slot: index of the vertex
//   12 per vertex          by slot: weights of nodes 0, 1, 2, one plane after the other
//   12 per vertex outside  by slot: closest weights, one plane after the other
//   8                      hash of all that precedes
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace tetskin {
namespace {

/// See above.
constexpr SavedFormat kFormat{"tetskemb", 1, 9 * 8, "an embedding", "the saved embedding", "embed again"};

struct Header {
  std::uint64_t cageHash = 0;
  std::uint64_t nodeCount = 0, tetCount = 0, vertexCount = 0, insideCount = 0, runCount = 0, insideRunCount = 0;

  /// The size of all data. The counts must have passed `plausible`: then nothing overflows.
  std::uint64_t bytes() const {
    return kFormat.headerBytes + 8 * runCount + 16 * vertexCount + 12 * (vertexCount - insideCount) + kHashBytes;
  }
  bool plausible() const {
    return vertexCount > 0 && vertexCount < 0xFFFFFFFFu && insideCount <= vertexCount && runCount <= vertexCount &&
           insideRunCount <= runCount;
  }
};

/// Reads everything up to the counts, and checks them against the number of bytes.
Status readHeader(const unsigned char* bytes, std::size_t count, Header& header) {
  if (Status status = kFormat.check(bytes, count); !status.ok()) return status;
  ByteReader reader(bytes + 16);
  header.cageHash = reader.u64();
  for (std::uint64_t* value : {&header.nodeCount, &header.tetCount, &header.vertexCount, &header.insideCount,
                               &header.runCount, &header.insideRunCount}) {
    *value = reader.u64();
  }
  if (!header.plausible()) return kFormat.damaged("has inconsistent counts");
  if (header.bytes() != count) {
    return kFormat.damaged("should have " + std::to_string(header.bytes()) + " bytes, but has " +
                           std::to_string(count));
  }
  if (!hashIsRight(bytes, count)) return kFormat.damaged("is damaged");
  return {};
}

Status checkCage(const Header& header, const TetMesh& cage) {
  if (header.nodeCount != cage.nodeCount() || header.tetCount != cage.tetCount()) {
    return {StatusCode::CageMismatch, "the embedding was saved with a cage of " + std::to_string(header.nodeCount) +
                                          " nodes and " + std::to_string(header.tetCount) + " tets, but this one has " +
                                          std::to_string(cage.nodeCount()) + " and " + std::to_string(cage.tetCount()) +
                                          "; embed again"};
  }
  if (header.cageHash != hashOf(cage)) {
    return {StatusCode::CageMismatch,
            "the embedding was saved with a cage whose rest nodes or tets differ from those of this one; embed again"};
  }
  return validate(cage);
}

bool runsAreSound(const EmbeddingData& d) {
  assert(!d.runs.empty() && d.insideRunCount < d.runs.size());
  if (d.runs.front().firstSlot != 0 || d.runs[d.insideRunCount].firstSlot != d.insideCount) return false;
  for (std::size_t r = 0; r + 1 < d.runs.size(); ++r) {
    if (d.runs[r].firstSlot >= d.runs[r + 1].firstSlot) return false;
    if (r + 1 != d.insideRunCount && d.runs[r].tet >= d.runs[r + 1].tet) return false;
  }
  return true;
}

/// Makes vertexSlots from slotVertices. Returns true if these are a permutation, and ascending in every run.
bool orderVertices(EmbeddingData& d) {
  assert(d.runs.back().firstSlot == d.slotVertices.size());
  // A vertex without a slot so far.
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  d.vertexSlots.assign(d.slotVertices.size(), kNone);
  for (std::size_t r = 0; r + 1 < d.runs.size(); ++r) {
    for (std::uint32_t slot = d.runs[r].firstSlot; slot < d.runs[r + 1].firstSlot; ++slot) {
      const std::uint32_t vertex = d.slotVertices[slot];
      if (vertex >= d.vertexSlots.size() || d.vertexSlots[vertex] != kNone) return false;
      if (slot > d.runs[r].firstSlot && vertex <= d.slotVertices[slot - 1]) return false;
      d.vertexSlots[vertex] = slot;
    }
  }
  return true;
}

}  // namespace

std::vector<unsigned char> Embedding::save(const TetMesh& cage) const {
  const EmbeddingData& d = *data_;
  assert(!empty() && cage.nodeCount() == d.nodeCount && cage.tetCount() == d.tetCount);
  const std::size_t outside = vertexCount() - d.insideCount;
  const Header header{hashOf(cage),  d.nodeCount,       d.tetCount,      vertexCount(),
                      d.insideCount, d.runs.size() - 1, d.insideRunCount};
  ByteWriter writer(header.bytes());
  writer.tag(kFormat.letters);
  for (const std::uint64_t value : {kFormat.version, header.cageHash, header.nodeCount, header.tetCount,
                                    header.vertexCount, header.insideCount, header.runCount, header.insideRunCount}) {
    writer.u64(value);
  }
  for (std::size_t r = 0; r < header.runCount; ++r) {
    writer.u32(d.runs[r].tet);
    writer.u32(d.runs[r].firstSlot);
  }
  for (const std::uint32_t vertex : d.slotVertices) writer.u32(vertex);
  for (int k = 0; k < 3; ++k) writer.plane(d.weights[static_cast<std::size_t>(k)].data(), vertexCount());
  for (int k = 0; k < 3; ++k) writer.plane(d.closestWeights[static_cast<std::size_t>(k)].data(), outside);
  return writer.take();
}

Result<Embedding> Embedding::load(const unsigned char* bytes, std::size_t count, const TetMesh& cage) {
  Header header;
  if (Status status = readHeader(bytes, count, header); !status.ok()) return status;
  if (Status status = checkCage(header, cage); !status.ok()) return status;
  const auto e = std::make_shared<EmbeddingData>();
  e->nodeCount = cage.nodeCount();
  e->tetCount = cage.tetCount();
  e->insideCount = header.insideCount;
  e->insideRunCount = header.insideRunCount;
  ByteReader reader(bytes + kFormat.headerBytes);
  e->runs.resize(header.runCount + 1);
  for (std::size_t r = 0; r < header.runCount; ++r) {
    EmbeddingData::Run& run = e->runs[r];
    run.tet = reader.u32();
    run.firstSlot = reader.u32();
    if (run.tet >= cage.tetCount()) return kFormat.damaged("refers to a tet that does not exist");
    std::copy_n(cage.tets[run.tet].begin(), 4, run.nodes);
  }
  e->runs.back() = {{}, static_cast<std::uint32_t>(header.vertexCount), static_cast<std::uint32_t>(e->tetCount)};
  e->slotVertices.resize(header.vertexCount);
  for (std::uint32_t& vertex : e->slotVertices) vertex = reader.u32();
  bool finite = true;
  for (std::vector<float>& plane : e->weights) {
    plane.resize(header.vertexCount + EmbeddingData::kPadding);
    finite &= reader.plane(plane.data(), header.vertexCount);
  }
  const std::size_t outside = header.vertexCount - header.insideCount;
  for (std::vector<float>& plane : e->closestWeights) {
    plane.resize(outside + EmbeddingData::kPadding);
    finite &= reader.plane(plane.data(), outside);
  }
  if (!finite) return kFormat.damaged("has weights that are not finite");
  if (!runsAreSound(*e)) return kFormat.damaged("has runs out of order");
  if (!orderVertices(*e)) return kFormat.damaged("has vertices repeated, or out of order");
  return Embedding(e);
}

}  // namespace tetskin
