// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Google Benchmark cases, each with Bullet's own counterpart where there is one. Results are read from --benchmark_out,
// never from standard output, as Bullet prints there.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <benchmark/benchmark.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/src/exported/skin_binding.h>
#include <tetskin/core/src/skinning/skinning.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>

#include "bench/budget_cases.h"
#include "bench/changing_cases.h"
#include "bench/contact_cases.h"
#include "bench/crowd_cases.h"
#include "bench/palette_cases.h"
#include "bench/pile_cases.h"
#include "bench/snapshot_cases.h"
#include "bench/step_cases.h"
#include "bench/touch_cases.h"
#include "scenes/caged_mesh.h"
#include "scenes/command_line.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;
using benchmark::State;

/// A body made from the model's cage, with Bullet's own render nodes at the model's vertices.
struct Bench {
  explicit Bench(Model made, bool renderNodes = true) : model(std::move(made)) {
    auto result = createSoftBody(model.cage, worldInfo);
    require(result.status());
    body = std::unique_ptr<btSoftBody>(std::move(result).value());
    if (!renderNodes) return;
    btSoftBody::RenderNode node;
    node.m_uv1.setZero();
    node.m_normal.setZero();
    for (const Eigen::Vector3d& p : model.mesh.positions) {
      node.m_x = toBullet(p);
      body->m_renderNodes.push_back(node);
    }
  }

  Model model;
  btSoftBodyWorldInfo worldInfo;
  std::unique_ptr<btSoftBody> body;
};

void attachTetskin(State& state, const Bench& bench) {
  EmbedReport report;
  for (auto _ : state) {
    const Result<Embedding> embedding = embed(bench.model.cage.mesh, viewOf(bench.model.mesh.positions), {}, &report);
    benchmark::DoNotOptimize(&embedding);
  }
  state.counters["outside"] = static_cast<double>(report.outside);
  state.counters["candidates"] = static_cast<double>(report.candidates) / static_cast<double>(report.vertexCount);
}

void attachBullet(State& state, const Bench& bench) {
  for (auto _ : state) btSoftBodyHelpers::interpolateBarycentricWeights(bench.body.get());
}

/// tetskin in Bullet's place: the render nodes of a body, ready for Bullet's own updates.
void attachRenderNodes(State& state, const Bench& bench) {
  for (auto _ : state) require(bindRenderNodes(*bench.body).status());
}

/// One whole update as an application calls it, into its own buffer of floats.
void update(State& state, const Bench& bench, const SkinOptions& desired) {
  std::vector<Eigen::Vector3f> out(bench.model.mesh.vertexCount());
  SkinOptions options = desired;
  options.target = viewOf(out);
  options.bounds = false;
  SoftBodySkin skin;
  require(skin.bind(*bench.body, bench.model.cage, bench.model.mesh, options).status());
  for (auto _ : state) {
    benchmark::DoNotOptimize(skin.update());
    benchmark::ClobberMemory();
  }
}

void updateLinear(State& state, const Bench& bench) {
  SkinOptions options;
  options.order = VertexOrder::Sorted;
  update(state, bench, options);
}

void updateLinearOriginal(State& state, const Bench& bench) {
  update(state, bench, {});
}

void updateQuadratic(State& state, const Bench& bench) {
  SkinOptions options;
  options.interpolation = Interpolation::Quadratic;
  options.order = VertexOrder::Sorted;
  update(state, bench, options);
}

/// The normals alone, in the order of Update/linear.
void normalsTransformed(State& state, const Bench& bench) {
  const Cage& cage = bench.model.cage;
  const Embedding embedding = embed(cage, bench.model.mesh).value();
  const auto factors = DirectionFactors::ofNormals(cage.mesh, embedding, restNormals(bench.model.mesh));
  PackedNodes<btScalar> nodes(cage.mesh.nodeCount());
  if (nodes.pack(nodePositions(*bench.body)) < nodes.size())
    throw InputError("the body has a node position that is not finite");
  std::vector<Eigen::Vector3f> normals(embedding.vertexCount());
  for (auto _ : state) {
    transformDirections<btScalar>(embedding, factors, {}, nodes, viewOf(normals), VertexOrder::Sorted);
    benchmark::ClobberMemory();
  }
}

void normalsRecomputed(State& state, const Bench& bench) {
  SkinOptions options;
  options.normals = Normals::Recomputed;
  options.order = VertexOrder::Sorted;
  SoftBodySkin skin;
  require(skin.bind(*bench.body, bench.model.cage, bench.model.mesh, options).status());
  const NormalTopology& topology = *dataOf(*skin.binding()).recomputed;
  std::vector<btScalar> padded(4 * bench.model.mesh.vertexCount());
  std::vector<Eigen::Vector3f> normals(bench.model.mesh.vertexCount());
  for (auto _ : state) {
    padPoints(skin.positions(), padded);
    recomputeNormals(topology, padded, viewOf(normals));
    benchmark::ClobberMemory();
  }
}

void updateBullet(State& state, const Bench& bench) {
  btSoftBodyHelpers::interpolateBarycentricWeights(bench.body.get());
  for (auto _ : state) {
    bench.body->interpolateRenderMesh();
    benchmark::ClobberMemory();
  }
}

void updateMemcpy(State& state, const Bench& bench) {
  const std::vector<Eigen::Vector3f> from(bench.model.mesh.vertexCount(), Eigen::Vector3f::Ones());
  std::vector<Eigen::Vector3f> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.front().data(), from.front().data(), from.size() * sizeof(from[0]));
    benchmark::ClobberMemory();
  }
}

void triad(std::size_t count, const float* __restrict b, const float* __restrict c, float* __restrict sums,
           float* __restrict differences) {
  constexpr float s = 0.5f;
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] = b[i] + s * c[i];
    differences[i] = b[i] - s * c[i];
  }
}

/// A lower bound on the time of Update/linear: b[i] + s * c[i], with the same number of bytes as an update in sorted
/// order. 12 bytes per vertex are read, half from either array, and 12 are written. Plain C++ for SSE2: with millions
/// of vertices memory is the limit, not arithmetic, and an update is predicted to take as long.
void updateTriad(State& state, const Bench& bench) {
  const std::size_t half = 3 * bench.model.mesh.vertexCount() / 2;
  const std::vector<float> b(half, 1.0f), c(half, 2.0f);
  std::vector<float> sums(half), differences(half);
  for (auto _ : state) {
    triad(half, b.data(), c.data(), sums.data(), differences.data());
    benchmark::ClobberMemory();
  }
}

void buildBodyTetskin(State& state, Bench& bench) {
  for (auto _ : state) std::unique_ptr<btSoftBody>(createSoftBody(bench.model.cage, bench.worldInfo).value());
}

void buildBodyBullet(State& state, Bench& bench) {
  const auto path = std::filesystem::temp_directory_path() / "tetskin_bench_cage.vtk";
  require(saveTetMesh(bench.model.cage.mesh, path.string()));
  for (auto _ : state) delete btSoftBodyHelpers::CreateFromVtkFile(bench.worldInfo, path.c_str());
  std::filesystem::remove(path);
}

void writeObj(State& state, const Bench& bench) {
  const auto path = std::filesystem::temp_directory_path() / "tetskin_bench_frame.obj";
  std::vector<Eigen::Vector3f> positions;
  for (const Eigen::Vector3d& p : bench.model.mesh.positions) positions.push_back(p.cast<float>());
  for (auto _ : state) require(bench.model.layout.writeTo(path.string(), viewOf(std::as_const(positions))));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}

void buildCageOf(State& state, const TriangleMesh& mesh, std::size_t tets) {
  CageOptions options;
  options.targetTets = tets;
  CageReport report;
  Status status;
  for (auto _ : state) status = createCage(mesh, options, &report).status();
  require(status);
  state.counters["triangles"] = static_cast<double>(mesh.triangleCount());
  state.counters["tets"] = static_cast<double>(report.tets);
}

/// Cost against size, on serpents of increasing resolution; only without a mesh of the user's.
void registerBuildCageSizes() {
  for (const std::size_t triangles : {10000, 30000, 60000, 100000, 300000, 1000000}) {
    const std::string name = "BuildCage/triangles:" + std::to_string(triangles) + "/tets:30000";
    benchmark::RegisterBenchmark(name.c_str(), [triangles](State& state) {
      buildCageOf(state, makeSerpent({triangles}), 30000);
    })->Unit(benchmark::kMillisecond);
  }
}

/// `count` points on a serpent: its vertices, then points inside its triangles, in their order.
std::vector<Eigen::Vector3d> pointsOn(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Eigen::Vector3d> points = mesh.positions;
  points.reserve(std::max(count, points.size()));
  for (std::size_t k = 0; points.size() < count; ++k) {
    const auto& t = mesh.triangles[k % mesh.triangleCount()];
    const double a = 0.05 + 0.1 * static_cast<double>(k / mesh.triangleCount());  // a different line in every round
    points.push_back(a * mesh.positions[t[0]] + 0.6 * (1.0 - a) * mesh.positions[t[1]] +
                     0.4 * (1.0 - a) * mesh.positions[t[2]]);
  }
  return points;
}

/// Binds to a cage with a tenth as many tets. The time per vertex should not depend on the size.
void attachSize(State& state, std::size_t vertices) {
  TriangleMesh mesh = makeSerpent({2 * vertices});
  const Cage cage = builtCage(mesh, vertices / 10);
  const std::vector<Eigen::Vector3d> points = pointsOn(mesh, vertices);
  mesh = {};
  for (auto _ : state) {
    const Result<Embedding> embedding = embed(cage.mesh, viewOf(points));
    require(embedding.status());
    benchmark::DoNotOptimize(&embedding);
  }
  const double count = static_cast<double>(points.size());
  state.counters["tets"] = static_cast<double>(cage.mesh.tetCount());
  state.counters["vertices"] = count;
  state.counters["s_per_vertex"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void registerAttachSizes() {
  for (const std::size_t vertices : {10000, 100000, 1000000, 10000000}) {
    const std::string name = "Attach/vertices:" + std::to_string(vertices);
    benchmark::RegisterBenchmark(name.c_str(), attachSize, vertices)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(static_cast<benchmark::IterationCount>(1 + 3000000 / vertices));
  }
}

/// A bench with this many points, made when a case first asks for it.
std::function<const Bench&()> benchOfPoints(std::size_t vertices, std::size_t tets) {
  return [vertices, tets, made = std::make_shared<std::unique_ptr<Bench>>()]() -> const Bench& {
    if (!*made) {
      Model model;
      model.mesh = makeSerpent({std::min(vertices * 5 / 3, kMaxSerpentTriangles)});
      model.cage = builtCage(model.mesh, tets);
      model.mesh.positions = pointsOn(model.mesh, vertices);
      model.mesh.triangles.clear();
      model.mesh.normals.clear();
      *made = std::make_unique<Bench>(std::move(model), false);
    }
    return **made;
  };
}

/// Updates of more vertices than the caches hold. The time of each should grow in proportion, and Update/linear should
/// come close to the triad.
void registerUpdateSizes(std::size_t tets) {
  for (const std::size_t vertices : {300000, 3000000}) {
    const auto bench = benchOfPoints(vertices, tets);
    const auto add = [&](const char* name, auto function) {
      const std::string full = std::string(name) + "/vertices:" + std::to_string(vertices);
      benchmark::RegisterBenchmark(full.c_str(), [bench, function](State& state) {
        function(state, bench());
      })->Unit(benchmark::kMicrosecond);
    };
    add("Update/linear", updateLinear);
    add("Update/linear_original", updateLinearOriginal);
    add("Update/quadratic", updateQuadratic);
    add("Update/memcpy", updateMemcpy);
    add("Update/triad", updateTriad);
  }
}

/// tetskin sorts the edges, so 300,000 tets are predicted to take 15 times as long as 24,000; Bullet searches all links
/// for every new one, and is left out where it would take minutes.
void registerBuildBodySizes() {
  const auto add = [](const char* name, std::size_t tets, auto function) {
    const std::string full = std::string(name) + "/tets:" + std::to_string(tets);
    benchmark::RegisterBenchmark(full.c_str(), [tets, function](State& state) {
      Model model;
      model.cage = builtCage(makeSerpent(), tets);
      Bench bench(std::move(model), false);
      function(state, bench);
      state.counters["tets"] = static_cast<double>(bench.model.cage.mesh.tetCount());
    })->Unit(benchmark::kMillisecond);
  };
  add("BuildBody/tetskin", 24000, buildBodyTetskin);
  add("BuildBody/bullet", 24000, buildBodyBullet);
  add("BuildBody/tetskin", 300000, buildBodyTetskin);
}

void registerCases(const std::shared_ptr<Bench>& bench, std::size_t tets) {
  const auto add = [&](const char* name, auto function, benchmark::TimeUnit unit) {
    benchmark::RegisterBenchmark(name, [bench, function](State& state) { function(state, *bench); })->Unit(unit);
  };
  add("Attach/tetskin", attachTetskin, benchmark::kMillisecond);
  add("Attach/bullet", attachBullet, benchmark::kMillisecond);
  add("Attach/render_nodes", attachRenderNodes, benchmark::kMillisecond);
  add("Update/linear", updateLinear, benchmark::kMicrosecond);
  add("Update/linear_original", updateLinearOriginal, benchmark::kMicrosecond);
  add("Update/quadratic", updateQuadratic, benchmark::kMicrosecond);
  add("Update/bullet", updateBullet, benchmark::kMicrosecond);
  add("Update/memcpy", updateMemcpy, benchmark::kMicrosecond);
  bench::registerPaletteCases([bench]() -> const Model& { return bench->model; });
  add("Normals/transformed", normalsTransformed, benchmark::kMicrosecond);
  add("Normals/recomputed", normalsRecomputed, benchmark::kMicrosecond);
  add("BuildBody/tetskin", buildBodyTetskin, benchmark::kMillisecond);
  add("BuildBody/bullet", buildBodyBullet, benchmark::kMillisecond);
  add("WriteObj/tetskin", writeObj, benchmark::kMillisecond);
  benchmark::RegisterBenchmark("BuildCage", [bench, tets](State& state) {
    buildCageOf(state, bench->model.mesh, tets);
  })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  // Removes its own flags. If help were asked for, it would print only these and exit.
  const bool help = std::any_of(argv, argv + argc, [](const char* text) { return std::string(text) == "--help"; });
  if (!help) benchmark::Initialize(&argc, argv);
  ModelOptions options;
  std::size_t bodies = 500;
  CommandLine line(
      "Benchmarks embedding, updating, building and writing, each beside Bullet's own. Also takes the options of "
      "Google Benchmark: --benchmark_filter=REGEX, --benchmark_out=FILE, ...",
      {{{"tetskin_bench --benchmark_filter=^Update/linear$ --benchmark_out=update.json",
         "one benchmark, and a JSON file of its times"},
        {"tetskin_bench --mesh yours.obj --tets 1000 --benchmark_filter=^Attach/",
         "embedding your mesh, in three ways"}},
       ""});
  line.addModelOptions(options);
  line.addCount("--bodies", bodies, "of Crowd/", 100000);
  return line.run(argc, argv, [&] {
    registerCases(std::make_shared<Bench>(loadModel(options)), options.tets);
    bench::registerCrowdCases(options, bodies);
    if (options.mesh.empty()) {
      registerUpdateSizes(options.tets);
      registerBuildBodySizes();
      bench::registerStepCases();
      bench::registerChangingCases();
      bench::registerSnapshotCases();
      bench::registerContactCases();
      bench::registerPileCases();
      bench::registerBudgetCases();
      bench::registerTouchCases();
      registerAttachSizes();
      registerBuildCageSizes();
    }
    benchmark::RunSpecifiedBenchmarks();
    return kDone;
  });
}
