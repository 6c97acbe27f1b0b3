// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Hang Si, "TetGen, a Delaunay-Based Quality Tetrahedral Mesh Generator", file formats .node and .ele
#include <tetskin/io/src/tets/tet_readers.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_records.h>

#include <cassert>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <system_error>

namespace tetskin::io {

namespace {

Status malformed(const std::string& path, const TextScanner& record, const std::string& what) {
  return fileError(StatusCode::Malformed, path, record.line(), what);
}

Status tooShort(const std::string& path, const TextScanner& record, std::uint64_t count, const char* what) {
  return malformed(path, record,
                   "states " + std::to_string(count) + " " + what +
                       ", for which the file is too short; is it complete? Save it again");
}

/// Reads `.node`: a header "count dimension attributes markers", then lines "index x y z ...". `base` is the first
/// index.
Status readNodes(const std::string& path, std::string_view text, std::vector<Eigen::Vector3d>& nodes,
                 std::int64_t& base) {
  TextRecords records(text);
  TextScanner header = records.next();
  std::uint64_t count = 0, dimension = 0;
  if (!header.integer(count) || !header.integer(dimension)) {
    return malformed(path, header, "does not begin with the number of nodes and their dimension; is it a TetGen file?");
  }
  if (dimension != 3) {
    return fileError(StatusCode::UnsupportedFormat, path, header.line(),
                     "has nodes of dimension " + std::to_string(dimension) + "; only 3 is supported");
  }
  if (count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()) || !records.hasRoomFor(4 * count)) {
    return tooShort(path, header, count, "nodes");
  }
  nodes.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t n = 0; n < count; ++n) {
    TextScanner record = records.next();
    std::int64_t index = 0;
    Eigen::Vector3d node;
    if (!record.integer(index) || !record.number(node[0]) || !record.number(node[1]) || !record.number(node[2])) {
      return malformed(path, record,
                       "has no index and three coordinates for node " + std::to_string(n) + " of " +
                           std::to_string(count) + "; is it complete? Correct the line");
    }
    if (n == 0) base = index;
    if (base < 0 || base > 1 || index != base + static_cast<std::int64_t>(n)) {
      return malformed(
          path, record,
          "has node " + std::to_string(index) + " out of order; nodes must be numbered consecutively from 0 or 1");
    }
    if (const std::string fault = coordinateFault(node); !fault.empty()) {
      return fileError(StatusCode::NonFinite, path, record.line(), "node " + std::to_string(index) + fault);
    }
    nodes.push_back(node);
  }
  return {};
}

Status readTet(const std::string& path, TextScanner& record, std::uint64_t t, std::size_t nodeCount, std::int64_t base,
               Tet& nodes) {
  assert(base == 0 || base == 1);
  record.word();  // its index, which is not used
  for (std::size_t i = 0; i < 4; ++i) {
    std::int64_t node = 0;
    if (!record.integer(node)) {
      return malformed(
          path, record,
          "has no index and four nodes for tet " + std::to_string(t) + "; is it complete? Correct the line");
    }
    if (node < base || node - base >= static_cast<std::int64_t>(nodeCount)) {
      return fileError(StatusCode::IndexOutOfRange, path, record.line(),
                       "tet " + std::to_string(t) + " refers to node " + std::to_string(node) + ", but there are " +
                           std::to_string(nodeCount) + ", counted from " + std::to_string(base) + "; correct the tet");
    }
    nodes[i] = static_cast<int>(node - base);
  }
  return {};
}

/// Reads `.ele`: a header "count nodesPerTet attributes", then lines "index n1 n2 n3 n4 ...".
Status readTets(const std::string& path, std::string_view text, std::int64_t base, TetMesh& mesh) {
  TextRecords records(text);
  TextScanner header = records.next();
  std::uint64_t count = 0, corners = 0;
  if (!header.integer(count) || !header.integer(corners)) {
    return malformed(path, header, "does not begin with the number of tets and of their nodes; is it a TetGen file?");
  }
  if (corners == 10) {
    return fileError(StatusCode::UnsupportedFormat, path, header.line(),
                     "has tets of second order; run TetGen without -o2: `refineQuadratic` makes the same tets of the "
                     "result");
  }
  if (corners != 4) {
    return malformed(path, header, "has tets of " + std::to_string(corners) + " nodes; only 4 are supported");
  }
  if (count > std::numeric_limits<std::uint32_t>::max() || !records.hasRoomFor((corners + 1) * count)) {
    return tooShort(path, header, count, "tets");
  }
  mesh.tets.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t t = 0; t < count; ++t) {
    TextScanner record = records.next();
    if (Status status = readTet(path, record, t, mesh.nodeCount(), base, mesh.tets.emplace_back()); !status.ok()) {
      return status;
    }
  }
  return {};
}

/// The path of the file with the same name and another extension, which may also be in capitals.
std::string sibling(const std::string& path, const char* extension, const char* capitals) {
  std::filesystem::path result = path;
  std::error_code ignored;
  if (std::filesystem::exists(result.replace_extension(capitals), ignored)) return result.string();
  return result.replace_extension(extension).string();
}

}  // namespace

Result<FileCage> readTetgenFiles(const std::string& path) {
  const bool isNode = lowerExtension(path) == ".node";
  const std::string nodePath = isNode ? path : sibling(path, ".node", ".NODE");
  const std::string elePath = isNode ? sibling(path, ".ele", ".ELE") : path;
  const Result<std::string> nodeText = readText(nodePath);
  if (!nodeText.ok()) return nodeText.status();
  const Result<std::string> eleText = readText(elePath);
  if (!eleText.ok()) return eleText.status();

  FileCage file;
  file.path = elePath;
  std::int64_t base = 0;
  Status status = readNodes(nodePath, nodeText.value(), file.cage.mesh.nodes, base);
  if (status.ok()) status = readTets(elePath, eleText.value(), base, file.cage.mesh);
  if (!status.ok()) return status;
  return file;
}

}  // namespace tetskin::io
