// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "VTK File Formats", Kitware, chapter "Simple Legacy Formats" (versions 2.0 to 5.1)
#include <tetskin/io/src/tets/tet_readers.h>
#include <tetskin/io/src/tets/vtk_cage_data.h>
#include <tetskin/io/src/tets/vtk_text.h>
#include <tetskin/io/src/text/coordinate_fault.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetskin::io {

namespace {

/// VTK's numbers for cells of these types.
constexpr int kVtkTet = 10;
constexpr int kVtkQuadraticTet = 24;
constexpr int kVtkLagrangeTet = 71;
constexpr int kVtkBezierTet = 79;

class VtkReader {
 public:
  VtkReader(const std::string& path, std::string_view text, ReadAs as, TetFileReport& report)
      : file_(path, text), withData_(as == ReadAs::Cage), report_(report) {}
  Result<FileCage> read();

 private:
  Status readHeader();
  Status readSections();
  Status readSection(const std::string& keyword);
  Status readPoints();
  Status readCells();
  Status readCountedCells(std::uint64_t cellCount, std::uint64_t size);
  Status readOffsetCells(std::uint64_t offsetCount, std::uint64_t size);
  Status readCellTypes();

  Status readIntegers(std::uint64_t count, const std::string& type, std::vector<std::int64_t>& values,
                      std::vector<std::size_t>* lines = nullptr);

  Status collectTets();
  bool isHighOrderTet(std::size_t cell) const {
    assert(!hasTypes_ || cell < cellTypes_.size());
    return hasTypes_ && (cellTypes_[cell] == kVtkQuadraticTet || cellTypes_[cell] == kVtkLagrangeTet ||
                         cellTypes_[cell] == kVtkBezierTet);
  }
  bool isTet(std::size_t cell) const { return !hasTypes_ || cellTypes_[cell] == kVtkTet || isHighOrderTet(cell); }
  Status addTet(std::size_t cell);
  Status checkSize(std::size_t cell) const;
  Status error(StatusCode code, const std::string& what) const { return file_.error(code, what); }
  Status errorAt(std::size_t line, StatusCode code, const std::string& what) const {
    return fileError(code, file_.path(), line, what);
  }
  /// Lines of binary data are not worth reporting.
  std::size_t lineOf(std::size_t entry) const { return entry < entryLines_.size() ? entryLines_[entry] : 0; }

  VtkText file_;
  const bool withData_;
  TetFileReport& report_;
  bool hasPoints_ = false, hasCells_ = false, hasTypes_ = false;
  std::vector<std::int64_t> entries_;    ///< node indices of all cells, possibly with their counts between them
  std::vector<std::size_t> entryLines_;  ///< line of each entry in an ASCII file
  std::vector<std::size_t> cellFirst_;   ///< by cell: index of its first node in entries_
  std::vector<std::size_t> cellSize_;    ///< by cell: number of its nodes
  std::vector<std::int64_t> cellTypes_;
  FileCage result_;
  Cage& cage_ = result_.cage;
  VtkCageData data_{file_, cage_};
};

Result<FileCage> VtkReader::read() {
  Status status = readHeader();
  if (status.ok()) status = readSections();
  if (status.ok()) status = collectTets();
  if (!status.ok()) return status;
  result_.path = file_.path();
  return std::move(result_);
}

/// Reads up to the data of points and cells, and also these if the cage's data is wanted.
Status VtkReader::readSections() {
  std::string keyword = file_.word();
  Status status;
  for (; status.ok() && !keyword.empty() && keyword != "point_data" && keyword != "cell_data"; keyword = file_.word()) {
    status = readSection(keyword);
  }
  if (!status.ok()) return status;
  if (!hasPoints_ || !hasCells_) {
    return error(StatusCode::Malformed,
                 std::string("ends before ") + (hasPoints_ ? "CELLS" : "POINTS") + "; is it complete? Save it again");
  }
  if (hasTypes_ && cellTypes_.size() != cellFirst_.size()) {
    return error(StatusCode::Malformed, "has " + std::to_string(cellTypes_.size()) + " cell types for " +
                                            std::to_string(cellFirst_.size()) + " cells; correct the counts");
  }
  return withData_ ? data_.readSections(keyword, cellFirst_.size(), cage_.mesh.nodeCount()) : status;
}

Status VtkReader::readHeader() {
  const std::string_view first = file_.restOfLine();
  if (first.substr(0, 5) == "<?xml" || first.substr(0, 8) == "<VTKFile") {
    return error(StatusCode::UnsupportedFormat, "is an XML file of VTK, which is not supported; save it as legacy VTK");
  }
  TextScanner mark(first.substr(0, 1) == "#" ? first.substr(1) : std::string_view());  // some files have no blank there
  if (VtkText::lower(mark.word()) != "vtk" || VtkText::lower(mark.word()) != "datafile" ||
      VtkText::lower(mark.word()) != "version") {
    return errorAt(1, StatusCode::Malformed, "does not begin with '# vtk DataFile Version'; is it a legacy VTK file?");
  }
  file_.restOfLine();  // the title, which may be anything
  const std::string kind = file_.word();
  if (kind != "ascii" && kind != "binary") {
    return error(StatusCode::Malformed, "has " + excerpt(kind) + " in place of ASCII or BINARY; correct the header");
  }
  file_.setBinary(kind == "binary");
  return {};
}

Status VtkReader::readSection(const std::string& keyword) {
  if (keyword == "dataset") {
    const std::string kind = file_.word();
    if (kind == "unstructured_grid") return {};
    return error(
        kind.empty() ? StatusCode::Malformed : StatusCode::UnsupportedFormat,
        "is a dataset of kind " + excerpt(kind) + "; save it as UNSTRUCTURED_GRID, the only kind that holds tets");
  }
  if (keyword == "points") return readPoints();
  if (keyword == "cells") return readCells();
  if (keyword == "cell_types") return readCellTypes();
  if (keyword == "field") {
    return withData_ ? data_.readField() : file_.readField([&](const VtkArray& array) { return file_.skip(array); });
  }
  if (keyword == "metadata") {
    file_.skipMetadata();
    return {};
  }
  return error(StatusCode::Malformed, "has " + excerpt(keyword) +
                                          " where a section is expected; does the section before it have the right "
                                          "number of entries?");
}

Status VtkReader::readIntegers(std::uint64_t count, const std::string& type, std::vector<std::int64_t>& values,
                               std::vector<std::size_t>* lines) {
  values.clear();
  values.reserve(file_.room(count));
  if (lines && !file_.binary()) lines->reserve(file_.room(count));
  return file_.readNumbers<std::int64_t>(count, type, [&](std::int64_t value) -> Status {
    values.push_back(value);
    if (lines && !file_.binary()) lines->push_back(file_.line());
    return {};
  });
}

Status VtkReader::readPoints() {
  std::uint64_t count = 0;
  Status status = file_.readCount("points", count);
  if (!status.ok()) return status;
  const std::string type = file_.word();
  file_.endHeader();
  if (count > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    return error(StatusCode::Malformed, "states " + std::to_string(count) + " points; correct the file");
  }
  std::vector<double> values;
  values.reserve(file_.room(3 * count));
  status = file_.readNumbers<double>(3 * count, type, [&](double value) -> Status {
    const std::string fault = coordinateFault({value, 0.0, 0.0});
    values.push_back(value);
    if (fault.empty()) return {};
    return errorAt(file_.binary() ? 0 : file_.line(), StatusCode::NonFinite,
                   "node " + std::to_string((values.size() - 1) / 3) + fault);
  });
  if (!status.ok()) return status;
  cage_.mesh.nodes.resize(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < cage_.mesh.nodes.size(); ++n) cage_.mesh.nodes[n] = Eigen::Vector3d(&values[3 * n]);
  hasPoints_ = true;
  return {};
}

Status VtkReader::readCells() {
  std::uint64_t count = 0, size = 0;
  Status status = file_.readCount("cells", count);
  if (status.ok()) status = file_.readCount("cell entries", size);
  if (!status.ok()) return status;
  file_.endHeader();
  cellFirst_.clear();
  cellSize_.clear();
  entries_.clear();
  entryLines_.clear();
  hasCells_ = true;
  return file_.wordAhead() == "offsets" ? readOffsetCells(count, size) : readCountedCells(count, size);
}

/// Reads the form up to version 4: every cell is the number of its nodes and their indices. The total of these numbers
/// determines where binary data ends. In text it is not needed, and some of Bullet's own files state it incorrectly.
Status VtkReader::readCountedCells(std::uint64_t cellCount, std::uint64_t size) {
  assert(cellFirst_.empty() && entries_.empty());
  std::vector<std::int64_t> numbers;
  Status status = file_.binary() ? readIntegers(size, "int", numbers) : Status();
  if (!status.ok()) return status;
  std::size_t taken = 0;
  const auto take = [&](std::int64_t& number) {
    if (!file_.binary()) return file_.integer(number);
    if (taken == numbers.size()) return false;
    number = numbers[taken++];
    return true;
  };
  for (std::uint64_t cell = 0; cell < cellCount; ++cell) {
    std::int64_t nodes = 0;
    bool good = take(nodes) && nodes >= 0;
    const std::size_t line = file_.binary() ? 0 : file_.line();
    cellFirst_.push_back(entries_.size());
    for (std::int64_t n = 0; good && n < nodes; ++n) {
      good = take(entries_.emplace_back());
      if (!file_.binary()) entryLines_.push_back(file_.line());
    }
    cellSize_.push_back(entries_.size() - cellFirst_.back());
    if (good) continue;
    return errorAt(line, StatusCode::Malformed,
                   "cell " + std::to_string(cell) + " of " + std::to_string(cellCount) +
                       " is not a number of nodes followed by as many indices; is the file complete? Save it again, or "
                       "correct the cell or the counts");
  }
  if (taken == numbers.size()) return {};
  return error(StatusCode::Malformed,
               "has entries after the last of its " + std::to_string(cellCount) + " cells; correct the counts");
}

/// Reads the form of version 5: cell c is the range [OFFSETS[c], OFFSETS[c + 1]) of CONNECTIVITY.
Status VtkReader::readOffsetCells(std::uint64_t offsetCount, std::uint64_t size) {
  assert(cellFirst_.empty() && entries_.empty());
  file_.word();
  std::string type = file_.word();
  file_.endHeader();
  std::vector<std::int64_t> offsets;
  if (Status status = readIntegers(offsetCount, type, offsets); !status.ok()) return status;
  const std::string keyword = file_.word();
  if (keyword != "connectivity") {
    return error(StatusCode::Malformed, "has " + excerpt(keyword) + " in place of CONNECTIVITY; correct the file");
  }
  type = file_.word();
  file_.endHeader();
  if (Status status = readIntegers(size, type, entries_, &entryLines_); !status.ok()) return status;
  for (std::size_t cell = 0; cell + 1 < offsets.size(); ++cell) {
    const std::int64_t first = offsets[cell], end = offsets[cell + 1];
    if (first < 0 || end < first || static_cast<std::uint64_t>(end) > size) {
      return error(StatusCode::Malformed, "cell " + std::to_string(cell) +
                                              " has offsets beyond CONNECTIVITY or in the wrong order; correct them");
    }
    cellFirst_.push_back(static_cast<std::size_t>(first));
    cellSize_.push_back(static_cast<std::size_t>(end - first));
  }
  return {};
}

Status VtkReader::readCellTypes() {
  std::uint64_t count = 0;
  Status status = file_.readCount("cell types", count);
  if (!status.ok()) return status;
  file_.endHeader();
  // Bullet's own files end with a lone "CELL_TYPES 10": all cells are tets.
  if (count == kVtkTet && file_.wordAhead().empty()) return {};
  hasTypes_ = true;
  return readIntegers(count, "int", cellTypes_);
}

Status VtkReader::collectTets() {
  assert(cellSize_.size() == cellFirst_.size() && cage_.mesh.tets.empty());
  for (std::size_t cell = 0; cell < cellFirst_.size(); ++cell) {
    if (isTet(cell)) {
      if (Status status = addTet(cell); !status.ok()) return status;
      continue;
    }
    ++report_.skippedCells;
  }
  if (report_.skippedCells == 0) return {};
  std::vector<bool> tets;
  for (std::size_t cell = 0; cell < cellFirst_.size(); ++cell) tets.push_back(isTet(cell));
  data_.keepTets(tets);
  return {};
}

Status VtkReader::addTet(std::size_t cell) {
  assert(cell < cellFirst_.size() && cellFirst_[cell] + cellSize_[cell] <= entries_.size());
  const std::size_t first = cellFirst_[cell], size = cellSize_[cell];
  if (Status status = checkSize(cell); !status.ok()) return status;
  std::array<int, 10> nodes{};
  for (std::size_t i = 0; i < (size == 10 ? 10 : 4); ++i) {
    const std::int64_t node = entries_[first + i];
    if (node < 0 || static_cast<std::uint64_t>(node) >= cage_.mesh.nodeCount()) {
      return errorAt(lineOf(first + i), StatusCode::IndexOutOfRange,
                     "cell " + std::to_string(cell) + " refers to node " + std::to_string(node) + ", but there are " +
                         std::to_string(cage_.mesh.nodeCount()) + ", counted from 0; correct the cell");
    }
    nodes[i] = static_cast<int>(node);
  }
  if (size == 10) {
    // VTK's order of edges is 01, 12, 02, 03, 13, 23.
    result_.highOrder.push_back(
        {cage_.mesh.tetCount(), {nodes[4], nodes[6], nodes[7], nodes[5], nodes[8], nodes[9]}, lineOf(first)});
  }
  cage_.mesh.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  return {};
}

/// Tets of first order have 4 nodes, those of second order 10; Lagrange and Bezier tets have either number, or more,
/// and are then refused.
Status VtkReader::checkSize(std::size_t cell) const {
  const std::size_t size = cellSize_[cell];
  const bool secondOrder = isHighOrderTet(cell);
  const bool anyOrder = secondOrder && cellTypes_[cell] != kVtkQuadraticTet;
  if (size == (secondOrder ? 10 : 4) || (anyOrder && size == 4)) return {};
  if (anyOrder && size > 10) {
    return errorAt(
        lineOf(cellFirst_[cell]), StatusCode::UnsupportedFormat,
        "cell " + std::to_string(cell) + " is a tet above second order; save the mesh at second or first order");
  }
  return errorAt(lineOf(cellFirst_[cell]), StatusCode::Malformed,
                 "cell " + std::to_string(cell) + " has " + std::to_string(size) + " nodes where a tet " +
                     (secondOrder ? "of second order has 10" : "has 4") +
                     (hasTypes_ ? "; correct its type" : ", and without CELL_TYPES all cells must be tets; add them"));
}

}  // namespace

Result<FileCage> readVtkFile(const std::string& path, ReadAs as, TetFileReport& report) {
  Result<std::string> text = readFile(path);
  if (!text.ok()) return text.status();
  // In binary data, a carriage return is a byte like any other, but the lines before the data end with a line feed.
  if (text.value().find('\n') == std::string::npos) text.value() = withLineFeeds(std::move(text.value()));
  return VtkReader(path, text.value(), as, report).read();
}

}  // namespace tetskin::io
