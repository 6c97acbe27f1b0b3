// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: what the build-up of a world is written to and read from, so that a recorded run needs no
// program that builds its world. While `saving`, objects are described as they are; while `restoring`, they are built.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/embedding.h>
#include <tetskin/export.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

class RowSource;

/// What several objects may share.
enum class SharedKind { Nothing, CollisionShape, ContactShape };

/// The large values of a file. A value has a number, in the order in which they were first described.
struct CopyStore {
  std::vector<std::uint64_t> hashes;                ///< of those that were described
  std::vector<std::vector<unsigned char>> unsaved;  ///< the last ones of these: to be written to the file
  std::vector<std::vector<unsigned char>> read;     ///< from the file

  TETSKIN_BULLET_API std::uint32_t indexOf(std::vector<unsigned char> bytes);
};

class BuildStream : public WorldStream {
 public:
  /// arguments  those of StateStream
  template <class... Arguments>
  explicit BuildStream(btDeformableMultiBodyDynamicsWorld& world, CopyStore& store, Arguments... arguments)
      : WorldStream(world, arguments...), store_(store) {}

  /// Something that several objects share, by its address: described, and built, once.
  /// build  describes `*shared`, or returns what it has built; null: it could not
  template <class Shared, class Build>
  auto shared(SharedKind kind, const Shared* shared, Build&& build) -> decltype(build()) {
    std::uint32_t index = 0;
    if (saving()) {
      index = static_cast<std::uint32_t>(std::find(described_.begin(), described_.end(), shared) - described_.begin());
    }
    const std::size_t known = saving() ? described_.size() : built_.size();
    (*this)(index);
    if (failed() || index > known) {
      fail();
      return nullptr;
    }
    if (saving()) {
      if (index == known) described_.push_back(shared), (void)build();
      return nullptr;
    }
    if (index == known) {
      built_.push_back({});
      auto made = build();
      if (!made) fail();
      built_[index] = {kind, std::move(made)};
    }
    if (built_[index].kind != kind) fail();  // also for one that holds itself
    using Element = typename decltype(build())::element_type;
    return failed() ? nullptr : std::static_pointer_cast<Element>(std::const_pointer_cast<void>(built_[index].object));
  }

  /// A large value of which several objects have equal copies, or which stays the same when a world is described again:
  /// its bytes are kept once, in the store.
  /// visit  (stream) of the value
  template <class Visit>
  void copied(Visit&& visit) {
    std::uint32_t index = 0;
    if (saving()) {
      BuildStream counted(world(), store_);
      visit(counted);
      std::vector<unsigned char> bytes(counted.count());
      BuildStream written(world(), store_, bytes.data(), bytes.size());
      visit(written);
      index = store_.indexOf(std::move(bytes));
    }
    (*this)(index);
    if (saving()) return;
    if (failed() || index >= store_.read.size()) return fail();
    const std::vector<unsigned char>& bytes = store_.read[index];
    BuildStream read(world(), store_, bytes.data(), bytes.size());
    visit(read);
    if (read.failed() || read.count() != bytes.size()) fail();
  }

  /// `refuse`, for what must hold of what was read.
  void require(bool holds, const char* otherwise) {
    if (!holds) refuse(otherwise);
  }

 private:
  struct Built {
    SharedKind kind = SharedKind::Nothing;
    std::shared_ptr<const void> object;
  };
  CopyStore& store_;
  std::vector<const void*> described_;
  std::vector<Built> built_;
};

/// True for indices into a list of this length.
template <class Indices>
bool areBelow(const Indices& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [count](int n) { return n >= 0 && static_cast<std::size_t>(n) < count; });
}

inline void visitEmbedded(BuildStream& stream, EmbeddedPoint<btScalar>& point) {
  stream.plain(point.nodes.data(), point.nodes.size());
  stream.plain(point.weights.data(), point.weights.size());
  stream.plain(point.clampedWeights.data(), point.clampedWeights.size());
  stream(point.tet);
  stream(point.inside);
}

/// An entry of the solver's list of forces, built by a library that tetskin::bullet does not know.
struct BuiltSource {
  std::shared_ptr<void> owner;
  RowSource* entry = nullptr;  ///< in the list
};

/// What a library builds of a recorded world.
struct SourceBuilder {
  const char* name;  ///< `RowSource::builderName`
  /// Returns no entry, and has called `refuse` or `fail`, if it cannot be built.
  BuiltSource (*build)(BuildStream& stream);
};

}  // namespace tetskin::bullet_detail
