// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "APPNOTE.TXT - .ZIP File Format Specification", PKWARE
#include <tetskin/io/src/mesh/zip_entries.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tetskin::io {

namespace {

/// Signatures and sizes of the local header, the entry in the directory, and the end of it: PKWARE's APPNOTE, 4.3.
constexpr std::uint32_t kLocalMark = 0x04034B50, kEntryMark = 0x02014B50, kEndMark = 0x06054B50;
/// Without names and extras.
constexpr std::size_t kLocalBytes = 30, kEntryBytes = 46, kEndBytes = 22;

/// A packed file.
struct Entry {
  std::string_view name, data;
  std::uint32_t method = 0, checksum = 0, size = 0;
};

std::uint64_t at(std::string_view bytes, std::size_t offset, std::size_t width) {
  assert(offset + width <= bytes.size());
  return bitsAt(&bytes[offset], width, ByteOrder::Little);
}

void append(std::uint64_t number, std::size_t width, std::string& bytes) {
  assert(width <= 8);
  for (std::size_t i = 0; i < width; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFF);
}

bool endsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// The size and the packed size of an entry, and where it begins: in 32 bits, or in the field of the extras with number
/// 1 if these are all ones.
struct Extent {
  std::uint64_t size = 0, packed = 0, offset = 0;
};
std::optional<Extent> extentOf(std::string_view entry, std::string_view extras) {
  Extent extent{at(entry, 24, 4), at(entry, 20, 4), at(entry, 42, 4)};
  std::string_view wide;
  while (extras.size() >= 4) {
    const std::size_t length = std::min<std::size_t>(at(extras, 2, 2), extras.size() - 4);
    if (at(extras, 0, 2) == 1) wide = extras.substr(4, length);
    extras.remove_prefix(4 + length);
  }
  for (std::uint64_t* number : {&extent.size, &extent.packed, &extent.offset}) {
    if (*number != 0xFFFFFFFF) continue;
    if (wide.size() < 8) return {};
    *number = at(wide, 0, 8);
    wide.remove_prefix(8);
  }
  return extent;
}

/// Reads the entry at the front of the list of contents, and removes it there.
std::optional<Entry> nextEntry(std::string_view bytes, std::string_view& list) {
  if (list.size() < kEntryBytes || at(list, 0, 4) != kEntryMark) return {};
  const std::size_t nameBytes = at(list, 28, 2), extraBytes = at(list, 30, 2), commentBytes = at(list, 32, 2);
  if (list.size() - kEntryBytes < nameBytes + extraBytes + commentBytes) return {};
  Entry entry;
  entry.name = list.substr(kEntryBytes, nameBytes);
  entry.method = static_cast<std::uint32_t>(at(list, 10, 2));
  entry.checksum = static_cast<std::uint32_t>(at(list, 16, 4));
  const std::optional<Extent> extent = extentOf(list, list.substr(kEntryBytes + nameBytes, extraBytes));
  list.remove_prefix(kEntryBytes + nameBytes + extraBytes + commentBytes);
  if (!extent || extent->size > 0xFFFFFFFE || extent->offset > bytes.size()) return {};
  entry.size = static_cast<std::uint32_t>(extent->size);
  const std::string_view local = bytes.substr(static_cast<std::size_t>(extent->offset));
  if (local.size() < kLocalBytes || at(local, 0, 4) != kLocalMark) return {};
  const std::size_t begin = kLocalBytes + at(local, 26, 2) + at(local, 28, 2);
  if (local.size() < begin || local.size() - begin < extent->packed) return {};
  entry.data = local.substr(begin, static_cast<std::size_t>(extent->packed));
  return entry;
}

/// What the header in front of an entry's data and its line in the list of contents have in common.
void appendCommon(const Entry& entry, std::string& bytes) {
  append(20, 2, bytes);  // version
  append(0, 2, bytes);   // flags
  append(entry.method, 2, bytes);
  append(0x00210000, 4, bytes);  // time
  append(entry.checksum, 4, bytes);
  append(entry.data.size(), 4, bytes);
  append(entry.size, 4, bytes);
  append(entry.name.size(), 2, bytes);
  append(0, 2, bytes);  // extras
}

/// Adds an entry to a package and to its list of contents.
void appendEntry(const Entry& entry, std::string& bytes, std::string& list) {
  append(kEntryMark, 4, list);
  append(20, 2, list);
  appendCommon(entry, list);
  list.append(10, '\0');  // comment, disk, attributes
  append(bytes.size(), 4, list);
  list += entry.name;
  append(kLocalMark, 4, bytes);
  appendCommon(entry, bytes);
  bytes += entry.name;
  bytes += entry.data;
}

}  // namespace

Result<Models3mf> modelsOf3mf(const std::string& path, const std::string& bytes) {
  const std::string endMark = "PK\5\6";
  const std::size_t end = bytes.rfind(endMark);
  const Status damaged =
      fileError(StatusCode::Malformed, path, 0, "is no complete package of 3MF, a ZIP file; save it again");
  if (end == bytes.npos || bytes.size() - end < kEndBytes) return damaged;
  const std::uint64_t first = at(bytes, end + 16, 4), count = at(bytes, end + 10, 2);
  if (first > end) return damaged;
  std::string_view list = std::string_view(bytes).substr(static_cast<std::size_t>(first), end - first);
  Models3mf models;
  std::string newList;
  std::size_t kept = 0;
  for (std::uint64_t e = 0; e < count; ++e) {
    const std::optional<Entry> entry = nextEntry(bytes, list);
    if (!entry) return damaged;
    const bool model = endsWith(entry->name, ".model");
    if (!model && !endsWith(entry->name, ".rels") && entry->name != "[Content_Types].xml") continue;
    appendEntry(*entry, models.bytes, newList);
    models.count += model;
    ++kept;
  }
  const std::size_t listAt = models.bytes.size();
  models.bytes += newList;
  append(kEndMark, 4, models.bytes);
  append(0, 4, models.bytes);  // disks
  append(kept, 2, models.bytes);
  append(kept, 2, models.bytes);
  append(newList.size(), 4, models.bytes);
  append(listAt, 4, models.bytes);
  append(0, 2, models.bytes);  // comment
  return models;
}

}  // namespace tetskin::io
