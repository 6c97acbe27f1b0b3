// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "models.h"

#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/state/state_stream.h>

namespace tetskin::facade {
namespace {

/// What the bytes begin with; the hash covers all that follows it.
struct Head {
  std::uint64_t hash = 0;
  char tag[8];
};
constexpr std::size_t kHashed = sizeof(Head::hash);
constexpr char kMesh[] = "tsk-me02", kCage[] = "tsk-ca04";

/// An array of numbers, or of vectors of them.
template <class T>
void array(StateStream& stream, std::vector<T>& values) {
  const std::size_t count = stream.length(values.size(), sizeof(T));
  if (stream.restoring()) values.resize(count);
  stream.bytes(static_cast<void*>(values.data()), count * sizeof(T));
}

void serialize(StateStream& stream, TriangleMesh& mesh) {
  array(stream, mesh.positions);
  array(stream, mesh.triangles);
  array(stream, mesh.normals);
  array(stream, mesh.tangents);
  array(stream, mesh.texcoords);
  stream.each(mesh.groups, [&](TriangleGroup& group) {
    stream.array(group.name);
    stream.array(group.material);
    stream(group.firstTriangle, group.triangleCount);
  });
}

void serialize(StateStream& stream, ReportedCage& cage) {
  array(stream, cage.mesh.nodes);
  array(stream, cage.mesh.tets);
  array(stream, cage.vertexTets);
  array(stream, cage.volumeFraction);
  array(stream, cage.stiffnessFactor);
  array(stream, cage.paintedStiffness);
  array(stream, cage.paintedDensity);
  array(stream, cage.paintedDamping);
  array(stream, cage.masses);
  array(stream, cage.component);
  array(stream, cage.sourceTet);
  array(stream, cage.quadraticTet);
  array(stream, cage.fineVolumeFraction);
  bool hasHash = cage.meshHash.has_value();
  std::uint64_t hash = cage.meshHash.value_or(0);
  stream(hasHash, hash);
  if (stream.restoring() && hasHash) cage.meshHash = hash;
  stream.array(cage.report);
}

template <class Model>
void write(const Model& model, const char* tag, const Room& room) {
  const auto everything = [&](StateStream stream) {
    Head head;
    std::memcpy(head.tag, tag, sizeof head.tag);
    stream(head.hash);
    stream.plain(head.tag, sizeof head.tag);
    serialize(stream, const_cast<Model&>(model));  // NOLINT: what is saved is not changed
    return stream.count();
  };
  const std::size_t count = everything(StateStream());
  unsigned char* const bytes = room(count);
  everything(StateStream(bytes, count));
  const std::uint64_t hash = hashInLanes(bytes + kHashed, count - kHashed);
  std::memcpy(bytes, &hash, sizeof hash);
}

template <class Model>
void read(const unsigned char* bytes, std::size_t count, Model& model, const char* tag) {
  StateStream stream(bytes, count);
  Head head;
  stream(head.hash);
  stream.plain(head.tag, sizeof head.tag);
  const bool good = !stream.failed() && std::memcmp(head.tag, tag, sizeof head.tag) == 0 &&
                    head.hash == hashInLanes(bytes + kHashed, count - kHashed);
  if (good) serialize(stream, model);
  if (!good || stream.failed() || stream.count() != count)
    fail(StatusCode::Malformed, "these are not the bytes that this version of tetskin makes of such an object");
}

void checkGroups(const TriangleMesh& mesh) {
  std::size_t next = 0;
  for (const TriangleGroup& group : mesh.groups) {
    if (group.firstTriangle != next || group.triangleCount > mesh.triangleCount() - next)
      fail(StatusCode::Malformed, "a group of triangles is out of range");
    next += group.triangleCount;
  }
  if (!mesh.groups.empty() && next != mesh.triangleCount())
    fail(StatusCode::Malformed, "groups do not cover all triangles");
}

}  // namespace

void writeBytes(const MeshModel& model, const Room& room) {
  write(*model.mesh, kMesh, room);
}
void writeBytes(const CageModel& model, const Room& room) {
  write(*model.cage, kCage, room);
}

MeshModel meshOfBytes(const unsigned char* bytes, std::size_t count) {
  auto mesh = std::make_shared<TriangleMesh>();
  read(bytes, count, *mesh, kMesh);
  checkMesh(*mesh);
  checkGroups(*mesh);
  return {std::move(mesh)};
}
CageModel cageOfBytes(const unsigned char* bytes, std::size_t count) {
  auto cage = std::make_shared<ReportedCage>(Cage(), std::string());
  read(bytes, count, *cage, kCage);
  check(validate(*cage));
  return {std::move(cage)};
}

}  // namespace tetskin::facade
