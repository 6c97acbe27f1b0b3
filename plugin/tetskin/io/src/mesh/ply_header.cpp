// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Greg Turk, "The PLY Polygon File Format", 1994
#include <tetskin/io/src/mesh/ply_header.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>

namespace tetskin::io {

namespace {

class HeaderReader {
 public:
  HeaderReader(const std::string& path, TextScanner& in) : path_(path), in_(in) {}
  Result<PlyHeader> read();

 private:
  Status readLine(TextScanner& line, bool& ended);
  Status readFormat(TextScanner& line);
  Status readElement(TextScanner& line);
  Status readProperty(TextScanner& line);
  Status readType(TextScanner& line, NumberType& type);
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, lineNumber_, what); }

  const std::string& path_;
  TextScanner& in_;
  std::size_t lineNumber_ = 1;
  bool hasFormat_ = false;
  PlyHeader header_;
};

Result<PlyHeader> HeaderReader::read() {
  TextScanner first(in_.restOfLine());
  const std::string_view mark = first.word();
  if (mark != "ply" && mark != "PLY") {
    return error(StatusCode::Malformed, "does not begin with a line 'ply'; is it a PLY model?");
  }
  for (bool ended = false; !ended;) {
    if (in_.remaining() == 0) {
      return error(StatusCode::Malformed, "ends before 'end_header'; is it complete? Save it again");
    }
    lineNumber_ = in_.line();
    TextScanner line(in_.restOfLine(), lineNumber_);
    Status status = readLine(line, ended);
    if (!status.ok()) return status;
  }
  if (hasFormat_) return std::move(header_);
  return error(StatusCode::Malformed, "has no 'format' in its header; add 'format ascii 1.0', or save it again");
}

Status HeaderReader::readLine(TextScanner& line, bool& ended) {
  const std::string_view keyword = line.word();
  ended = keyword == "end_header";
  if (keyword == "format") return readFormat(line);
  if (keyword == "element") return readElement(line);
  if (keyword == "property") return readProperty(line);
  if (ended || keyword.empty() || keyword == "comment" || keyword == "obj_info") return {};
  if (header_.elements.empty()) return {};  // here old versions of Blender state who wrote the file
  return error(StatusCode::Malformed, "has " + excerpt(keyword) + " in its header; correct the line, or remove it");
}

Status HeaderReader::readFormat(TextScanner& line) {
  const std::string_view kind = line.word();
  header_.binary = kind != "ascii";
  header_.order = kind == "binary_big_endian" ? ByteOrder::Big : ByteOrder::Little;
  hasFormat_ = true;
  if (!header_.binary || kind == "binary_big_endian" || kind == "binary_little_endian") return {};
  return error(StatusCode::UnsupportedFormat,
               "has format " + excerpt(kind) + ", which is not supported; save it as ascii");
}

Status HeaderReader::readElement(TextScanner& line) {
  PlyElement element;
  element.name = line.word();
  element.line = lineNumber_;
  const std::string_view count = line.word();
  if (!parseInteger(count, element.count)) {
    return error(StatusCode::Malformed,
                 "has " + excerpt(count) + " as the number of " + excerpt(element.name) + "; correct the header");
  }
  header_.elements.push_back(std::move(element));
  return {};
}

Status HeaderReader::readProperty(TextScanner& line) {
  if (header_.elements.empty()) {
    return error(StatusCode::Malformed, "has a property before its first element; correct the header");
  }
  PlyProperty property;
  TextScanner ahead = line;
  property.isList = ahead.word() == "list";
  Status status;
  if (property.isList) {
    line = ahead;
    status = readType(line, property.countType);
  }
  if (status.ok()) status = readType(line, property.type);
  if (!status.ok()) return status;
  property.name = line.word();
  header_.elements.back().properties.push_back(property);
  return {};
}

Status HeaderReader::readType(TextScanner& line, NumberType& type) {
  const std::string_view name = line.word();
  type = plyNumberType(name);
  if (type.bytes > 0) return {};
  return error(StatusCode::UnsupportedFormat,
               "has a property of type " + excerpt(name) + ", which is not supported; save it with float and int");
}

}  // namespace

std::size_t PlyElement::find(std::initializer_list<std::string_view> names, bool list) const {
  const auto found = std::find_if(properties.begin(), properties.end(), [&](const PlyProperty& property) {
    return property.isList == list && std::find(names.begin(), names.end(), property.name) != names.end();
  });
  return static_cast<std::size_t>(found - properties.begin());
}

Result<PlyHeader> readPlyHeader(const std::string& path, TextScanner& in) {
  assert(in.line() == 1);
  return HeaderReader(path, in).read();
}

}  // namespace tetskin::io
