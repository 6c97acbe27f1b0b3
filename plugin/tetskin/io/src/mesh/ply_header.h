// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::io {

/// A property of an element: one number per instance, or a list of numbers.
struct PlyProperty {
  std::string_view name;
  NumberType type;
  NumberType countType;  ///< of a list: type of its length
  bool isList = false;
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t line = 0;  ///< line number in the header

  /// Index of the first property that has one of these names and is, or is not, a list; properties.size() if there is
  /// none.
  std::size_t find(std::initializer_list<std::string_view> names, bool list = false) const;
};

/// The contents of a PLY file as its header states them. Its names are views into the text.
struct PlyHeader {
  bool binary = false;
  ByteOrder order = ByteOrder::Little;
  std::vector<PlyElement> elements;
};

/// Reads a header from the beginning of a file, including its last line break. Errors: UnsupportedFormat, Malformed
Result<PlyHeader> readPlyHeader(const std::string& path, TextScanner& in);

}  // namespace tetskin::io
