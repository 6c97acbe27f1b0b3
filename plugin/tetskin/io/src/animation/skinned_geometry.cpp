// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/animation/skinned_geometry.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <map>

namespace tetskin::io {
namespace {

/// Four bones, none of them twice, and weights in GLB form: none negative, a sum of 1, and bone 0 where the weight is
/// 0.
struct VertexBones {
  std::array<std::size_t, 4> nodes{};
  std::array<float, 4> weights{};
};

VertexBones bonesAt(const Embedding& embedding, std::size_t vertex) {
  const EmbeddedPoint<double> point = embedding.at(vertex);
  VertexBones bones;
  std::array<double, 4> clamped{};
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) sum += clamped[k] = std::max(0.0, point.clampedWeights[k]);
  assert(sum > 0.0);
  float rest = 1.0f;  // the largest weight makes the sum exactly 1 in float
  const auto largest = static_cast<std::size_t>(std::max_element(clamped.begin(), clamped.end()) - clamped.begin());
  for (std::size_t k = 0; k < 4; ++k) {
    bones.nodes[k] = static_cast<std::size_t>(point.nodes[k]);
    bones.weights[k] = static_cast<float>(clamped[k] / sum);
    if (k != largest) rest -= bones.weights[k];
  }
  bones.weights[largest] = rest;
  return bones;
}

/// The number of bytes that follow the first byte of a character, and the range of the second; 4 if it is not a first
/// byte.
std::size_t bytesAfter(unsigned char first, unsigned char& least, unsigned char& most) {
  least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;  // no longer than needed
  most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;   // not a surrogate, nor beyond Unicode
  if (first < 0x80) return 0;
  if (first < 0xC2 || first > 0xF4) return 4;
  return first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
}

bool isUtf8(const std::string& text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned char least = 0, most = 0;
    const std::size_t following = bytesAfter(static_cast<unsigned char>(text[at]), least, most);
    if (following == 4 || at + following >= text.size()) return false;
    for (std::size_t k = 0; k < following; ++k) {
      const auto byte = static_cast<unsigned char>(text[++at]);
      if (byte < least || byte > most) return false;
      least = 0x80;
      most = 0xBF;
    }
  }
  return true;
}

std::vector<GlbPart> partsOf(const TriangleMesh& mesh, const MaterialNumber& materialNumber) {
  std::map<std::size_t, GlbPart> parts;
  const auto append = [&](const std::string& material, std::size_t first, std::size_t count) {
    GlbPart& part = parts[materialNumber(material, !mesh.texcoords.empty())];
    for (std::size_t t = first; t < first + count; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      if (a == b || b == c || c == a) continue;
      for (const int vertex : {a, b, c}) part.corners.push_back(static_cast<std::uint32_t>(vertex));
    }
  };
  for (const TriangleGroup& group : mesh.groups) append(group.material, group.firstTriangle, group.triangleCount);
  if (mesh.groups.empty()) append("", 0, mesh.triangleCount());
  std::vector<GlbPart> list;
  for (auto& [material, part] : parts) {
    part.material = material;
    if (!part.corners.empty()) list.push_back(std::move(part));
  }
  return list;
}

void appendVector(const Eigen::Vector3d& vector, std::vector<float>& numbers) {
  for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(vector[k]));
}

std::vector<float> normalsOf(const TriangleMesh& mesh) {
  std::vector<float> numbers;
  numbers.reserve(3 * mesh.vertexCount());
  for (const Eigen::Vector3d& normal : restNormals(mesh)) appendVector(normal, numbers);
  return numbers;
}

/// The point of the tet at these weights, at rest.
Eigen::Vector3d restPoint(const Cage& cage, const VertexBones& bones) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto weight = static_cast<double>(bones.weights[k]);
    sum += weight * cage.mesh.nodes[bones.nodes[k]];
    total += weight;
  }
  return sum / total;
}

GlbMesh geometryWithoutPositions(const std::string& name, const TriangleMesh& mesh,
                                 const MaterialNumber& materialNumber) {
  GlbMesh made;
  made.name = name;
  made.parts = partsOf(mesh, materialNumber);
  for (const Eigen::Vector2f& uv : mesh.texcoords) {
    made.texcoords.push_back(uv.x());
    made.texcoords.push_back(1.0f - uv.y());
  }
  return made;
}

}  // namespace

GlbMesh rigidGeometry(const std::string& name, const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                      const MaterialNumber& materialNumber) {
  GlbMesh made = geometryWithoutPositions(name, mesh, materialNumber);
  for (const Eigen::Vector3d& p : mesh.positions) appendVector(p - origin, made.positions);
  return made;
}

GlbMesh skinnedGeometry(const std::string& name, const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding,
                        Interpolation interpolation, const std::vector<std::size_t>& bones,
                        const Eigen::Vector3d& origin, const MaterialNumber& materialNumber) {
  assert(embedding.vertexCount() == mesh.vertexCount());
  GlbMesh made = geometryWithoutPositions(name, mesh, materialNumber);
  std::vector<std::uint16_t> jointOf(cage.mesh.nodeCount(), 0);
  for (std::size_t j = 0; j < bones.size(); ++j) jointOf[bones[j]] = static_cast<std::uint16_t>(j);
  const bool quadratic = interpolation == Interpolation::Quadratic;
  if (quadratic) made.normals = normalsOf(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const VertexBones vertex = bonesAt(embedding, v);
    for (std::size_t k = 0; k < 4; ++k) {
      made.joints.push_back(vertex.weights[k] > 0.0f ? jointOf[vertex.nodes[k]] : std::uint16_t{0});
      made.weights.push_back(vertex.weights[k]);
    }
    Eigen::Vector3d position = mesh.positions[v];
    // Half of the distance to the tet would come from the nodes' positions, and is 0; so the half from their gradients
    // gets twice the distance, and the gradient itself continues the surface.
    if (quadratic && !embedding.at(v).inside) position += position - restPoint(cage, vertex);
    appendVector(position - origin, made.positions);
  }
  for (const std::size_t node : bones) {
    const Eigen::Vector3d rest = cage.mesh.nodes[node] - origin;
    made.inverseBinds.insert(made.inverseBinds.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    appendVector(-rest, made.inverseBinds);
    made.inverseBinds.push_back(1.0f);
  }
  return made;
}

std::vector<std::size_t> bonesOf(const Embedding& embedding) {
  std::vector<bool> used(embedding.nodeCount(), false);
  for (std::size_t v = 0; v < embedding.vertexCount(); ++v) {
    const VertexBones vertex = bonesAt(embedding, v);
    for (std::size_t k = 0; k < 4; ++k) {
      if (vertex.weights[k] > 0.0f) used[vertex.nodes[k]] = true;
    }
  }
  std::vector<std::size_t> bones;
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (used[n]) bones.push_back(n);
  }
  return bones;
}

std::string asUtf8(std::string name) {
  if (isUtf8(name)) return name;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  }
  return name;
}

}  // namespace tetskin::io
