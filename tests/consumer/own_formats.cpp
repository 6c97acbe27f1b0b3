// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A program that reads files with an installation made without assimp: an OBJ, and not a 3DS or FBX, whose refusal
// names the format and the option.
#include <tetskin/io/files.h>

#include <cstdio>
#include <fstream>
#include <string>

tetskin::Result<tetskin::TriangleMesh> load(const std::string& name) {
  std::ofstream(name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  return tetskin::loadMesh(name);
}

int main() {
  if (load("own.obj").value().triangleCount() != 1) return 1;
  for (const std::string format : {".3ds", ".fbx"}) {
    const auto mesh = load("foreign" + format);
    std::puts(mesh.status().message.c_str());
    if (mesh.status().code != tetskin::StatusCode::UnsupportedFormat) return 1;
    for (const std::string& word : {format, std::string("TETSKIN_ASSIMP=OFF")}) {
      if (mesh.status().message.find(word) == std::string::npos) return 1;
    }
  }
  return 0;
}
