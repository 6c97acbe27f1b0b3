// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/palette_cases.h"

#include <LinearMath/btScalar.h>
#include <benchmark/benchmark.h>
#include <tetskin/core/bone_palette.h>

#include <vector>

#include "scenes/input_error.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

/// One whole update as an application calls it, into its own buffer.
void update(State& state, const scenes::Model& model, Interpolation interpolation, const PaletteOptions& options) {
  BindingOptions bindingOptions;
  bindingOptions.interpolation = interpolation;
  auto binding = SkinBinding<btScalar>::create(model.cage, model.mesh, bindingOptions);
  scenes::require(binding.status());
  auto palette = BonePalette<btScalar>::create(binding.value(), options);
  scenes::require(palette.status());
  std::vector<Eigen::Matrix<btScalar, 3, 1>> nodes;
  for (const Eigen::Vector3d& p : model.cage.mesh.nodes) nodes.push_back(p.cast<btScalar>());
  std::vector<float> bones(boneFloats(options.layout) * nodes.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(palette.value().update(viewOf(std::as_const(nodes)), {bones.data(), nodes.size()}));
    benchmark::ClobberMemory();
  }
  state.counters["bones"] = static_cast<double>(nodes.size());
}

}  // namespace

void registerPaletteCases(const std::function<const scenes::Model&()>& model) {
  const auto add = [&](const char* name, Interpolation interpolation, const PaletteOptions& options) {
    benchmark::RegisterBenchmark(name, [=](State& state) {
      update(state, model(), interpolation, options);
    })->Unit(benchmark::kMicrosecond);
  };
  PaletteOptions gradients;
  gradients.disableQuadratic = gradients.gradients = true;
  add("Palette/linear", Interpolation::Linear, {});
  add("Palette/linear_gradients", Interpolation::Quadratic, gradients);
  add("Palette/quadratic", Interpolation::Quadratic, {});
}

}  // namespace tetskin::bench
