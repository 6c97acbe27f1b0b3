// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The meshes of a glTF 2.0 scene. tinygltf only parses the text. Buffers are read here, so tinygltf opens no file,
// decodes no image, and need not check what a document states against its actual content.
//
// This work is based on:
//   "glTF 2.0 Specification", Khronos Group, 2021
#include <tetskin/io/src/mesh/gltf_accessors.h>
#include <tetskin/io/src/mesh/gltf_text.h>
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/mesh/scene_mesh.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/file_text.h>

#include <tiny_gltf.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace tetskin::io {

namespace {

/// Extensions about looks: the shape is complete without them.
constexpr std::array<std::string_view, 9> kLooks = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                    "MSFT_texture_",  "KHR_lights_",  "EXT_lights_",
                                                    "KHR_xmp",        "AGI_",         "KHR_technique"};

bool isSupported(const std::string& extension) {
  const auto begins = [&](std::string_view prefix) { return extension.compare(0, prefix.size(), prefix) == 0; };
  return extension == "KHR_mesh_quantization" || std::any_of(kLooks.begin(), kLooks.end(), begins);
}

class GltfReader {
 public:
  /// map  null: none
  GltfReader(const std::string& path, const tinygltf::Model& model, const std::optional<std::string>& binaryChunk,
             MapRequest* map)
      : path_(path), model_(model), accessors_(path, model, binaryChunk), map_(map) {}
  Result<TriangleMesh> read();

 private:
  /// The accessors of a primitive's vertices, -1 for none; primitives with the same accessors share vertices.
  using Vertices = std::array<int, 3>;
  /// The wanted map of a part's vertices.
  struct PartMap {
    int accessor = -1;  ///< -1: it has none
    std::vector<double> values;
  };
  struct Visit {
    int node = 0;
    Eigen::Affine3d toParent = Eigen::Affine3d::Identity();  ///< from the parent's space to the scene's
  };

  std::vector<int> roots() const;
  Status visit(const Visit& visit);
  Status placeOf(int node, Eigen::Affine3d& place) const;
  Status addMesh(int mesh, const std::string& nodeName, bool skinned, const Eigen::Affine3d& toScene);
  Status addVertices(const Vertices& vertices, const Eigen::Affine3d& toScene, ScenePart& part);
  Status addTriangles(const tinygltf::Primitive& primitive, bool mirrored, ScenePart& part);
  Status addMap(const tinygltf::Primitive& primitive, std::size_t vertices, PartMap& map);
  std::string materialOf(const tinygltf::Primitive& primitive) const;

  const std::string& path_;
  const tinygltf::Model& model_;
  GltfAccessors accessors_;
  MapRequest* map_;
  std::vector<Visit> stack_;
  std::vector<bool> visited_;  ///< by node
  std::vector<ScenePart> parts_;
  std::vector<PartMap> maps_;  ///< by part
};

/// The root nodes of the displayed scene, which is the first one by default; without any scene, all nodes that are not
/// children.
std::vector<int> GltfReader::roots() const {
  const std::size_t shown = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
  if (shown < model_.scenes.size()) return model_.scenes[shown].nodes;
  std::vector<bool> isChild(model_.nodes.size(), false);
  for (const tinygltf::Node& node : model_.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < isChild.size())
        isChild[static_cast<std::size_t>(child)] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t n = 0; n < isChild.size(); ++n) {
    if (!isChild[n]) roots.push_back(static_cast<int>(n));
  }
  return roots;
}

Result<TriangleMesh> GltfReader::read() {
  visited_.assign(model_.nodes.size(), false);
  const std::vector<int> first = roots();
  for (auto root = first.rbegin(); root != first.rend(); ++root) stack_.push_back({*root});
  while (!stack_.empty()) {
    const Visit next = stack_.back();
    stack_.pop_back();
    if (Status status = visit(next); !status.ok()) return status;
  }
  if (map_) {
    for (const PartMap& map : maps_) map_->values.insert(map_->values.end(), map.values.begin(), map.values.end());
  }
  return joinParts(path_, parts_);
}

/// Adds the mesh of a node; its children are visited next, in their order.
Status GltfReader::visit(const Visit& visit) {
  const auto n = static_cast<std::size_t>(visit.node);
  if (visit.node < 0 || n >= model_.nodes.size()) {
    return accessors_.error(StatusCode::IndexOutOfRange, "refers to node " + std::to_string(visit.node) + " of " +
                                                             std::to_string(model_.nodes.size()));
  }
  if (visited_[n]) {
    return accessors_.error(StatusCode::Malformed, "has node " + std::to_string(n) + " in two places of its scene");
  }
  visited_[n] = true;
  const tinygltf::Node& node = model_.nodes[n];
  Eigen::Affine3d place;
  if (Status status = placeOf(visit.node, place); !status.ok()) return status;
  const Eigen::Affine3d toScene = visit.toParent * place;
  for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) stack_.push_back({*child, toScene});
  return node.mesh < 0 ? Status() : addMesh(node.mesh, node.name, node.skin >= 0, toScene);
}

Status GltfReader::placeOf(int n, Eigen::Affine3d& place) const {
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(n)];
  const auto is = [](const std::vector<double>& numbers, std::size_t count) {
    return numbers.empty() || numbers.size() == count;
  };
  if (!is(node.matrix, 16) || !is(node.translation, 3) || !is(node.rotation, 4) || !is(node.scale, 3)) {
    return accessors_.error(StatusCode::Malformed,
                            "has the wrong number of values in the transform of node " + std::to_string(n));
  }
  place.setIdentity();
  if (!node.matrix.empty()) {
    place.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    place.makeAffine();
    return {};
  }
  if (!node.translation.empty()) place.translation() = Eigen::Map<const Eigen::Vector3d>(node.translation.data());
  if (!node.rotation.empty()) {
    const Eigen::Map<const Eigen::Quaterniond> rotation(node.rotation.data());  // x, y, z, w, as Eigen has them
    if (rotation.squaredNorm() > 0.0) place.linear() = rotation.normalized().toRotationMatrix();
  }
  if (!node.scale.empty()) {
    place.linear() = place.linear() * Eigen::Map<const Eigen::Vector3d>(node.scale.data()).asDiagonal();
  }
  return {};
}

Status GltfReader::addMesh(int m, const std::string& nodeName, bool skinned, const Eigen::Affine3d& toScene) {
  if (static_cast<std::size_t>(m) >= model_.meshes.size()) {
    return accessors_.error(StatusCode::IndexOutOfRange,
                            "refers to mesh " + std::to_string(m) + " of " + std::to_string(model_.meshes.size()));
  }
  const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(m)];
  std::map<Vertices, std::size_t> known;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const auto find = [&](const char* name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    const Vertices vertices = {find("POSITION"), find("NORMAL"), find("TEXCOORD_0")};
    const bool surface = primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
    if (!surface || vertices[0] < 0) continue;
    const auto [at, added] = known.emplace(vertices, parts_.size());
    if (added) {
      Status status = addVertices(vertices, toScene, parts_.emplace_back());
      if (!status.ok()) return status;
      maps_.emplace_back();
    }
    if (map_) {
      Status status = addMap(primitive, parts_[at->second].positions.size(), maps_[at->second]);
      if (!status.ok()) return status;
    }
    const auto& accessor = model_.accessors[static_cast<std::size_t>(vertices[0])];
    if (accessor.bufferView < 0 && !primitive.extensions.empty()) {
      return accessors_.needs(primitive.extensions.begin()->first);
    }
    // Integers of a skinned mesh are scaled by its bones, which are left out.
    if (skinned && accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      return fileError(StatusCode::UnsupportedFormat, path_, 0,
                       "has a mesh with bones and quantised positions, which only its bones scale; save it without "
                       "quantisation (gltfpack: with -noq)");
    }
    ScenePart& part = parts_[at->second];
    TriangleGroup group{mesh.name.empty() ? nodeName : mesh.name, materialOf(primitive), part.triangles.size(), 0};
    Status status = addTriangles(primitive, toScene.linear().determinant() < 0.0, part);
    if (!status.ok()) return status;
    group.triangleCount = part.triangles.size() - group.firstTriangle;
    part.groups.push_back(std::move(group));
  }
  return {};
}

std::string GltfReader::materialOf(const tinygltf::Primitive& primitive) const {
  const auto m = static_cast<std::size_t>(primitive.material);
  return primitive.material >= 0 && m < model_.materials.size() ? model_.materials[m].name : std::string();
}

Status GltfReader::addVertices(const Vertices& vertices, const Eigen::Affine3d& toScene, ScenePart& part) {
  std::vector<double> numbers;
  if (Status status = accessors_.read(vertices[0], 3, numbers); !status.ok()) return status;
  const std::size_t count = numbers.size() / 3;
  const auto differs = [&](std::size_t arity) {
    return numbers.size() == arity * count
               ? Status()
               : accessors_.error(StatusCode::Malformed,
                                  "has another number of normals or texture coordinates than of "
                                  "positions");
  };
  part.positions.reserve(count);
  for (std::size_t v = 0; v < count; ++v) part.positions.emplace_back(toScene * Eigen::Vector3d(&numbers[3 * v]));
  if (vertices[1] >= 0) {
    Status status = accessors_.read(vertices[1], 3, numbers);
    if (status.ok()) status = differs(3);
    if (!status.ok()) return status;
    const Eigen::Matrix3d normals = normalMatrix(toScene.linear());
    for (std::size_t v = 0; v < count; ++v)
      part.normals.push_back(unitNormal(normals * Eigen::Vector3d(&numbers[3 * v])));
  }
  if (vertices[2] < 0) return {};
  Status status = accessors_.read(vertices[2], 2, numbers);
  if (status.ok()) status = differs(2);
  if (!status.ok()) return status;
  for (std::size_t v = 0; v < count; ++v) {  // glTF's begin at the upper left
    const Eigen::Vector2d texcoord(numbers[2 * v], 1.0 - numbers[2 * v + 1]);
    part.texcoords.push_back(texcoord.allFinite() ? Eigen::Vector2f(texcoord.cast<float>()) : Eigen::Vector2f(0, 0));
  }
  return {};
}

/// Reads the wanted map of a primitive's vertices, if it has it, and notes which there are.
Status GltfReader::addMap(const tinygltf::Primitive& primitive, std::size_t vertices, PartMap& map) {
  constexpr std::array<const char*, 4> kChannels = {"red", "green", "blue", "alpha"};
  const int channel = colourChannel(map_->name);
  for (const auto& [name, index] : primitive.attributes) {
    const bool isColour = name == "COLOR_0";
    if ((!isColour && name.compare(0, 1, "_") != 0) || index < 0) continue;
    const auto at = static_cast<std::size_t>(index);
    const int type = at < model_.accessors.size() ? model_.accessors[at].type : TINYGLTF_TYPE_SCALAR;
    const int arity = !isColour ? 1 : type == TINYGLTF_TYPE_VEC4 ? 4 : 3;
    if (!isColour && type == TINYGLTF_TYPE_SCALAR) map_->present.insert(name);
    if (isColour) map_->present.insert(kChannels.begin(), kChannels.begin() + arity);
    if (isColour ? channel < 0 || channel >= arity : name != map_->name || type != TINYGLTF_TYPE_SCALAR) continue;
    if (index == map.accessor) continue;
    if (map.accessor >= 0) {
      return fileError(StatusCode::InvalidOption, path_, 0,
                       "has two maps " + excerpt(map_->name) +
                           " on the same vertices, for two of a mesh's primitives; "
                           "save it with one");
    }
    map.accessor = index;
    std::vector<double> numbers;
    if (Status status = accessors_.read(index, arity, numbers); !status.ok()) return status;
    if (numbers.size() != static_cast<std::size_t>(arity) * vertices) {
      return accessors_.error(StatusCode::Malformed,
                              "has another number of values in " + excerpt(name) + " than of positions");
    }
    for (std::size_t v = 0; v < vertices; ++v)
      map.values.push_back(
          numbers[static_cast<std::size_t>(arity) * v + static_cast<std::size_t>(std::max(channel, 0))]);
  }
  return {};
}

/// Appends the triangles of a list, a strip (every second triangle is turned over) or a fan.
Status GltfReader::addTriangles(const tinygltf::Primitive& primitive, bool mirrored, ScenePart& part) {
  const std::size_t vertexCount = part.positions.size();
  std::vector<int> corners;
  if (primitive.indices < 0) {
    for (std::size_t v = 0; v < vertexCount; ++v) corners.push_back(static_cast<int>(v));
  } else {
    std::vector<double> numbers;
    if (Status status = accessors_.read(primitive.indices, 1, numbers); !status.ok()) return status;
    for (const double number : numbers) {
      if (!(number >= 0.0 && number < static_cast<double>(vertexCount))) {
        return accessors_.error(StatusCode::IndexOutOfRange, "has a triangle with vertex " +
                                                                 std::to_string(static_cast<long long>(number)) +
                                                                 " of " + std::to_string(vertexCount));
      }
      corners.push_back(static_cast<int>(number));
    }
  }
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES, fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  for (std::size_t i = 0; i + 2 < corners.size(); i += list ? 3 : 1) {
    std::array<int, 3> triangle = {corners[fan ? 0 : i], corners[i + 1], corners[i + 2]};
    const bool turned = !list && !fan && i % 2 == 1;
    if (turned != mirrored) std::swap(triangle[1], triangle[2]);
    // Strips repeat vertices where they turn.
    const bool flat = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (list || !flat) part.triangles.push_back(triangle);
  }
  return {};
}

Result<TriangleMesh> parse(const std::string& path, MapRequest* map) {
  Result<std::string> bytes = readFile(path);
  if (!bytes.ok()) return bytes.status();
  Result<GltfText> split = splitGltf(path, std::move(bytes).value());
  if (!split.ok()) return split.status();
  GltfText& text = split.value();
  if (text.json.size() > std::numeric_limits<unsigned>::max()) {
    return fileError(StatusCode::TooLarge, path, 0, "has 4 GB of text or more; save it as GLB");
  }
  if (Status status = keepShape(path, text); !status.ok()) return status;
  if (text.firstVersion) {
    return fileError(StatusCode::UnsupportedFormat, path, 0,
                     "is glTF 1.0, which is not supported; save it as glTF 2.0");
  }
  tinygltf::Model model;
  tinygltf::TinyGLTF parser;
  std::string errors, warnings;
  const bool parsed = parser.LoadASCIIFromString(&model, &errors, &warnings, text.json.data(),
                                                 static_cast<unsigned>(text.json.size()), "", tinygltf::NO_REQUIRE);
  const GltfAccessors words(path, model, text.binary);
  for (const std::string& extension : model.extensionsRequired) {
    if (!isSupported(extension)) return words.needs(extension);
  }
  if (!parsed) {
    return words.error(StatusCode::Malformed, "cannot be read: " + excerpt(errors.substr(0, errors.find('\n')), 200));
  }
  return GltfReader(path, model, text.binary, map).read();
}

}  // namespace

Result<TriangleMesh> readGltf(const std::string& path, MapRequest* map) {
  try {
    return parse(path, map);
  } catch (const std::exception& error) {
    return fileError(StatusCode::Malformed, path, 0,
                     "cannot be read: " + std::string(error.what()) + "; export the model again");
  }
}

}  // namespace tetskin::io
