// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Christophe Geuzaine, Jean-François Remacle, "Gmsh Reference Manual", chapter "Gmsh file formats"
#include <tetskin/io/src/tets/gmsh_file.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tetskin::io {

namespace {

constexpr int kGmshTet = 4;

bool isHighOrderTet(int type) {
  // of order 2; of order 3 to 5 and their kin without inner nodes; of order 6 to 10
  return type == 11 || (type >= 29 && type <= 33) || (type >= 71 && type <= 75);
}

class GmshReader {
 public:
  GmshReader(const std::string& path, std::string_view text, TetFileReport& report)
      : path_(path), in_(text), report_(report) {}
  Result<TetMesh> read();

 private:
  /// A tet by the tags of its nodes, which may follow later in the file.
  struct TaggedTet {
    std::int64_t tag = 0;
    std::array<std::int64_t, 4> nodes{};
    std::size_t line = 0;
  };

  Status readSection(std::string_view name);
  Status readFormat();
  template <class Block>
  Status readBlocks(std::uint64_t numbersEach, Block&& block);
  Status readNodes2();
  Status readNodes4();
  Status readElements2();
  Status readElements4();
  Status readElement(int type, int tags);
  Status readCount(std::uint64_t numbersEach, std::uint64_t& count);
  Status readPosition();
  Status endSection(std::string_view name, bool skip);

  Status sortTags();
  Status collectTets();
  Status cutShort() const {
    return error(StatusCode::Malformed,
                 "has something other than a number, or ends, within the data; is it complete? "
                 "Save it again");
  }
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, in_.line(), what); }

  const std::string& path_;
  TextScanner in_;
  TetFileReport& report_;
  int version_ = 0;                                 ///< 2 or 4; 0 before $MeshFormat
  std::vector<std::pair<std::int64_t, int>> tags_;  ///< tag and index of every node
  std::vector<TaggedTet> tets_;
  TetMesh mesh_;
};

Result<TetMesh> GmshReader::read() {
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word()) {
    if (word[0] != '$' || word.size() == 1) {
      return error(StatusCode::Malformed, "has " + excerpt(word) + " where a section is expected; is it a Gmsh file?");
    }
    Status status = readSection(word.substr(1));
    if (!status.ok()) return status;
  }
  if (version_ == 0) return fileError(StatusCode::Malformed, path_, 1, "has no $MeshFormat; is it a Gmsh file?");
  Status status = sortTags();
  if (status.ok()) status = collectTets();
  if (!status.ok()) return status;
  return std::move(mesh_);
}

Status GmshReader::readSection(std::string_view name) {
  Status status;
  const bool mesh = name == "Nodes" || name == "Elements";
  if (mesh && version_ == 0) {
    return error(StatusCode::Malformed, "has no $MeshFormat before its data; save it as version 2.2 or 4.1");
  }
  if (name == "MeshFormat") status = readFormat();
  if (name == "Nodes") status = version_ == 2 ? readNodes2() : readNodes4();
  if (name == "Elements") status = version_ == 2 ? readElements2() : readElements4();
  return status.ok() ? endSection(name, !mesh) : status;
}

/// Skips the end of a section, and everything before it if the section is of no interest.
Status GmshReader::endSection(std::string_view name, bool skip) {
  const std::string wanted = "$End" + std::string(name);
  std::string_view word = in_.word();
  while (skip && !word.empty() && word != wanted) word = in_.word();
  if (word == wanted) return {};
  return error(StatusCode::Malformed, "has " + (word.empty() ? "its end" : excerpt(word)) + " in place of " + wanted +
                                          "; is the file complete? Save it again");
}

Status GmshReader::readFormat() {
  const std::string_view version = in_.word();
  int binary = 0;
  if (!in_.integer(binary)) return cutShort();
  if (binary != 0) {
    return error(StatusCode::UnsupportedFormat,
                 "is a binary file, which is not supported; save it as ASCII, version 2.2 or "
                 "4.1 (gmsh -save -format msh41 or msh22, without -bin)");
  }
  version_ = version == "4.1" ? 4 : version.substr(0, 2) == "2." || version == "2" ? 2 : 0;
  if (version_ != 0) return {};
  return error(StatusCode::UnsupportedFormat,
               "has format version " + excerpt(version) + ", which is not supported; save it as version 2.2 or 4.1");
}

/// Reads a count of items, each of which takes this many numbers in the file.
Status GmshReader::readCount(std::uint64_t numbersEach, std::uint64_t& count) {
  if (!in_.integer(count)) return cutShort();
  if (count <= static_cast<std::uint64_t>(std::numeric_limits<int>::max()) && in_.hasRoomFor(count * numbersEach)) {
    return {};
  }
  return error(StatusCode::Malformed, "states a count of " + std::to_string(count) +
                                          ", for which the file is too short; is it complete? Save it again");
}

Status GmshReader::readPosition() {
  assert(mesh_.nodeCount() < tags_.size());
  Eigen::Vector3d node;
  if (!in_.number(node[0]) || !in_.number(node[1]) || !in_.number(node[2])) return cutShort();
  if (const std::string fault = coordinateFault(node); !fault.empty()) {
    return error(StatusCode::NonFinite, "node " + std::to_string(tags_[mesh_.nodeCount()].first) + fault);
  }
  mesh_.nodes.push_back(node);
  return {};
}

Status GmshReader::readNodes2() {
  std::uint64_t count = 0;
  Status status = readCount(4, count);
  for (std::uint64_t n = 0; status.ok() && n < count; ++n) {
    std::int64_t tag = 0;
    if (!in_.integer(tag)) return cutShort();
    tags_.emplace_back(tag, static_cast<int>(tags_.size()));
    status = readPosition();
  }
  return status;
}

/// Reads blocks of "dimension entity kind count": block(dimension, kind, count) reads the contents of each.
template <class Block>
Status GmshReader::readBlocks(std::uint64_t numbersEach, Block&& block) {
  std::uint64_t blocks = 0, total = 0;
  Status status = readCount(4, blocks);
  if (status.ok()) status = readCount(numbersEach, total);
  in_.restOfLine();  // the smallest and the largest tag
  for (std::uint64_t b = 0; status.ok() && b < blocks; ++b) {
    int dimension = 0, kind = 0;
    std::int64_t entity = 0;
    std::uint64_t count = 0;
    if (!in_.integer(dimension) || !in_.integer(entity) || !in_.integer(kind)) return cutShort();
    status = readCount(numbersEach, count);
    if (status.ok()) status = block(dimension, kind, count);
  }
  return status;
}

/// Reads blocks of nodes of one kind, parametric or not: their tags, then their coordinates.
Status GmshReader::readNodes4() {
  return readBlocks(4, [this](int dimension, int parametric, std::uint64_t count) -> Status {
    for (std::uint64_t n = 0; n < count; ++n) {
      std::int64_t tag = 0;
      if (!in_.integer(tag)) return cutShort();
      tags_.emplace_back(tag, static_cast<int>(tags_.size()));
    }
    Status status;
    for (std::uint64_t n = 0; status.ok() && n < count; ++n) {
      status = readPosition();
      for (int i = 0; parametric != 0 && i < std::min(dimension, 3); ++i) in_.word();
    }
    return status;
  });
}

/// Reads lines of "tag type tagCount tags... nodes...".
Status GmshReader::readElements2() {
  std::uint64_t count = 0;
  Status status = readCount(4, count);
  for (std::uint64_t e = 0; status.ok() && e < count; ++e) {
    tets_.emplace_back();
    int type = 0, tagCount = 0;
    if (!in_.integer(tets_.back().tag) || !in_.integer(type) || !in_.integer(tagCount)) return cutShort();
    status = readElement(type, tagCount);
  }
  return status;
}

/// Reads blocks of elements of one type: lines of "tag nodes...".
Status GmshReader::readElements4() {
  return readBlocks(2, [this](int, int type, std::uint64_t count) -> Status {
    Status status;
    for (std::uint64_t e = 0; status.ok() && e < count; ++e) {
      tets_.emplace_back();
      if (!in_.integer(tets_.back().tag)) return cutShort();
      status = readElement(type, 0);
    }
    return status;
  });
}

/// Reads the rest of an element, whose tag is already in the last entry of `tets_`; the entry is removed if the element
/// is no tet.
Status GmshReader::readElement(int type, int tags) {
  assert(!tets_.empty());
  if (type != kGmshTet) {
    tets_.pop_back();
    ++report_.skippedCells;
    report_.skippedHighOrder += isHighOrderTet(type);
    in_.restOfLine();
    return {};
  }
  std::int64_t ignored = 0;
  for (int i = 0; i < tags; ++i) {
    if (!in_.integer(ignored)) return cutShort();
  }
  tets_.back().line = in_.line();
  for (std::int64_t& node : tets_.back().nodes) {
    if (!in_.integer(node)) return cutShort();
  }
  return {};
}

Status GmshReader::sortTags() {
  std::sort(tags_.begin(), tags_.end());
  const auto twice =
      std::adjacent_find(tags_.begin(), tags_.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice == tags_.end()) return {};
  return fileError(StatusCode::Malformed, path_, 0,
                   "defines node " + std::to_string(twice->first) + " twice; save the mesh again");
}

Status GmshReader::collectTets() {
  assert(tags_.size() == mesh_.nodeCount() && std::is_sorted(tags_.begin(), tags_.end()));
  mesh_.tets.reserve(tets_.size());
  for (const TaggedTet& tagged : tets_) {
    Tet tet;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t node = tagged.nodes[i];
      const auto found = std::lower_bound(tags_.begin(), tags_.end(), std::pair<std::int64_t, int>(node, 0));
      if (found == tags_.end() || found->first != node) {
        return fileError(StatusCode::IndexOutOfRange, path_, tagged.line,
                         "tet " + std::to_string(tagged.tag) + " refers to node " + std::to_string(node) +
                             ", which does not exist; correct the tet");
      }
      tet[i] = found->second;
    }
    mesh_.tets.push_back(tet);
  }
  return {};
}

}  // namespace

Result<TetMesh> readGmshFile(const std::string& path, TetFileReport& report) {
  const Result<std::string> text = readText(path);
  if (!text.ok()) return text.status();
  return GmshReader(path, text.value(), report).read();
}

}  // namespace tetskin::io
