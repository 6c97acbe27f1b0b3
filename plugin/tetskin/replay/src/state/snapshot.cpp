// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A snapshot is a header, and a payload of parts in the machine's own numbers. Everything is checked before the world
// is changed: the bytes by their hash, the world by the directory, which is the payload's first part.
#include <tetskin/core/src/base/hash.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/replay/src/state/saved_worlds.h>
#include <tetskin/replay/src/state/snapshot_bytes.h>
#include <tetskin/replay/src/state/world_directory.h>
#include <tetskin/replay/src/state/world_state.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/exported/solver_state.h>

#include <algorithm>
#include <cassert>
#include <string>

namespace tetskin {

using namespace bullet_detail;

namespace {

using World = btDeformableMultiBodyDynamicsWorld;

constexpr std::uint64_t kMagic = 0x544F485350414E54u;  // "TNAPSHOT"
constexpr std::uint32_t kByteLayout = 7;               ///< increases with every change of the format

using VisitPart = void (*)(WorldStream&, DeformableSolver&);
/// In the order of their dependences.
constexpr VisitPart kParts[] = {
    [](WorldStream& s, DeformableSolver&) { serializeObjects(s); },
    [](WorldStream& s, DeformableSolver&) { serializeSoftBodies(s); },
    [](WorldStream& s, DeformableSolver&) { serializeJoints(s); },
    [](WorldStream& s, DeformableSolver&) { serializeBroadphase(s); },
    [](WorldStream& s, DeformableSolver&) { serializePairs(s); },
    [](WorldStream& s, DeformableSolver& solver) { serializeSolver(s, solver); },
    [](WorldStream& s, DeformableSolver&) { serializeContactSearch(s); },
    [](WorldStream& s, DeformableSolver& solver) { serializeForces(s, solver); },
};
/// Number of these parts.
constexpr std::size_t kPartCount = sizeof kParts / sizeof kParts[0];

struct Header {
  std::uint64_t magic = kMagic;
  std::uint32_t layout = kByteLayout, library = TETSKIN_VERSION_NUMBER;
  std::uint32_t scalarBytes = sizeof(btScalar), byteOrder = 0x01020304u;
  std::uint64_t length = 0;                 ///< of the payload
  std::uint64_t hash = 0;                   ///< at kHashAt
  std::uint64_t ends[kPartCount + 1] = {};  ///< ends of the directory and of each part, from the payload's beginning

  void serialize(StateStream& stream) {
    stream(magic, layout, library, scalarBytes, byteOrder, length, hash);
    stream.plain(ends, kPartCount + 1);
  }
  static std::size_t bytes() {
    StateStream stream;
    Header().serialize(stream);
    return stream.count();
  }
};

Status malformed(const std::string& what) {
  return {StatusCode::Malformed, "the snapshot is damaged: " + what};
}
Status unsupported(const std::string& what) {
  return {StatusCode::UnsupportedFormat, "this snapshot cannot be read here: " + what};
}

/// Reads the header, and checks that the bytes are unchanged and were written by a compatible library.
Status readHeader(const unsigned char* bytes, std::size_t size, Header& header) {
  StateStream stream(bytes, size);
  header.serialize(stream);
  if (stream.failed()) return malformed("it has " + std::to_string(size) + " bytes, less than its header");
  const Header own;
  if (header.magic != own.magic) return malformed("it does not begin like a snapshot");
  if (header.byteOrder != own.byteOrder) return unsupported("it is from a machine with another byte order");
  if (header.scalarBytes != own.scalarBytes) {
    return unsupported("its numbers have " + std::to_string(header.scalarBytes) + " bytes, Bullet's here " +
                       std::to_string(own.scalarBytes));
  }
  if (header.layout != own.layout || header.library != own.library) {
    return unsupported("it was written by another version of this library");
  }
  if (header.length != size - Header::bytes()) {
    return malformed("it has " + std::to_string(size) + " bytes, not the " +
                     std::to_string(header.length + Header::bytes()) + " that were written");
  }
  if (header.hash != hashInLanes(bytes + kHashedFrom, size - kHashedFrom))
    return malformed("bytes have changed since it was saved");
  return {};
}

Result<std::size_t> save(World& saved, void* buffer, std::size_t size, bool withRecords) {
  DeformableSolver* solver = deformableSolverOf(saved);
  if (!solver) return refusal("a snapshot", {kUseDeformableSolver});
  if (Status status = checkIsSaved(saved, *solver); !status.ok()) return status;
  const std::size_t begin = Header::bytes();
  auto* bytes = static_cast<unsigned char*>(buffer);
  const std::size_t room = size > begin ? size - begin : 0;
  WorldStream stream = bytes ? WorldStream(saved, bytes + (room > 0 ? begin : 0), room) : WorldStream(saved);
  if (!withRecords) stream.leaveOutRecords();
  Header header;
  WorldDirectory(saved).serialize(stream);
  checkForces(stream, *solver);
  header.ends[0] = stream.count();
  for (std::size_t k = 0; k < kPartCount; ++k) {
    kParts[k](stream, *solver);
    header.ends[k + 1] = stream.count();
  }
  if (!stream.refusal().empty()) return Status{StatusCode::NotSaved, "a snapshot cannot hold " + stream.refusal()};
  header.length = stream.count();
  const std::size_t needed = begin + stream.count();
  if (!bytes) return needed;
  if (size < needed) {
    return Status{StatusCode::SizeMismatch,
                  "the buffer has " + std::to_string(size) + " bytes, and the snapshot " + std::to_string(needed)};
  }
  StateStream front(bytes, begin);
  header.serialize(front);
  header.hash = hashInLanes(bytes + kHashedFrom, needed - kHashedFrom);
  std::memcpy(bytes + kHashAt, &header.hash, sizeof header.hash);
  return needed;
}

}  // namespace

Result<std::size_t> saveSnapshot(const World& world, void* buffer, std::size_t size) {
  return save(const_cast<World&>(world), buffer, size, true);  // NOLINT: Bullet has no const accessors
}

Status restoreSnapshot(World& world, const void* snapshot, std::size_t size) {
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("a snapshot", {kUseDeformableSolver});
  const auto* bytes = static_cast<const unsigned char*>(snapshot);
  Header header;
  Status status = readHeader(bytes, bytes ? size : 0, header);
  if (status.ok()) status = checkIsSaved(world, *solver);
  if (!status.ok()) return status;
  WorldStream stream(world, bytes + Header::bytes(), static_cast<std::size_t>(header.length));
  WorldDirectory directory;
  directory.serialize(stream);
  if (stream.failed()) return malformed("its list of objects does not end");
  WorldDirectory now(world);
  status = directory.find(now);
  if (!status.ok()) return status;
  directory.order(world);
  checkForces(stream, *solver);
  if (stream.failed() || stream.count() != header.ends[0]) {
    // Restores the lists' previous order.
    [[maybe_unused]] const Status found = now.find(WorldDirectory(world));
    assert(found.ok());
    now.order(world);
    return {StatusCode::SnapshotMismatch, "the snapshot is of another world: " + stream.refusal()};
  }

  removePairs(stream);
  for (std::size_t k = 0; k < kPartCount; ++k) {
    kParts[k](stream, *solver);
    if (stream.failed() || stream.count() != header.ends[k + 1]) {
      // Only bytes that were altered and hashed again get here, or settings that no snapshot compares.
      return malformed("part " + std::to_string(k) + " does not fit this world" +
                       (stream.refusal().empty() ? "" : ": " + stream.refusal()));
    }
  }
  return {};
}

namespace bullet_detail {

Status saveInto(World& world, std::vector<unsigned char>& snapshot) {
  Result<std::size_t> size = save(world, snapshot.data(), snapshot.size(), false);
  if (!size.ok() && size.status().code != StatusCode::SizeMismatch) return size.status();
  if (size.ok() && snapshot.size() == size.value()) return {};
  size = save(world, nullptr, 0, false);
  if (!size.ok()) return size.status();
  snapshot.resize(size.value());
  return save(world, snapshot.data(), snapshot.size(), false).status();
}

bool areOfOneWorld(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b) {
  const auto directoryEnd = [](const std::vector<unsigned char>& snapshot) {
    Header header;
    StateStream stream(snapshot.data(), snapshot.size());
    header.serialize(stream);
    assert(!stream.failed());
    return static_cast<std::ptrdiff_t>(Header::bytes() + header.ends[0]);
  };
  return std::equal(a.begin() + static_cast<std::ptrdiff_t>(Header::bytes()), a.begin() + directoryEnd(a),
                    b.begin() + static_cast<std::ptrdiff_t>(Header::bytes()), b.begin() + directoryEnd(b));
}

}  // namespace bullet_detail

}  // namespace tetskin
