// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   RFC 2397, "The data URL scheme", 1998; RFC 4648, "The Base16, Base32, and Base64 Data Encodings", 2006
#include <tetskin/io/src/mesh/gltf_uri.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace tetskin::io {

namespace fs = std::filesystem;

namespace {

/// 0 to 15; -1 for any other character.
int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percentDecoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code = text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
    decoded += code ? static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i];
    if (code) i += 2;
  }
  return decoded;
}

/// False if a character is not a base64 digit.
bool base64Decoded(std::string_view text, std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint32_t bits = 0;
  int known = 0;
  bytes.reserve(text.size() / 4 * 3);
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = kDigits.find(c);
    if (digit == kDigits.npos) return false;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    known += 6;
    if (known < 8) continue;
    known -= 8;
    bytes += static_cast<char>(bits >> known & 0xFF);
  }
  return true;
}

/// data:[media type][;base64],data
Result<std::string> decodeData(const std::string& path, std::string_view uri) {
  const std::size_t comma = std::min(uri.find(','), uri.size());
  const std::string_view kind = uri.substr(0, comma), data = uri.substr(std::min(comma + 1, uri.size()));
  constexpr std::string_view kBase64 = ";base64";
  if (kind.size() < kBase64.size() || kind.substr(kind.size() - kBase64.size()) != kBase64) return percentDecoded(data);
  std::string bytes;
  if (base64Decoded(data, bytes)) return bytes;
  return fileError(StatusCode::Malformed, path, 0, "has data that are not in base 64; export the model again");
}

bool isBelow(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

Result<std::string> readUri(const std::string& path, const std::string& uri) {
  if (uri.compare(0, 5, "data:") == 0) return decodeData(path, uri);
  std::string name = percentDecoded(uri);
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path relative = fs::u8path(name).lexically_normal();
  const Status elsewhere = fileError(StatusCode::UnsupportedFormat, path, 0,
                                     "refers to " + excerpt(name) +
                                         ", which is not in its folder; copy the data there, or save the model as one "
                                         "file (.glb)");
  const bool named = !name.empty() && name.find_first_of(std::string_view(":\0", 2)) == name.npos;
  if (!named || relative.has_root_path() || *relative.begin() == "..") return elsewhere;
  std::error_code failed;
  const fs::path parent = fs::path(path).parent_path();
  const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent, failed);
  const fs::path file = failed ? fs::path() : fs::canonical(folder / relative, failed);
  if (failed || !fs::is_regular_file(file, failed)) {
    return fileError(StatusCode::FileNotFound, path, 0,
                     "refers to " + excerpt(name) + ", which is not there; copy it beside the file");
  }
  return isBelow(file, folder) ? readFile(file.string()) : elsewhere;
}

}  // namespace tetskin::io
