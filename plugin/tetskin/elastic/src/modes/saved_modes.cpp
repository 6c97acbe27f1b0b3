// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Vibration modes as bytes, little-endian on every machine:
//
//   bytes              what
//   8                  "tetskmod"
//   8                  version
//   8                  hash of the tets, see hashOfTets
//   5 x 8              nodeCount, tetCount, modeCount, number of pinned nodes, Poisson's ratio
//   8 per node         mass
//   8 per pinned node  index of the node
//   8 per mode         eigenvalue
//   24 per mode, node  displacement
//   8                  hash of all that precedes
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/elastic/vibration_modes.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

/// See above.
constexpr SavedFormat kFormat{"tetskmod", 1, 8 * 8, "modes", "the saved set of modes", "compute it again"};

/// The hash of the mesh, modified if some tets are quadratic: a body with the same nodes then vibrates differently.
std::uint64_t hashOfTets(const Cage& cage) {
  const std::vector<int>& number = cage.quadraticTet;
  const std::uint64_t ofMesh = hashOf(cage.mesh);
  if (std::all_of(number.begin(), number.end(), [](int k) { return k < 0; })) return ofMesh;
  Hash hash;
  hash.add(ofMesh);
  for (const int k : number) hash.add(std::uint64_t{static_cast<std::uint32_t>(k)});
  return hash.value();
}

struct Header {
  std::uint64_t tetsHash = 0, nodeCount = 0, tetCount = 0, modeCount = 0, pinnedCount = 0;

  /// Also false if the sum would overflow.
  bool isOf(std::size_t bytes) const {
    const std::uint64_t maximum = bytes / 8;
    if (nodeCount > maximum || pinnedCount > nodeCount || modeCount > maximum) return false;
    if (nodeCount > 0 && modeCount > maximum / (3 * nodeCount)) return false;
    return kFormat.headerBytes + 8 * (nodeCount + pinnedCount + modeCount + 3 * modeCount * nodeCount) + kHashBytes ==
           bytes;
  }
};

Status readHeader(const unsigned char* bytes, std::size_t count, Header& header) {
  if (Status status = kFormat.check(bytes, count); !status.ok()) return status;
  ByteReader reader(bytes + 16);
  for (std::uint64_t* value :
       {&header.tetsHash, &header.nodeCount, &header.tetCount, &header.modeCount, &header.pinnedCount}) {
    *value = reader.u64();
  }
  if (!header.isOf(count)) return kFormat.damaged("has another number of bytes than its header states");
  if (!hashIsRight(bytes, count)) return kFormat.damaged("is damaged");
  return {};
}

/// False for results that `computeVibrationModes` never returns.
bool makeSense(const VibrationModes& modes) {
  const auto isPositive = [](double value) { return value > 0.0; };
  const auto isNormal = [&](const std::vector<double>& shape) {
    double sum = 0.0;
    for (std::size_t k = 0; k < shape.size(); ++k) sum += modes.masses[k / 3] * shape[k] * shape[k];
    return std::abs(sum - 1.0) < 1e-6;
  };
  return !modes.eigenvalues.empty() && std::all_of(modes.shapes.begin(), modes.shapes.end(), isNormal) &&
         std::all_of(modes.masses.begin(), modes.masses.end(), isPositive) &&
         std::all_of(modes.eigenvalues.begin(), modes.eigenvalues.end(), isPositive) &&
         std::is_sorted(modes.eigenvalues.begin(), modes.eigenvalues.end()) && modes.poissonRatio >= 0.0 &&
         modes.poissonRatio < 0.5;
}

}  // namespace

std::vector<unsigned char> VibrationModes::save(const Cage& cage) const {
  const TetMesh& tets = cage.mesh;
  assert(tets.nodeCount() == nodeCount() && shapes.size() == modeCount());
  ByteWriter writer(kFormat.headerBytes + 8 * (masses.size() + pinned.size() + modeCount() * (1 + 3 * nodeCount())) +
                    kHashBytes);
  writer.tag(kFormat.letters);
  for (const std::uint64_t value :
       {kFormat.version, hashOfTets(cage), std::uint64_t{nodeCount()}, std::uint64_t{tets.tetCount()},
        std::uint64_t{modeCount()}, std::uint64_t{pinned.size()}}) {
    writer.u64(value);
  }
  writer.plane(&poissonRatio, 1);
  writer.plane(masses.data(), masses.size());
  for (const int node : pinned) writer.u64(static_cast<std::uint64_t>(node));
  writer.plane(eigenvalues.data(), eigenvalues.size());
  for (const std::vector<double>& shape : shapes) writer.plane(shape.data(), shape.size());
  return writer.take();
}

Result<VibrationModes> VibrationModes::load(const unsigned char* bytes, std::size_t count, const Cage& cage) {
  const TetMesh& tets = cage.mesh;
  Header header;
  if (Status status = readHeader(bytes, count, header); !status.ok()) return status;
  if (header.nodeCount != tets.nodeCount() || header.tetCount != tets.tetCount() ||
      header.tetsHash != hashOfTets(cage)) {
    return Status{StatusCode::CageMismatch,
                  "the modes were saved with other tets: " + std::to_string(header.nodeCount) + " nodes and " +
                      std::to_string(header.tetCount) + " tets, but these have " + std::to_string(tets.nodeCount()) +
                      " and " + std::to_string(tets.tetCount()) +
                      ", or other positions, or other quadratic tets; compute the modes again"};
  }
  VibrationModes modes;
  modes.nodes = tets.nodes;
  modes.masses.resize(header.nodeCount);
  modes.eigenvalues.resize(header.modeCount);
  modes.shapes.assign(header.modeCount, std::vector<double>(3 * header.nodeCount));
  ByteReader reader(bytes + kFormat.headerBytes - 8);
  bool finite = reader.plane(&modes.poissonRatio, 1);
  finite &= reader.plane(modes.masses.data(), modes.masses.size());
  for (std::uint64_t k = 0; k < header.pinnedCount; ++k) {
    const std::uint64_t node = reader.u64();
    if (node >= header.nodeCount) return kFormat.damaged("refers to a node that does not exist");
    modes.pinned.push_back(static_cast<int>(node));
  }
  finite &= reader.plane(modes.eigenvalues.data(), modes.eigenvalues.size());
  for (std::vector<double>& shape : modes.shapes) finite &= reader.plane(shape.data(), shape.size());
  if (!finite) return kFormat.damaged("has numbers that are not finite");
  if (!makeSense(modes)) return kFormat.damaged("has invalid masses, frequencies or material parameters");
  return modes;
}

}  // namespace tetskin
