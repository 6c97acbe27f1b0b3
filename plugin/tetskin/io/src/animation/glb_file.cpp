// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene as binary glTF 2.0, by tinygltf.
#include <tetskin/io/src/animation/glb_scene.h>

#include <tiny_gltf.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <sstream>
#include <utility>

namespace tetskin::io {
namespace {

/// Arrays of one element type, and their locations: all accessors of a kind share a view.
class GlbBuffer {
 public:
  explicit GlbBuffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  /// A view that the following accessors belong to.
  /// target  0: neither vertices nor indices
  void beginView(int target) {
    align();
    tinygltf::BufferView& view = model_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = bytes().size();
    view.target = target;
  }
  /// Adds a view of plain bytes. Returns its number.
  int addView(const std::vector<unsigned char>& plain) {
    beginView(0);
    bytes().insert(bytes().end(), plain.begin(), plain.end());
    model_.bufferViews.back().byteLength = plain.size();
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }
  /// Adds an accessor of `arity` numbers per element.
  /// bounded  states the smallest and the largest values
  template <class Number>
  int add(const std::vector<Number>& numbers, int arity, int type, bool bounded = false) {
    assert(!numbers.empty() && numbers.size() % static_cast<std::size_t>(arity) == 0);
    align();
    tinygltf::BufferView& view = model_.bufferViews.back();
    tinygltf::Accessor& accessor = model_.accessors.emplace_back();
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.byteOffset = bytes().size() - view.byteOffset;
    accessor.componentType = componentOf(numbers);
    accessor.count = numbers.size() / static_cast<std::size_t>(arity);
    accessor.type = type;
    if (bounded) bound(numbers, static_cast<std::size_t>(arity), accessor);
    const std::size_t at = bytes().size();
    bytes().resize(at + numbers.size() * sizeof(Number));
    std::memcpy(bytes().data() + at, numbers.data(), numbers.size() * sizeof(Number));
    view.byteLength = bytes().size() - view.byteOffset;
    return static_cast<int>(model_.accessors.size()) - 1;
  }

 private:
  static int componentOf(const std::vector<float>&) { return TINYGLTF_COMPONENT_TYPE_FLOAT; }
  static int componentOf(const std::vector<std::uint16_t>&) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT; }
  static int componentOf(const std::vector<std::uint32_t>&) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT; }

  template <class Number>
  static void bound(const std::vector<Number>& numbers, std::size_t arity, tinygltf::Accessor& accessor) {
    accessor.minValues.assign(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(arity));
    accessor.maxValues = accessor.minValues;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto value = static_cast<double>(numbers[i]);
      accessor.minValues[i % arity] = std::min(accessor.minValues[i % arity], value);
      accessor.maxValues[i % arity] = std::max(accessor.maxValues[i % arity], value);
    }
  }
  std::vector<unsigned char>& bytes() { return model_.buffers.front().data; }
  void align() { bytes().resize((bytes().size() + 3) / 4 * 4); }

  tinygltf::Model& model_;
};

double linearOf(float srgb) {
  const auto x = static_cast<double>(srgb);
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

/// The one texture, a white pixel as PNG. Returns its number.
int addWhiteTexture(tinygltf::Model& model, GlbBuffer& buffer) {
  static const std::vector<unsigned char> kPng = {
      0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3A, 0x7E, 0x9B, 0x55, 0x00,
      0x00, 0x00, 0x0A, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0xF8, 0x0F, 0x00, 0x01, 0x01, 0x01, 0x00,
      0x1C, 0xB0, 0x8C, 0x99, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
  tinygltf::Image& image = model.images.emplace_back();
  image.bufferView = buffer.addView(kPng);
  image.mimeType = "image/png";
  model.textures.emplace_back().source = 0;
  return 0;
}

/// texture  of materials that have one
void addMaterial(const GlbMaterial& material, int texture, tinygltf::Model& model) {
  tinygltf::Material& made = model.materials.emplace_back();
  made.name = material.name;
  made.pbrMetallicRoughness.baseColorFactor = {linearOf(material.colour.x()), linearOf(material.colour.y()),
                                               linearOf(material.colour.z()), static_cast<double>(material.opacity)};
  made.pbrMetallicRoughness.metallicFactor = 0.0;
  made.pbrMetallicRoughness.roughnessFactor = static_cast<double>(material.roughness);
  if (material.opacity < 1.0f) made.alphaMode = "BLEND";
  if (material.textured) made.pbrMetallicRoughness.baseColorTexture.index = texture;
}

/// Uses 16 bits if the largest vertex fits, below the index that restarts a strip.
int addIndices(const std::vector<std::uint32_t>& corners, GlbBuffer& buffer) {
  constexpr std::uint32_t kRestart = 0xFFFF;
  if (*std::max_element(corners.begin(), corners.end()) >= kRestart) {
    return buffer.add(corners, 1, TINYGLTF_TYPE_SCALAR);
  }
  return buffer.add(std::vector<std::uint16_t>(corners.begin(), corners.end()), 1, TINYGLTF_TYPE_SCALAR);
}

void addMesh(const GlbMesh& mesh, tinygltf::Model& model, GlbBuffer& buffer) {
  std::map<std::string, int> attributes;
  const auto attribute = [&](const char* name, const auto& numbers, int arity, int type) {
    if (numbers.empty()) return;
    buffer.beginView(TINYGLTF_TARGET_ARRAY_BUFFER);
    attributes[name] = buffer.add(numbers, arity, type, arity == 3);
  };
  attribute("POSITION", mesh.positions, 3, TINYGLTF_TYPE_VEC3);
  attribute("NORMAL", mesh.normals, 3, TINYGLTF_TYPE_VEC3);
  attribute("TEXCOORD_0", mesh.texcoords, 2, TINYGLTF_TYPE_VEC2);
  attribute("JOINTS_0", mesh.joints, 4, TINYGLTF_TYPE_VEC4);
  attribute("WEIGHTS_0", mesh.weights, 4, TINYGLTF_TYPE_VEC4);
  tinygltf::Mesh& made = model.meshes.emplace_back();
  made.name = mesh.name;
  for (const GlbPart& part : mesh.parts) {
    buffer.beginView(TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Primitive& primitive = made.primitives.emplace_back();
    primitive.attributes = attributes;
    primitive.indices = addIndices(part.corners, buffer);
    primitive.material = static_cast<int>(part.material);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
  }
}

std::vector<int> asInts(const std::vector<std::size_t>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// The values of the first frame, if any.
std::vector<double> firstOf(const std::vector<float>& values, std::size_t arity) {
  return values.empty() ? std::vector<double>()
                        : std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(arity));
}

void addNode(const GlbNode& node, tinygltf::Model& model) {
  tinygltf::Node& made = model.nodes.emplace_back();
  made.name = node.name;
  made.children = asInts(node.children);
  made.mesh = node.mesh;
  made.skin = node.skin;
  made.translation = firstOf(node.translations, 3);
  made.rotation = firstOf(node.rotations, 4);
  made.scale = firstOf(node.scales, 3);
  if (!node.translation.isZero()) {
    made.translation.assign(node.translation.data(), node.translation.data() + 3);
  }
}

/// All nodes share the times, and all values of one kind share a view.
void addAnimation(const GlbScene& scene, tinygltf::Model& model, GlbBuffer& buffer) {
  const auto moves = [](const GlbNode& node) {
    return !node.translations.empty() || !node.rotations.empty() || !node.scales.empty();
  };
  if (std::none_of(scene.nodes.begin(), scene.nodes.end(), moves)) return;
  tinygltf::Animation animation;
  buffer.beginView(0);
  const int times = buffer.add(scene.times, 1, TINYGLTF_TYPE_SCALAR, true);
  buffer.beginView(0);
  const auto channel = [&](std::size_t node, const char* path, const std::vector<float>& values, int arity, int type) {
    if (values.empty()) return;
    tinygltf::AnimationSampler& sampler = animation.samplers.emplace_back();
    sampler.input = times;
    sampler.output = buffer.add(values, arity, type);
    tinygltf::AnimationChannel& made = animation.channels.emplace_back();
    made.sampler = static_cast<int>(animation.samplers.size()) - 1;
    made.target_node = static_cast<int>(node);
    made.target_path = path;
  };
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    channel(n, "translation", scene.nodes[n].translations, 3, TINYGLTF_TYPE_VEC3);
    channel(n, "rotation", scene.nodes[n].rotations, 4, TINYGLTF_TYPE_VEC4);
    channel(n, "scale", scene.nodes[n].scales, 3, TINYGLTF_TYPE_VEC3);
  }
  animation.name = "run";
  model.animations.push_back(std::move(animation));
}

}  // namespace

std::string glbBytes(const GlbScene& scene) {
  assert(!scene.times.empty() && !scene.roots.empty());
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "tetskin";
  GlbBuffer buffer(model);
  model.buffers.front().data.reserve(static_cast<std::size_t>(binaryBytes(scene)));
  const bool textured = std::any_of(scene.materials.begin(), scene.materials.end(),
                                    [](const GlbMaterial& material) { return material.textured; });
  const int texture = textured ? addWhiteTexture(model, buffer) : -1;
  for (const GlbMaterial& material : scene.materials) addMaterial(material, texture, model);
  std::vector<int> inverseBinds;
  for (const GlbMesh& mesh : scene.meshes) {
    addMesh(mesh, model, buffer);
    inverseBinds.push_back(-1);
    if (mesh.inverseBinds.empty()) continue;
    buffer.beginView(0);
    inverseBinds.back() = buffer.add(mesh.inverseBinds, 16, TINYGLTF_TYPE_MAT4);
  }
  for (const GlbNode& node : scene.nodes) addNode(node, model);
  for (const GlbSkin& skin : scene.skins) {
    tinygltf::Skin& made = model.skins.emplace_back();
    made.inverseBindMatrices = inverseBinds[skin.mesh];
    made.joints = asInts(skin.joints);
  }
  addAnimation(scene, model, buffer);
  model.defaultScene = 0;
  tinygltf::Scene& shown = model.scenes.emplace_back();
  shown.nodes = asInts(scene.roots);
  if (!scene.origin.isZero()) {
    tinygltf::Value::Array origin;
    for (const double x : scene.origin) origin.emplace_back(x);
    shown.extras = tinygltf::Value(tinygltf::Value::Object{{"origin", tinygltf::Value(std::move(origin))}});
  }

  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true)) return {};
  return std::move(stream).str();
}

}  // namespace tetskin::io
