// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A skin whose nodes move anywhere: if they are finite and below Limits::kMaxCoordinate, so is the surface, and normals
// are unit vectors; if not, the first bad node is named and the surface is kept. Then the nodes return to rest, and so
// does the surface.
#include "fuzz.h"

#include <tetskin/core/mesh_skin.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "support/odd_meshes.h"

namespace {

using namespace tetskin;
using test::FuzzedBytes;

template <class Scalar>
using Points = std::vector<Eigen::Matrix<Scalar, 3, 1>>;

/// Two cubes of a lattice with a flat and an inverted tet, a sphere half outside of it, and one vertex far away.
struct Model {
  TetMesh cage = test::latticeCage(2, 1, 1, 0.5);
  TriangleMesh mesh = test::sphere(6, 0.4, {0.4, 0.2, 0.2});

  Model() {
    std::swap(cage.tets[3][0], cage.tets[3][1]);
    cage.tets.push_back({cage.tets[0][0], cage.tets[0][1], cage.tets[0][2], cage.tets[0][0]});
    mesh.positions.emplace_back(1e6, 0, 0);
    mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
  }
};

SkinOptions takeOptions(FuzzedBytes& bytes) {
  SkinOptions options;
  options.interpolation = bytes.number(1) == 1 ? Interpolation::Quadratic : Interpolation::Linear;
  options.normals = static_cast<Normals>(bytes.number(2));
  options.order = bytes.number(1) == 1 ? VertexOrder::Sorted : VertexOrder::Mesh;
  options.bounds = bytes.number(1) == 1;
  options.previousPositions = bytes.number(1) == 1;
  return options;
}

/// Any scalar, or one of the body's size, or of a size that the bytes choose.
template <class Scalar>
Scalar takeCoordinate(FuzzedBytes& bytes, double scale) {
  if (bytes.number(3) == 0) return bytes.take<Scalar>();
  return static_cast<Scalar>(scale * (bytes.number(255) - 128) / 128.0);
}

template <class Out, class View>
Points<Out> copyOf(const View& view) {
  Points<Out> copy;
  for (std::size_t i = 0; i < view.size(); ++i) copy.emplace_back(view[i]);
  return copy;
}

template <class Scalar>
void expectGood(const MeshSkin<Scalar>& skin) {
  TETSKIN_FUZZ_EXPECT(firstNonFinite(skin.positions()) == skin.positions().size());
  for (const PointView<const float>& directions : {skin.normals(), skin.tangents()}) {
    for (std::size_t v = 0; v < directions.size(); ++v) {
      TETSKIN_FUZZ_EXPECT(std::abs(Eigen::Map<const Eigen::Vector3f>(directions[v]).norm() - 1.0f) < 1e-4f);
    }
  }
}

/// Created once for each kind of options.
template <class Scalar>
std::shared_ptr<const SkinBinding<Scalar>> bindingFor(const Model& model, const SkinOptions& options) {
  static std::map<std::tuple<Interpolation, Normals, VertexOrder>, std::shared_ptr<const SkinBinding<Scalar>>> made;
  auto& binding = made[{options.interpolation, options.normals, options.order}];
  if (!binding) binding = SkinBinding<Scalar>::create(model.cage, model.mesh, options).value();
  TETSKIN_FUZZ_EXPECT(binding != nullptr);
  return binding;
}

template <class Scalar>
void fuzz(FuzzedBytes& bytes) {
  static const Model model;
  const double scales[] = {1.0, 1e-20, 1e10, 1e18};
  Points<Scalar> home;
  for (const Eigen::Vector3d& p : model.cage.nodes) home.push_back(p.cast<Scalar>());
  MeshSkin<Scalar> skin;
  const SkinOptions options = takeOptions(bytes);
  const InstanceOptions& instance = options;
  TETSKIN_FUZZ_EXPECT(skin.bind(bindingFor<Scalar>(model, options), viewOf(std::as_const(home)), instance).ok());
  const Points<Scalar> rest = copyOf<Scalar>(skin.positions());
  for (int step = 0; step < 3 && !bytes.empty(); ++step) {
    const Points<Scalar> before = copyOf<Scalar>(skin.positions());
    const double scale = scales[bytes.number(3)];
    Points<Scalar> nodes = home;
    for (auto& node : nodes) {
      for (int k = 0; k < 3; ++k) node[k] = takeCoordinate<Scalar>(bytes, scale);
    }
    const std::size_t bad = firstUnusable(viewOf(std::as_const(nodes)));
    const StatusCode done = skin.update(viewOf(std::as_const(nodes)));
    TETSKIN_FUZZ_EXPECT(done == (bad < nodes.size() ? StatusCode::NonFinite : StatusCode::Ok));
    expectGood(skin);
    if (bad == nodes.size()) continue;
    TETSKIN_FUZZ_EXPECT(skin.firstNonFiniteNode() == bad && copyOf<Scalar>(skin.positions()) == before);
  }
  TETSKIN_FUZZ_EXPECT(skin.update(viewOf(std::as_const(home))) == StatusCode::Ok);
  TETSKIN_FUZZ_EXPECT(copyOf<Scalar>(skin.positions()) == rest);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedBytes bytes(data, size);
  if (bytes.number(1) == 0) {
    fuzz<float>(bytes);
  } else {
    fuzz<double>(bytes);
  }
  return 0;
}
