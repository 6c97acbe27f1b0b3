// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <tetskin/core/bone_palette.h>

namespace tetskin::js {
namespace {

/// Bones with their memory.
struct PaletteHandle {
  std::shared_ptr<const SoftBodyBinding> binding;
  BonePalette<float> palette;
  std::vector<float> bones, nodes;
};

View update(PaletteHandle& handle, const PointView<const float>& nodes) {
  if (nodes.size() != handle.palette.boneCount())
    fail(StatusCode::SizeMismatch,
         "nodes: " + std::to_string(nodes.size()) + " for a cage of " + std::to_string(handle.palette.boneCount()));
  check(handle.palette.update(nodes, {handle.bones.data(), handle.palette.boneCount(), 0}), "a palette's update");
  return viewNumbers(handle.bones.data(), handle.bones.size());
}

View updateByNumbers(PaletteHandle& handle, Doubles numbers) {
  if (firstUnusable(PointView<const double>(numbers.begin(), numbers.count / 3)) != numbers.count / 3)
    fail(StatusCode::NonFinite, "nodes: a number is not finite, or larger than 1e18");
  handle.nodes.assign(numbers.begin(), numbers.end());
  return update(handle, PointView<const float>(handle.nodes.data(), handle.nodes.size() / 3));
}
View updateByBody(PaletteHandle& handle, BodyHandle& body) {
  return update(handle, nodePositions(alive(*body.state).body()));
}

PaletteHandle* createPalette(const CageModel& cage, const MeshModel& mesh, std::string interpolation, bool gradients,
                             bool columns) {
  PaletteOptions options;
  options.layout = columns ? BoneLayout::Columns : BoneLayout::Rows;
  // Gradients are for the linear surface of a binding with gradients.
  options.gradients = gradients;
  BindingOptions binding;
  binding.interpolation = valueOf(Choice<Interpolation>{std::move(interpolation)});
  options.disableQuadratic = gradients && binding.interpolation == Interpolation::Linear;
  if (gradients) binding.interpolation = Interpolation::Quadratic;
  auto handle = std::make_unique<PaletteHandle>();
  handle->binding = take(SoftBodyBinding::create(*cage.cage, *mesh.mesh, binding));
  handle->palette = take(BonePalette<float>::create(handle->binding, options));
  handle->bones.resize(handle->palette.boneCount() * boneFloats(options.layout));
  for (const Eigen::Vector3d& node : cage.cage->mesh.nodes)
    for (const double x : node) handle->nodes.push_back(static_cast<float>(x));
  (void)update(*handle, PointView<const float>(handle->nodes.data(), handle->nodes.size() / 3));
  return handle.release();
}

View bones(PaletteHandle& handle) {
  return viewNumbers(handle.bones.data(), handle.bones.size());
}
std::size_t boneCount(PaletteHandle& handle) {
  return handle.palette.boneCount();
}
template <class Number>
View lentRows(const std::vector<std::array<Number, 4>>& rows) {
  std::vector<Number> numbers;
  for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return lent(std::move(numbers));
}
View vertexBones(PaletteHandle& handle) {
  return lentRows(take(skinnedMeshOf(*handle.binding)).bones);
}
View vertexWeights(PaletteHandle& handle) {
  return lentRows(take(skinnedMeshOf(*handle.binding)).weights);
}

}  // namespace

EMSCRIPTEN_BINDINGS(palettes) {
  emscripten::class_<PaletteHandle>("Palette");
  expose<&createPalette>("createPalette");
  expose<&updateByNumbers>("updatePaletteByNumbers");
  expose<&updateByBody>("updatePaletteByBody");
  expose<&bones>("bones");
  expose<&boneCount>("boneCount");
  expose<&vertexBones>("vertexBones");
  expose<&vertexWeights>("vertexWeights");
}

}  // namespace tetskin::js
