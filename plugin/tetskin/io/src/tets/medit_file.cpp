// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Pascal J. Frey, "MEDIT: An Interactive Mesh Visualization Software", INRIA RT-0253, 2001
#include <tetskin/io/src/tets/medit_file.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace tetskin::io {

namespace {

/// Replaces comments, from # to the end of the line, by blanks.
std::string withoutComments(std::string text) {
  for (std::size_t at = text.find('#'); at != text.npos; at = text.find('#', at)) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }
  return text;
}

class MeditReader {
 public:
  MeditReader(const std::string& path, std::string_view text, TetFileReport& report)
      : path_(path), in_(text), report_(report) {}
  Result<FileCage> read();

 private:
  Status readSection(std::string_view name);
  Status readCount(std::uint64_t numbersEach, std::uint64_t& count);
  Status readVertices();
  Status readTets(std::size_t nodesEach);
  Status skip(bool cells);
  Status checkTets() const;
  Status cutShort() const {
    return error(StatusCode::Malformed,
                 "has something other than a number, or ends, within the data; is it complete? Save it again");
  }
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, in_.line(), what); }

  const std::string& path_;
  TextScanner in_;
  TetFileReport& report_;
  std::vector<std::size_t> lines_;  ///< by tet
  FileCage file_;
  TetMesh& mesh_ = file_.cage.mesh;
};

Result<FileCage> MeditReader::read() {
  TextScanner ahead = in_;
  if (ahead.word().substr(0, 20) != "MeshVersionFormatted") {
    return fileError(StatusCode::Malformed, path_, 1,
                     "does not begin with 'MeshVersionFormatted'; is it a Medit file, as text?");
  }
  for (std::string_view word = in_.word(); !word.empty() && word != "End"; word = in_.word()) {
    if (Status status = readSection(word); !status.ok()) return status;
  }
  if (Status status = checkTets(); !status.ok()) return status;
  file_.anyOrder = true;
  return std::move(file_);
}

Status MeditReader::readSection(std::string_view name) {
  if (name == "Vertices") return readVertices();
  if (name == "Tetrahedra") return readTets(4);
  if (name == "TetrahedraP2") return readTets(10);
  if (name == "Dimension") {
    int dimension = 0;
    if (!in_.integer(dimension)) return cutShort();
    if (dimension == 3) return {};
    return error(StatusCode::UnsupportedFormat, "has dimension " + std::to_string(dimension) + "; only 3 is supported");
  }
  for (const std::string_view cells : {"Triangles", "Quadrilaterals", "Hexahedra", "Edges", "Prisms", "Pyramids"}) {
    if (name == cells) return skip(true);
  }
  return skip(false);
}

/// Reads a count of items, each of which takes this many numbers in the file.
Status MeditReader::readCount(std::uint64_t numbersEach, std::uint64_t& count) {
  if (!in_.integer(count)) return cutShort();
  if (count <= static_cast<std::uint64_t>(std::numeric_limits<int>::max()) && in_.hasRoomFor(count * numbersEach)) {
    return {};
  }
  return error(StatusCode::Malformed, "states a count of " + std::to_string(count) +
                                          ", for which the file is too short; is it complete? Save it again");
}

Status MeditReader::readVertices() {
  std::uint64_t count = 0;
  if (Status status = readCount(4, count); !status.ok()) return status;
  for (std::uint64_t n = 0; n < count; ++n) {
    Eigen::Vector3d node;
    if (!in_.number(node[0]) || !in_.number(node[1]) || !in_.number(node[2])) return cutShort();
    in_.word();  // its label
    if (const std::string fault = coordinateFault(node); !fault.empty()) {
      return error(StatusCode::NonFinite, "node " + std::to_string(n + 1) + fault);
    }
    mesh_.nodes.push_back(node);
  }
  return {};
}

Status MeditReader::readTets(std::size_t nodesEach) {
  assert(nodesEach == 4 || nodesEach == 10);
  std::uint64_t count = 0;
  if (Status status = readCount(nodesEach + 1, count); !status.ok()) return status;
  for (std::uint64_t t = 0; t < count; ++t) {
    std::array<int, 10> nodes{};
    for (std::size_t i = 0; i < nodesEach; ++i) {
      if (!in_.integer(nodes[i])) return cutShort();
      nodes[i] = std::max(nodes[i], 0) - 1;
    }
    if (nodesEach == 4) {
      mesh_.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
    } else {
      file_.addQuadratic(nodes, kNoOrder, in_.line());
    }
    lines_.push_back(in_.line());
    in_.word();  // its label
  }
  return {};
}

/// Reads over a section up to the next keyword.
Status MeditReader::skip(bool cells) {
  std::uint64_t count = 0;
  if (cells) {
    if (Status status = readCount(2, count); !status.ok()) return status;
  }
  report_.skippedCells += count;
  const auto isKeyword = [](std::string_view word) {
    return word.size() > 2 && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z')) &&
           word != "nan" && word != "inf";
  };
  for (TextScanner ahead = in_; !isKeyword(ahead.word()) && in_.remaining() > 0; ahead = in_) in_.word();
  return {};
}

/// Vertices may follow their tets.
Status MeditReader::checkTets() const {
  const auto exists = [&](int node) { return node >= 0 && static_cast<std::size_t>(node) < mesh_.nodeCount(); };
  const auto missing = [&](std::size_t tet) {
    return fileError(StatusCode::IndexOutOfRange, path_, lines_[tet],
                     "tet " + std::to_string(tet + 1) + " refers to a node that does not exist, of " +
                         std::to_string(mesh_.nodeCount()) + ", counted from 1; correct the tet");
  };
  for (std::size_t t = 0; t < lines_.size(); ++t) {
    if (!std::all_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), exists)) return missing(t);
  }
  for (const HighOrderTet& tet : file_.highOrder) {
    if (!std::all_of(tet.middles.begin(), tet.middles.end(), exists)) return missing(tet.tet);
  }
  return {};
}

}  // namespace

Result<FileCage> readMeditFile(const std::string& path, TetFileReport& report) {
  Result<std::string> text = readText(path);
  if (!text.ok()) return text.status();
  const std::string plain = withoutComments(std::move(text).value());
  return MeditReader(path, plain, report).read();
}

}  // namespace tetskin::io
