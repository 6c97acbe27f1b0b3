// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "VTK File Formats", Kitware, chapter "Simple Legacy Formats" (versions 2.0 to 5.1)
#include <tetskin/io/src/tets/vtk_file.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetskin::io {

namespace {

constexpr int kVtkTet = 10;
constexpr int kVtkQuadraticTet = 24;
constexpr int kVtkLagrangeTet = 71;

std::string lower(std::string_view word) {
  std::string result(word);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

class VtkReader {
 public:
  VtkReader(const std::string& path, std::string_view text, TetFileReport& report)
      : path_(path), in_(text), report_(report) {}
  Result<TetMesh> read();

 private:
  Status readHeader();
  Status readSection(const std::string& keyword);
  Status readPoints();
  Status readCells();
  Status readCountedCells(std::uint64_t cellCount, std::uint64_t size);
  Status readOffsetCells(std::uint64_t offsetCount, std::uint64_t size);
  Status readCellTypes();
  Status skipField();
  Status skipArray(std::uint64_t count, const std::string& type);
  void skipMetadata();
  /// Binary data begin on the next line; text may go on in the same one.
  void endHeader() {
    if (binary_) in_.restOfLine();
  }

  Status readCount(const char* what, std::uint64_t& count);
  Status readReals(std::uint64_t count, const std::string& type, std::vector<double>& values);
  Status readIntegers(std::uint64_t count, const std::string& type, std::vector<std::int64_t>& values,
                      std::vector<std::size_t>* lines = nullptr);
  Status checkRoom(std::uint64_t count, const std::string& type);
  Status notANumber();

  Status collectTets();
  Status addTet(std::size_t cell);
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, in_.line(), what); }
  /// Binary data has no lines worth naming.
  std::size_t lineOf(std::size_t entry) const { return entry < entryLines_.size() ? entryLines_[entry] : 0; }

  const std::string& path_;
  TextScanner in_;
  TetFileReport& report_;
  bool binary_ = false;
  bool hasPoints_ = false, hasCells_ = false, hasTypes_ = false;
  std::vector<std::int64_t> entries_;    ///< node indices of all cells, perhaps with their counts between them
  std::vector<std::size_t> entryLines_;  ///< where each stands in an ASCII file
  std::vector<std::size_t> cellFirst_;   ///< by cell: where its nodes begin in entries_
  std::vector<std::size_t> cellSize_;    ///< by cell: how many they are
  std::vector<std::int64_t> cellTypes_;
  TetMesh mesh_;
};

Result<TetMesh> VtkReader::read() {
  Status status = readHeader();
  while (status.ok()) {
    const std::string keyword = lower(in_.word());
    // What follows is data on points and cells, of no interest here.
    if (keyword.empty() || keyword == "point_data" || keyword == "cell_data") break;
    status = readSection(keyword);
  }
  if (!status.ok()) return status;
  if (!hasPoints_ || !hasCells_) {
    return error(StatusCode::Malformed,
                 std::string("ends before ") + (hasPoints_ ? "CELLS" : "POINTS") + "; is it complete? Save it again");
  }
  status = collectTets();
  if (!status.ok()) return status;
  return std::move(mesh_);
}

Status VtkReader::readHeader() {
  const std::string_view first = in_.restOfLine();
  if (first.substr(0, 5) == "<?xml" || first.substr(0, 8) == "<VTKFile") {
    return error(StatusCode::UnsupportedFormat, "is an XML file of VTK, which is not read; save it as legacy VTK");
  }
  TextScanner mark(first.substr(0, 1) == "#" ? first.substr(1) : std::string_view());  // some files have no blank there
  if (lower(mark.word()) != "vtk" || lower(mark.word()) != "datafile" || lower(mark.word()) != "version") {
    return fileError(StatusCode::Malformed, path_, 1,
                     "does not begin with '# vtk DataFile Version'; is it a legacy VTK file?");
  }
  in_.restOfLine();  // the title, which may be anything
  const std::string kind = lower(in_.word());
  if (kind != "ascii" && kind != "binary") {
    return error(StatusCode::Malformed, "has " + excerpt(kind) + " in place of ASCII or BINARY; correct the header");
  }
  binary_ = kind == "binary";
  return {};
}

Status VtkReader::readSection(const std::string& keyword) {
  if (keyword == "dataset") {
    const std::string kind = lower(in_.word());
    if (kind == "unstructured_grid") return {};
    return error(kind.empty() ? StatusCode::Malformed : StatusCode::UnsupportedFormat,
                 "is a dataset of kind " + excerpt(kind) + "; only UNSTRUCTURED_GRID holds tets, save it as that");
  }
  if (keyword == "points") return readPoints();
  if (keyword == "cells") return readCells();
  if (keyword == "cell_types") return readCellTypes();
  if (keyword == "field") return skipField();
  if (keyword == "metadata") {
    skipMetadata();
    return {};
  }
  return error(StatusCode::Malformed, "has " + excerpt(keyword) +
                                          " where a section should begin; does the section before it have the right "
                                          "number of entries?");
}

Status VtkReader::readCount(const char* what, std::uint64_t& count) {
  const std::string_view word = in_.word();
  if (parseInteger(word, count)) return {};
  return error(StatusCode::Malformed, "has " + excerpt(word) + " for the number of " + what + "; correct the file");
}

Status VtkReader::checkRoom(std::uint64_t count, const std::string& type) {
  const NumberType numbers = vtkNumberType(type);
  if (binary_ && numbers.bytes == 0) {
    return error(StatusCode::UnsupportedFormat,
                 "has binary data of type " + excerpt(type) + ", which is not read; save it as ASCII");
  }
  if (binary_ ? count <= in_.remaining() / numbers.bytes : in_.hasRoomFor(count)) return {};
  return error(StatusCode::Malformed, "states " + std::to_string(count) +
                                          " numbers, for which the file is too short; is it complete? Save it again");
}

Status VtkReader::notANumber() {
  return error(StatusCode::Malformed,
               "has something else than a number, or ends, within the data; is it complete? Save it again");
}

Status VtkReader::readReals(std::uint64_t count, const std::string& type, std::vector<double>& values) {
  Status status = checkRoom(count, type);
  if (!status.ok()) return status;
  values.resize(static_cast<std::size_t>(count));
  if (binary_) {
    const NumberType numbers = vtkNumberType(type);
    const std::string_view data = in_.bytes(values.size() * numbers.bytes);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = decodeNumber(data.data() + i * numbers.bytes, numbers);
    return {};
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!in_.number(values[i])) return notANumber();
    const std::string fault = coordinateFault({values[i], 0.0, 0.0});
    if (!fault.empty()) return error(StatusCode::NonFinite, "node " + std::to_string(i / 3) + fault);
  }
  return {};
}

Status VtkReader::readIntegers(std::uint64_t count, const std::string& type, std::vector<std::int64_t>& values,
                               std::vector<std::size_t>* lines) {
  Status status = checkRoom(count, type);
  if (!status.ok()) return status;
  values.resize(static_cast<std::size_t>(count));
  if (binary_) {
    const NumberType numbers = vtkNumberType(type);
    if (numbers.real) return error(StatusCode::Malformed, "has indices of type " + excerpt(type) + "; save it again");
    const std::string_view data = in_.bytes(values.size() * numbers.bytes);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = decodeInteger(data.data() + i * numbers.bytes, numbers);
    return {};
  }
  if (lines) lines->resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!in_.integer(values[i])) return notANumber();
    if (lines) (*lines)[i] = in_.line();
  }
  return {};
}

Status VtkReader::readPoints() {
  std::uint64_t count = 0;
  Status status = readCount("points", count);
  if (!status.ok()) return status;
  const std::string type = lower(in_.word());
  endHeader();
  if (count > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    return error(StatusCode::Malformed, "states " + std::to_string(count) + " points; correct the file");
  }
  std::vector<double> values;
  if (status = readReals(3 * count, type, values); !status.ok()) return status;
  mesh_.nodes.resize(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
    mesh_.nodes[n] = Eigen::Vector3d(&values[3 * n]);
    const std::string fault = coordinateFault(mesh_.nodes[n]);
    if (!fault.empty()) return fileError(StatusCode::NonFinite, path_, 0, "node " + std::to_string(n) + fault);
  }
  hasPoints_ = true;
  return {};
}

Status VtkReader::readCells() {
  std::uint64_t count = 0, size = 0;
  Status status = readCount("cells", count);
  if (status.ok()) status = readCount("cell entries", size);
  if (!status.ok()) return status;
  endHeader();
  cellFirst_.clear();
  cellSize_.clear();
  entries_.clear();
  entryLines_.clear();
  hasCells_ = true;
  TextScanner ahead = in_;
  return lower(ahead.word()) == "offsets" ? readOffsetCells(count, size) : readCountedCells(count, size);
}

/// The form up to version 4: every cell is the number of its nodes and their indices. How many numbers these are tells
/// where binary data end. Text needs no telling, and some of Bullet's own files state it wrong.
Status VtkReader::readCountedCells(std::uint64_t cellCount, std::uint64_t size) {
  std::vector<std::int64_t> numbers;
  Status status = binary_ ? readIntegers(size, "int", numbers) : Status();
  if (!status.ok()) return status;
  std::size_t taken = 0;
  const auto take = [&](std::int64_t& number) {
    if (!binary_) return in_.integer(number);
    if (taken == numbers.size()) return false;
    number = numbers[taken++];
    return true;
  };
  for (std::uint64_t cell = 0; cell < cellCount; ++cell) {
    std::int64_t nodes = 0;
    bool good = take(nodes) && nodes >= 0;
    const std::size_t line = binary_ ? 0 : in_.line();
    cellFirst_.push_back(entries_.size());
    for (std::int64_t n = 0; good && n < nodes; ++n) {
      good = take(entries_.emplace_back());
      if (!binary_) entryLines_.push_back(in_.line());
    }
    cellSize_.push_back(entries_.size() - cellFirst_.back());
    if (good) continue;
    return fileError(StatusCode::Malformed, path_, line,
                     "cell " + std::to_string(cell) + " of " + std::to_string(cellCount) +
                         " is not the number of its nodes and as many indices; is the file complete? Save it again, or "
                         "correct the cell or the counts");
  }
  if (taken == numbers.size()) return {};
  return error(StatusCode::Malformed,
               "has entries behind the last of its " + std::to_string(cellCount) + " cells; correct the counts");
}

/// The form of version 5: cell c is the range [OFFSETS[c], OFFSETS[c + 1]) of CONNECTIVITY.
Status VtkReader::readOffsetCells(std::uint64_t offsetCount, std::uint64_t size) {
  in_.word();
  std::string type = lower(in_.word());
  endHeader();
  std::vector<std::int64_t> offsets;
  if (Status status = readIntegers(offsetCount, type, offsets); !status.ok()) return status;
  const std::string keyword = lower(in_.word());
  if (keyword != "connectivity") {
    return error(StatusCode::Malformed, "has " + excerpt(keyword) + " in place of CONNECTIVITY; correct the file");
  }
  type = lower(in_.word());
  endHeader();
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
  Status status = readCount("cell types", count);
  if (!status.ok()) return status;
  endHeader();
  // Bullet's own files end with a lone "CELL_TYPES 10": all cells are tets.
  TextScanner ahead = in_;
  if (count == kVtkTet && ahead.word().empty()) return {};
  hasTypes_ = true;
  return readIntegers(count, "int", cellTypes_);
}

Status VtkReader::skipField() {
  in_.word();  // its name
  std::uint64_t arrays = 0;
  Status status = readCount("field arrays", arrays);
  for (std::uint64_t i = 0; status.ok() && i < arrays; ++i) {
    if (in_.word().empty()) return error(StatusCode::Malformed, "ends within FIELD; is it complete? Save it again");
    std::uint64_t components = 0, tuples = 0;
    status = readCount("components", components);
    if (status.ok()) status = readCount("tuples", tuples);
    if (!status.ok()) return status;
    const std::string type = lower(in_.word());
    if (binary_ || type == "string") in_.restOfLine();
    if (components > 0 && tuples > in_.remaining() / components) {
      return error(StatusCode::Malformed, "states a field array larger than the file; is it complete? Save it again");
    }
    status = skipArray(components * tuples, type);
    TextScanner ahead = in_;
    if (lower(ahead.word()) == "metadata") {
      in_ = ahead;
      skipMetadata();
    }
  }
  return status;
}

Status VtkReader::skipArray(std::uint64_t count, const std::string& type) {
  if (binary_) {
    Status status = checkRoom(count, type);
    if (status.ok()) in_.bytes(static_cast<std::size_t>(count) * vtkNumberType(type).bytes);
    return status;
  }
  // A string has a line of its own, with its blanks encoded, and may be empty.
  for (std::uint64_t i = 0; i < count; ++i) type == "string" ? in_.restOfLine() : in_.word();
  return {};
}

/// Metadata ends with an empty line.
void VtkReader::skipMetadata() {
  in_.restOfLine();
  while (in_.remaining() > 0 && !in_.restOfLine().empty()) continue;
}

Status VtkReader::collectTets() {
  if (hasTypes_ && cellTypes_.size() != cellFirst_.size()) {
    return error(StatusCode::Malformed, "has " + std::to_string(cellTypes_.size()) + " cell types for " +
                                            std::to_string(cellFirst_.size()) + " cells; correct the counts");
  }
  for (std::size_t cell = 0; cell < cellFirst_.size(); ++cell) {
    if (hasTypes_ && cellTypes_[cell] != kVtkTet) {
      ++report_.skippedCells;
      report_.skippedHighOrder += cellTypes_[cell] == kVtkQuadraticTet || cellTypes_[cell] == kVtkLagrangeTet;
      continue;
    }
    Status status = addTet(cell);
    if (!status.ok()) return status;
  }
  return {};
}

Status VtkReader::addTet(std::size_t cell) {
  const std::size_t first = cellFirst_[cell];
  if (cellSize_[cell] != 4) {
    return fileError(
        StatusCode::Malformed, path_, lineOf(first),
        "cell " + std::to_string(cell) + " has " + std::to_string(cellSize_[cell]) + " nodes where a tet has 4" +
            (hasTypes_ ? "; correct its type" : ", and without CELL_TYPES all cells must be tets; add them"));
  }
  Tet tet;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t node = entries_[first + i];
    if (node < 0 || static_cast<std::uint64_t>(node) >= mesh_.nodeCount()) {
      return fileError(StatusCode::IndexOutOfRange, path_, lineOf(first + i),
                       "cell " + std::to_string(cell) + " names node " + std::to_string(node) + ", but there are " +
                           std::to_string(mesh_.nodeCount()) + ", counted from 0; correct the cell");
    }
    tet[i] = static_cast<int>(node);
  }
  mesh_.tets.push_back(tet);
  return {};
}

}  // namespace

Result<TetMesh> readVtkFile(const std::string& path, TetFileReport& report) {
  Result<std::string> text = readFile(path);
  if (!text.ok()) return text.status();
  // In binary data a carriage return is a byte like any other, but lines before them end with a line feed.
  if (text.value().find('\n') == std::string::npos) text.value() = withLineFeeds(std::move(text.value()));
  return VtkReader(path, text.value(), report).read();
}

}  // namespace tetskin::io
