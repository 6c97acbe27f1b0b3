// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/joined_mesh.h"

namespace tetskin::scenes {
namespace {

void appendGroups(const TriangleMesh& part, TriangleMesh& whole, const std::string& name) {
  const std::size_t before = whole.triangleCount();
  if (part.groups.empty()) whole.groups.push_back({name, "", before, part.triangleCount()});
  for (const TriangleGroup& group : part.groups) {
    const std::string& called = name.empty() ? group.name : name;
    whole.groups.push_back({called, group.material, before + group.firstTriangle, group.triangleCount});
  }
}

template <class List>
void appendAll(const List& part, List& whole) {
  whole.insert(whole.end(), part.begin(), part.end());
}

}  // namespace

std::size_t append(const TriangleMesh& part, TriangleMesh& whole, const std::string& name) {
  const std::size_t first = whole.vertexCount();
  const bool textured = part.texcoords.size() == part.vertexCount() && whole.texcoords.size() == first;
  appendGroups(part, whole, name);
  appendAll(part.positions, whole.positions);
  if (textured) appendAll(part.texcoords, whole.texcoords);
  if (!textured) whole.texcoords.clear();
  const int shift = static_cast<int>(first);
  for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({a + shift, b + shift, c + shift});
  return first;
}

}  // namespace tetskin::scenes
