// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Christophe Geuzaine, Jean-François Remacle, "Gmsh Reference Manual", chapter "Gmsh file formats"
#include <tetskin/io/src/tets/gmsh_file.h>
#include <tetskin/io/src/text/binary_numbers.h>
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

/// Gmsh's numbers for elements of these types.
constexpr int kGmshTet = 4, kGmshQuadraticTet = 11;

bool isAboveSecondOrder(int type) {
  // of order 3 to 5 and their kin without inner nodes; of order 6 to 10
  return (type >= 29 && type <= 33) || (type >= 71 && type <= 75);
}

/// How many nodes the elements of a type have, by which binary files are read over; 0 for unusual ones.
std::size_t nodesOf(int type) {
  constexpr std::array<unsigned char, 32> kNodes = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                                    8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
  return type > 0 && static_cast<std::size_t>(type) < kNodes.size() ? kNodes[static_cast<std::size_t>(type)] : 0;
}

class GmshReader {
 public:
  GmshReader(const std::string& path, std::string_view text, TetFileReport& report)
      : path_(path), in_(text), report_(report) {}
  Result<FileCage> read();

 private:
  /// A tet by the tags of its nodes, which may follow later in the file.
  struct TaggedTet {
    std::int64_t tag = 0;
    std::array<std::int64_t, 10> nodes{};  ///< the corners only, except of those of second order
    int type = 0;                          ///< Gmsh's number
    std::size_t line = 0;

    std::size_t nodeCount() const { return type == kGmshQuadraticTet ? 10 : 4; }
  };

  Status readSection(std::string_view name);
  Status readFormat();
  template <class Block>
  Status readBlocks(std::uint64_t numbersEach, Block&& block);
  Status readNodes2();
  Status readNodes4();
  Status readElements2();
  Status readElementsOfKind(int type, std::uint64_t count, int tags);
  Status readElements4();
  Status readElement(int type, int tags);
  Status readSpareTags(int type);
  Status readTextCount(std::uint64_t numbersEach, std::uint64_t& count);
  Status readCount(std::uint64_t numbersEach, std::uint64_t& count);
  Status checkCount(std::uint64_t numbersEach, std::uint64_t count) const;
  Status readTag();
  Status readPosition();
  Status endSection(std::string_view name, bool skip);

  /// The next integer, which has this many bytes in a binary file.
  template <class Integer>
  bool integer(Integer& value, std::size_t bytes = 4);
  bool number(double& value);
  bool tag(std::int64_t& value) { return integer(value, version_ == 2 ? 4 : 8); }
  std::size_t line() const { return binary_ ? 0 : in_.line(); }

  Status sortTags();
  int find(std::int64_t tag) const;
  Status collectTets();
  Status cutShort() const {
    return error(StatusCode::Malformed,
                 "has something other than a number, or ends, within the data; is it complete? "
                 "Save it again");
  }
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, line(), what); }

  const std::string& path_;
  TextScanner in_;
  TetFileReport& report_;
  int version_ = 0;           ///< 2 or 4; 0 before $MeshFormat
  bool entityFirst_ = false;  ///< 4.0, where blocks differ a little
  bool binary_ = false;
  ByteOrder order_ = ByteOrder::Little;
  std::vector<std::pair<std::int64_t, int>> tags_;  ///< tag and index of every node
  std::vector<TaggedTet> tets_;
  std::vector<std::int64_t> spareTags_;  ///< nodes of tets above second order that are no corners
  FileCage file_;
};

template <class Integer>
bool GmshReader::integer(Integer& value, std::size_t bytes) {
  if (!binary_) return in_.integer(value);
  if (in_.remaining() < bytes) return false;
  value = static_cast<Integer>(decodeInteger(in_.bytes(bytes).data(), {bytes}, order_));
  return true;
}

bool GmshReader::number(double& value) {
  if (!binary_) return in_.number(value);
  // Of every binary file: Gmsh asks for this size in the header.
  constexpr NumberType kDouble = {8, true};
  if (in_.remaining() < kDouble.bytes) return false;
  value = decodeNumber(in_.bytes(kDouble.bytes).data(), kDouble, order_);
  return true;
}

Result<FileCage> GmshReader::read() {
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
  return std::move(file_);
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
  if (skip && binary_) {  // bytes of any kind, up to a line that ends so
    for (std::string_view rest; in_.remaining() > 0;) {
      rest = in_.restOfLine();
      if (rest.size() >= wanted.size() && rest.substr(rest.size() - wanted.size()) == wanted) return {};
    }
  }
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
  version_ = version == "4.1" || version == "4" || version == "4.0" ? 4
             : version.substr(0, 2) == "2." || version == "2"       ? 2
                                                                    : 0;
  entityFirst_ = version_ == 4 && version != "4.1";
  if (version_ == 0 || (entityFirst_ && binary != 0)) {
    return error(StatusCode::UnsupportedFormat, "has format version " + excerpt(version) +
                                                    (binary != 0 ? ", binary" : "") +
                                                    ", which is not supported; save it as version 2.2 or 4.1");
  }
  if (binary == 0) return {};
  in_.restOfLine();
  std::int64_t one = 0;  // tells the byte order
  binary_ = true;
  if (!integer(one)) return cutShort();
  if (one != 1) order_ = ByteOrder::Big;
  return {};
}

/// Reads a count of items, each of which takes this many numbers in the file.
Status GmshReader::readCount(std::uint64_t numbersEach, std::uint64_t& count) {
  return integer(count, 8) ? checkCount(numbersEach, count) : cutShort();
}

/// Reads a count that is text in a binary file, too, where it ends the line.
Status GmshReader::readTextCount(std::uint64_t numbersEach, std::uint64_t& count) {
  if (!in_.integer(count)) return cutShort();
  if (binary_) in_.restOfLine();
  return checkCount(numbersEach, count);
}

Status GmshReader::checkCount(std::uint64_t numbersEach, std::uint64_t count) const {
  if (count <= static_cast<std::uint64_t>(std::numeric_limits<int>::max()) && in_.hasRoomFor(count * numbersEach)) {
    return {};
  }
  return error(StatusCode::Malformed, "states a count of " + std::to_string(count) +
                                          ", for which the file is too short; is it complete? Save it again");
}

Status GmshReader::readTag() {
  std::int64_t value = 0;
  if (!tag(value)) return cutShort();
  tags_.emplace_back(value, static_cast<int>(tags_.size()));
  return {};
}

Status GmshReader::readPosition() {
  std::vector<Eigen::Vector3d>& nodes = file_.cage.mesh.nodes;
  assert(nodes.size() < tags_.size());
  Eigen::Vector3d node;
  if (!number(node[0]) || !number(node[1]) || !number(node[2])) return cutShort();
  if (const std::string fault = coordinateFault(node); !fault.empty()) {
    return error(StatusCode::NonFinite, "node " + std::to_string(tags_[nodes.size()].first) + fault);
  }
  nodes.push_back(node);
  return {};
}

/// Reads "tag x y z", behind a count in text.
Status GmshReader::readNodes2() {
  std::uint64_t count = 0;
  Status status = readTextCount(4, count);
  for (std::uint64_t n = 0; status.ok() && n < count; ++n) {
    status = readTag();
    if (status.ok()) status = readPosition();
  }
  return status;
}

/// Reads blocks of "dimension entity kind count", in 4.0 "entity dimension kind count": block(dimension, kind, count)
/// reads the contents of each.
template <class Block>
Status GmshReader::readBlocks(std::uint64_t numbersEach, Block&& block) {
  std::uint64_t blocks = 0, total = 0;
  if (binary_) in_.restOfLine();
  Status status = readCount(4, blocks);
  if (status.ok()) status = readCount(numbersEach, total);
  std::int64_t ignored = 0;  // the smallest and the largest tag
  if (binary_ && (!tag(ignored) || !tag(ignored))) return cutShort();
  if (!binary_) in_.restOfLine();
  for (std::uint64_t b = 0; status.ok() && b < blocks; ++b) {
    int dimension = 0, entity = 0, kind = 0;
    std::uint64_t count = 0;
    if (!integer(dimension) || !integer(entity) || !integer(kind)) return cutShort();
    status = readCount(numbersEach, count);
    if (status.ok()) status = block(entityFirst_ ? entity : dimension, kind, count);
  }
  return status;
}

/// Reads blocks of nodes of one kind, parametric or not: their tags, then their coordinates; in 4.0 one by one.
Status GmshReader::readNodes4() {
  return readBlocks(4, [this](int dimension, int parametric, std::uint64_t count) -> Status {
    Status status;
    for (std::uint64_t n = 0; status.ok() && !entityFirst_ && n < count; ++n) status = readTag();
    for (std::uint64_t n = 0; status.ok() && n < count; ++n) {
      if (entityFirst_) status = readTag();
      if (status.ok()) status = readPosition();
      double ignored = 0.0;
      for (int i = 0; status.ok() && parametric != 0 && i < std::min(dimension, 3); ++i) {
        if (!number(ignored)) return cutShort();
      }
    }
    return status;
  });
}

/// Reads elements "tag type tagCount tags... nodes...", in binary in runs of one type, behind a count in text.
Status GmshReader::readElements2() {
  std::uint64_t count = 0;
  Status status = readTextCount(4, count);
  for (std::uint64_t e = 0; status.ok() && e < count;) {
    int type = 0, tagCount = 0;
    std::int64_t run = 1;
    if (binary_) {
      if (!integer(type) || !integer(run) || !integer(tagCount)) return cutShort();
      if (run < 1 || static_cast<std::uint64_t>(run) > count - e || tagCount < 0) return cutShort();
      status = readElementsOfKind(type, static_cast<std::uint64_t>(run), tagCount);
    } else {
      tets_.emplace_back();
      if (!integer(tets_.back().tag) || !integer(type) || !integer(tagCount)) return cutShort();
      status = readElement(type, tagCount);
    }
    e += static_cast<std::uint64_t>(run);
  }
  return status;
}

/// Reads blocks of elements of one type.
Status GmshReader::readElements4() {
  return readBlocks(2, [this](int, int type, std::uint64_t count) { return readElementsOfKind(type, count, 0); });
}

/// Reads elements "tag tags... nodes...".
Status GmshReader::readElementsOfKind(int type, std::uint64_t count, int tags) {
  if (binary_ && nodesOf(type) == 0 && count > 0) {
    return error(StatusCode::UnsupportedFormat, "has elements of type " + std::to_string(type) +
                                                    ", which is not supported in binary; save it as ASCII");
  }
  Status status;
  for (std::uint64_t e = 0; status.ok() && e < count; ++e) {
    tets_.emplace_back();
    if (!tag(tets_.back().tag)) return cutShort();
    status = readElement(type, tags);
  }
  return status;
}

/// Reads the rest of an element, whose tag is already in the last entry of `tets_`; the entry is removed if the element
/// is no tet.
Status GmshReader::readElement(int type, int tags) {
  assert(!tets_.empty());
  const bool tet = type == kGmshTet || type == kGmshQuadraticTet || isAboveSecondOrder(type);
  if (!tet && !binary_) in_.restOfLine();
  std::int64_t ignored = 0;
  for (int i = 0; (tet || binary_) && i < tags; ++i) {
    if (!integer(ignored)) return cutShort();
  }
  if (!tet) {
    tets_.pop_back();
    ++report_.skippedCells;
    for (std::size_t i = 0; binary_ && i < nodesOf(type); ++i) {
      if (!tag(ignored)) return cutShort();
    }
    return {};
  }
  tets_.back().line = line();
  tets_.back().type = type;
  for (std::size_t i = 0; i < tets_.back().nodeCount(); ++i) {
    if (!tag(tets_.back().nodes[i])) return cutShort();
  }
  return isAboveSecondOrder(type) ? readSpareTags(type) : Status();
}

/// Reads the nodes of a tet that follow its corners: in text, all of its line.
Status GmshReader::readSpareTags(int type) {
  std::int64_t node = 0;
  for (std::size_t i = 4; binary_ && i < nodesOf(type); ++i) {
    if (!tag(node)) return cutShort();
    spareTags_.push_back(node);
  }
  if (binary_) return {};
  for (TextScanner rest(in_.restOfLine()); rest.integer(node);) spareTags_.push_back(node);
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

/// The index of a node; -1 if there is none with this tag.
int GmshReader::find(std::int64_t tag) const {
  const auto found = std::lower_bound(tags_.begin(), tags_.end(), std::pair<std::int64_t, int>(tag, 0));
  return found == tags_.end() || found->first != tag ? -1 : found->second;
}

Status GmshReader::collectTets() {
  TetMesh& mesh = file_.cage.mesh;
  assert(tags_.size() == mesh.nodeCount() && std::is_sorted(tags_.begin(), tags_.end()));
  mesh.tets.reserve(tets_.size());
  for (const TaggedTet& tagged : tets_) {
    std::array<int, 10> nodes{};
    for (std::size_t i = 0; i < tagged.nodeCount(); ++i) {
      nodes[i] = find(tagged.nodes[i]);
      if (nodes[i] >= 0) continue;
      return fileError(StatusCode::IndexOutOfRange, path_, tagged.line,
                       "tet " + std::to_string(tagged.tag) + " refers to node " + std::to_string(tagged.nodes[i]) +
                           ", which does not exist; correct the tet");
    }
    if (tagged.type == kGmshQuadraticTet) {
      file_.addQuadratic(nodes, kGmshOrder, tagged.line);
      continue;
    }
    if (tagged.type != kGmshTet) {
      file_.highOrder.emplace_back();
      file_.highOrder.back().tet = mesh.tetCount();
      file_.highOrder.back().line = tagged.line;
    }
    mesh.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  }
  for (const std::int64_t tag : spareTags_) file_.spareNodes.push_back(find(tag));
  return {};
}

/// Whether the first section says that the file is binary, in which a carriage return is a byte like any other.
bool saysBinary(std::string_view bytes) {
  TextScanner ahead(bytes);
  return ahead.word() == "$MeshFormat" && !ahead.word().empty() && ahead.word() == "1";
}

}  // namespace

Result<FileCage> readGmshFile(const std::string& path, TetFileReport& report) {
  Result<std::string> text = readFile(path);
  if (!text.ok()) return text.status();
  if (!saysBinary(text.value())) text.value() = withLineFeeds(std::move(text.value()));
  return GmshReader(path, text.value(), report).read();
}

}  // namespace tetskin::io
