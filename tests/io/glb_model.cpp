// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "glb_model.h"

#include <cstring>
#include <map>
#include <set>

namespace tetskin::test {
namespace {

double numberAt(const unsigned char* at, int component) {
  const auto as = [&](auto number) {
    std::memcpy(&number, at, sizeof number);
    return static_cast<double>(number);
  };
  if (component == TINYGLTF_COMPONENT_TYPE_FLOAT) return as(float{});
  if (component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return as(std::uint32_t{});
  EXPECT_EQ(component, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  return as(std::uint16_t{});
}

std::size_t arityOf(const tinygltf::Accessor& accessor) {
  return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}
std::size_t sizeOf(const tinygltf::Accessor& accessor) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
}

}  // namespace

GlbModel::GlbModel(const std::string& path) {
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  EXPECT_TRUE(loader.LoadBinaryFromFile(&model_, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  parents_.assign(model_.nodes.size(), -1);
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    for (const int child : model_.nodes[n].children) parents_[static_cast<std::size_t>(child)] = static_cast<int>(n);
  }
}

std::size_t GlbModel::frameCount() const {
  if (model_.animations.empty()) return 0;
  return model_.accessors[static_cast<std::size_t>(model_.animations[0].samplers[0].input)].count;
}

std::vector<double> GlbModel::numbers(int index) const {
  const tinygltf::Accessor& accessor = model_.accessors.at(static_cast<std::size_t>(index));
  const tinygltf::BufferView& view = model_.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  const unsigned char* data = model_.buffers[0].data.data() + view.byteOffset + accessor.byteOffset;
  std::vector<double> numbers;
  for (std::size_t i = 0; i < accessor.count * arityOf(accessor); ++i) {
    numbers.push_back(numberAt(data + i * sizeOf(accessor), accessor.componentType));
  }
  return numbers;
}

int GlbModel::node(const std::string& name) const {
  int found = -1;
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    if (model_.nodes[n].name != name) continue;
    EXPECT_EQ(found, -1) << "two nodes are called " << name;
    found = static_cast<int>(n);
  }
  EXPECT_NE(found, -1) << name;
  return found;
}

Eigen::Affine3d GlbModel::placeOf(std::size_t node, std::size_t frame) const {
  const tinygltf::Node& at = model_.nodes[node];
  std::map<std::string, std::vector<double>> values = {
      {"translation", at.translation.empty() ? std::vector<double>{0, 0, 0} : at.translation},
      {"rotation", at.rotation.empty() ? std::vector<double>{0, 0, 0, 1} : at.rotation},
      {"scale", at.scale.empty() ? std::vector<double>{1, 1, 1} : at.scale}};
  for (const tinygltf::AnimationChannel& channel : model_.animations.at(0).channels) {
    if (channel.target_node != static_cast<int>(node)) continue;
    const auto& sampler = model_.animations[0].samplers[static_cast<std::size_t>(channel.sampler)];
    const std::vector<double> all = numbers(sampler.output);
    std::vector<double>& value = values.at(channel.target_path);
    for (std::size_t k = 0; k < value.size(); ++k) value[k] = all.at(frame * value.size() + k);
  }
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translate(Eigen::Vector3d(values["translation"].data()));
  place.rotate(Eigen::Quaterniond(values["rotation"].data()));
  place.scale(Eigen::Vector3d(values["scale"].data()));
  const int parent = parents_[node];
  return parent < 0 ? place : placeOf(static_cast<std::size_t>(parent), frame) * place;
}

std::vector<Eigen::Vector3d> GlbModel::positions(const std::string& name, std::size_t frame) const {
  const tinygltf::Node& shown = model_.nodes.at(static_cast<std::size_t>(node(name)));
  const tinygltf::Mesh& mesh = model_.meshes.at(static_cast<std::size_t>(shown.mesh));
  const auto attributes = mesh.primitives.at(0).attributes;
  const std::vector<double> rest = numbers(attributes.at("POSITION"));
  std::vector<Eigen::Vector3d> positions;
  if (shown.skin < 0) {
    const Eigen::Affine3d place = placeOf(static_cast<std::size_t>(node(name)), frame);
    for (std::size_t v = 0; v < rest.size() / 3; ++v) positions.push_back(place * Eigen::Vector3d(&rest[3 * v]));
    return positions;
  }
  const tinygltf::Skin& skin = model_.skins.at(static_cast<std::size_t>(shown.skin));
  const std::vector<double> binds = numbers(skin.inverseBindMatrices);
  std::vector<Eigen::Matrix4d> bones;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Eigen::Affine3d place = placeOf(static_cast<std::size_t>(skin.joints[j]), frame);
    bones.push_back(place.matrix() * Eigen::Map<const Eigen::Matrix4d>(&binds[16 * j]));
  }
  const std::vector<double> joints = numbers(attributes.at("JOINTS_0")), weights = numbers(attributes.at("WEIGHTS_0"));
  for (std::size_t v = 0; v < rest.size() / 3; ++v) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
      sum += weights[k] * bones.at(static_cast<std::size_t>(joints[k])) * Eigen::Vector3d(&rest[3 * v]).homogeneous();
    }
    positions.push_back(sum.head<3>());
  }
  return positions;
}

std::vector<std::string> GlbModel::materials(const std::string& name) const {
  std::vector<std::string> names;
  const tinygltf::Node& shown = model_.nodes.at(static_cast<std::size_t>(node(name)));
  for (const tinygltf::Primitive& primitive : model_.meshes.at(static_cast<std::size_t>(shown.mesh)).primitives) {
    names.push_back(model_.materials.at(static_cast<std::size_t>(primitive.material)).name);
  }
  return names;
}

std::size_t GlbModel::triangleCount(const std::string& name) const {
  std::size_t count = 0;
  const tinygltf::Node& shown = model_.nodes.at(static_cast<std::size_t>(node(name)));
  for (const tinygltf::Primitive& primitive : model_.meshes.at(static_cast<std::size_t>(shown.mesh)).primitives) {
    count += model_.accessors.at(static_cast<std::size_t>(primitive.indices)).count / 3;
  }
  return count;
}

void GlbModel::expectValid() const {
  EXPECT_EQ(model_.asset.version, "2.0");
  EXPECT_TRUE(model_.extensionsUsed.empty());
  ASSERT_EQ(model_.buffers.size(), 1u);
  expectValidAccessors();
  expectValidMeshes();
  expectValidNodes();
  expectValidAnimations();
}

void GlbModel::expectValidAccessors() const {
  std::size_t end = 0;
  for (const tinygltf::BufferView& view : model_.bufferViews) {
    EXPECT_GE(view.byteOffset, end) << "views overlap";
    EXPECT_GT(view.byteLength, 0u);
    end = view.byteOffset + view.byteLength;
  }
  EXPECT_LE(end, model_.buffers[0].data.size());
  EXPECT_LT(model_.buffers[0].data.size() - end, 4u);
  for (std::size_t a = 0; a < model_.accessors.size(); ++a) {
    const tinygltf::Accessor& accessor = model_.accessors[a];
    const tinygltf::BufferView& view = model_.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    EXPECT_GT(accessor.count, 0u);
    EXPECT_EQ((view.byteOffset + accessor.byteOffset) % 4, 0u);
    EXPECT_LE(accessor.byteOffset + accessor.count * arityOf(accessor) * sizeOf(accessor), view.byteLength);
    const std::vector<double> all = numbers(static_cast<int>(a));
    EXPECT_TRUE(std::all_of(all.begin(), all.end(), [](double x) { return std::isfinite(x); }));
    for (std::size_t k = 0; k < accessor.minValues.size(); ++k) {
      double least = all[k], most = all[k];
      for (std::size_t i = k; i < all.size(); i += arityOf(accessor)) {
        least = std::min(least, all[i]);
        most = std::max(most, all[i]);
      }
      EXPECT_EQ(accessor.minValues[k], least);
      EXPECT_EQ(accessor.maxValues[k], most);
    }
  }
}

void GlbModel::expectValidMeshes() const {
  const auto checkUnits = [&](int accessor, double tolerance) {
    const std::vector<double> all = numbers(accessor);
    for (std::size_t i = 0; i < all.size(); i += 3) ASSERT_NEAR(Eigen::Vector3d(&all[i]).norm(), 1.0, tolerance);
  };
  for (const tinygltf::Node& node : model_.nodes) {
    if (node.mesh < 0) continue;
    EXPECT_FALSE(model_.meshes.at(static_cast<std::size_t>(node.mesh)).primitives.empty());
    for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      const auto& attributes = primitive.attributes;
      const tinygltf::Accessor& positions = model_.accessors[static_cast<std::size_t>(attributes.at("POSITION"))];
      EXPECT_EQ(positions.minValues.size(), 3u);
      EXPECT_EQ(positions.maxValues.size(), 3u);
      for (const auto& [name, accessor] : attributes) {
        EXPECT_EQ(model_.accessors[static_cast<std::size_t>(accessor)].count, positions.count) << name;
      }
      if (attributes.count("NORMAL") > 0) checkUnits(attributes.at("NORMAL"), 5e-4);
      const std::vector<double> corners = numbers(primitive.indices);
      EXPECT_EQ(corners.size() % 3, 0u);
      const bool wide = model_.accessors[static_cast<std::size_t>(primitive.indices)].componentType ==
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
      for (std::size_t i = 0; i < corners.size(); i += 3) {
        for (std::size_t k = i; k < i + 3; ++k) ASSERT_LT(corners[k], static_cast<double>(positions.count));
        for (std::size_t k = i; k < i + 3; ++k) ASSERT_TRUE(wide || corners[k] < 65535.0);
        EXPECT_TRUE(corners[i] != corners[i + 1] && corners[i + 1] != corners[i + 2] && corners[i] != corners[i + 2]);
      }
      EXPECT_EQ(node.skin >= 0, attributes.count("JOINTS_0") > 0);
      EXPECT_EQ(node.skin >= 0, attributes.count("WEIGHTS_0") > 0);
      if (node.skin < 0) continue;
      const std::vector<double> joints = numbers(attributes.at("JOINTS_0"));
      const std::vector<double> weights = numbers(attributes.at("WEIGHTS_0"));
      const double count = static_cast<double>(model_.skins.at(static_cast<std::size_t>(node.skin)).joints.size());
      for (std::size_t v = 0; v < weights.size(); v += 4) {
        std::set<double> used;
        for (std::size_t k = v; k < v + 4; ++k) {
          ASSERT_GE(weights[k], 0.0);
          ASSERT_LT(joints[k], count);
          ASSERT_TRUE(weights[k] > 0.0 || joints[k] == 0.0) << "a joint without a weight";
          ASSERT_TRUE(weights[k] == 0.0 || used.insert(joints[k]).second) << "a joint twice";
        }
        ASSERT_NEAR(weights[v] + weights[v + 1] + weights[v + 2] + weights[v + 3], 1.0,
                    2e-7 * static_cast<double>(used.size()));
      }
    }
  }
}

void GlbModel::expectValidNodes() const {
  std::vector<int> parentsOf(model_.nodes.size(), 0);
  for (const tinygltf::Node& node : model_.nodes) {
    EXPECT_TRUE(node.matrix.empty()) << "of an animated node";
    const double norm = node.rotation.empty() ? 1.0 : Eigen::Vector4d(node.rotation.data()).norm();
    EXPECT_NEAR(norm, 1.0, 1e-6);
    for (const int child : node.children) ++parentsOf.at(static_cast<std::size_t>(child));
  }
  ASSERT_EQ(model_.scenes.size(), 1u);
  for (const int root : model_.scenes[0].nodes) ++parentsOf.at(static_cast<std::size_t>(root));
  for (std::size_t n = 0; n < parentsOf.size(); ++n) EXPECT_EQ(parentsOf[n], 1) << model_.nodes[n].name;
  std::set<std::string> names;
  for (const tinygltf::Node& node : model_.nodes) EXPECT_TRUE(names.insert(node.name).second) << node.name;
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    EXPECT_TRUE(model_.nodes[n].skin < 0 || parents_[n] < 0) << "skinned meshes are roots";
  }
  for (const tinygltf::Skin& skin : model_.skins) {
    const auto& binds = model_.accessors.at(static_cast<std::size_t>(skin.inverseBindMatrices));
    EXPECT_EQ(binds.type, TINYGLTF_TYPE_MAT4);
    EXPECT_EQ(binds.count, skin.joints.size());
    EXPECT_EQ(std::set<int>(skin.joints.begin(), skin.joints.end()).size(), skin.joints.size());
  }
}

void GlbModel::expectValidAnimations() const {
  for (const tinygltf::Animation& animation : model_.animations) {
    std::set<std::pair<int, std::string>> targets;
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      EXPECT_TRUE(targets.insert({channel.target_node, channel.target_path}).second);
      const tinygltf::AnimationSampler& sampler = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
      const tinygltf::Accessor& times = model_.accessors.at(static_cast<std::size_t>(sampler.input));
      EXPECT_EQ(times.minValues.size(), 1u);
      EXPECT_EQ(times.maxValues.size(), 1u);
      EXPECT_EQ(model_.accessors.at(static_cast<std::size_t>(sampler.output)).count, times.count);
      if (channel.target_path != "rotation") continue;
      const std::vector<double> all = numbers(sampler.output);
      for (std::size_t i = 0; i < all.size(); i += 4) ASSERT_NEAR(Eigen::Vector4d(&all[i]).norm(), 1.0, 1e-6);
    }
    const std::vector<double> times = numbers(animation.samplers.at(0).input);
    EXPECT_GE(times.front(), 0.0);
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<double>())) << "times ascend";
  }
}

}  // namespace tetskin::test
