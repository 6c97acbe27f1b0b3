// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "models.h"

#include <tetskin/core/bone_palette.h>

namespace tetskin::python {
namespace {

/// A surface that follows nodes given as an array. One thread at a time uses it: the GIL is kept.
class Skin {
 public:
  Skin(const CageModel& cage, const MeshModel& mesh, const BindingOptions& options) : cage_(cage), mesh_(mesh) {
    const std::size_t count = mesh.mesh->vertexCount();
    released([&] {
      EmbedReport report;
      auto binding = take(SkinBinding<double>::create(*cage.cage, *mesh.mesh, options, &report));
      report_ = report.describe();
      positions = std::make_shared<std::vector<float>>(3 * count);
      normals = std::make_shared<std::vector<float>>(options.normals == Normals::None ? 0 : 3 * count);
      InstanceOptions instance;
      instance.target = PointView<float>(positions->data(), count);
      if (!normals->empty()) instance.normalTarget = PointView<float>(normals->data(), count);
      check(skin_.bind(binding, viewOf(cage_.cage->mesh.nodes), instance));
    });
  }

  void update(const ArrayLike& nodes) {
    const Numbers<double> numbers(nodes, "nodes", 3);
    if (numbers.rows() != skin_.nodeCount()) {
      fail(StatusCode::SizeMismatch,
           "nodes: " + std::to_string(numbers.rows()) + " for a cage of " + std::to_string(skin_.nodeCount()));
    }
    const StatusCode code = skin_.update({numbers.data(), numbers.rows()});
    if (code == StatusCode::NonFinite) {
      fail(code, "nodes: node " + std::to_string(skin_.firstNonFiniteNode()) + " is not finite, or too far away");
    }
    check(code, "Skin.update");
  }

  Box3 bounds() const { return skin_.bounds(); }
  const std::string& report() const { return report_; }
  std::size_t nodeCount() const { return skin_.nodeCount(); }

  std::shared_ptr<std::vector<float>> positions, normals;
  Kept<Row3<float>> positionsArray, normalsArray;

 private:
  CageModel cage_;
  MeshModel mesh_;
  MeshSkin<double> skin_;
  std::string report_;
};

Made<Row3<float>> rowsOf(const std::shared_ptr<std::vector<float>>& numbers, const Kept<Row3<float>>& array) {
  return array.view([&] { return view3<float>(numbers->data(), numbers->size() / 3, numbers); });
}

BoneLayout layoutOf(const std::string& name) {
  if (name == "rows") return BoneLayout::Rows;
  if (name == "columns") return BoneLayout::Columns;
  throw nb::value_error("layout: 'rows' or 'columns'");
}

/// Bones with their memory.
class Palette {
 public:
  Palette(const CageModel& cage, const MeshModel& mesh, Interpolation interpolation, bool gradients,
          const std::string& layout) {
    PaletteOptions options;
    options.layout = layoutOf(layout);
    // Gradients are for the linear surface of a binding with gradients.
    options.gradients = gradients;
    options.disableQuadratic = gradients && interpolation == Interpolation::Linear;
    BindingOptions binding;
    binding.interpolation = gradients ? Interpolation::Quadratic : interpolation;
    binding_ = take(SkinBinding<double>::create(*cage.cage, *mesh.mesh, binding));
    palette_ = take(BonePalette<double>::create(binding_, options));
    bones = std::make_shared<std::vector<float>>(palette_.boneCount() * boneFloats(options.layout));
    update({viewOf(cage.cage->mesh.nodes)});
  }

  void update(PointView<const double> nodes) {
    if (nodes.size() != palette_.boneCount()) {
      fail(StatusCode::SizeMismatch,
           "nodes: " + std::to_string(nodes.size()) + " for a cage of " + std::to_string(palette_.boneCount()));
    }
    check(palette_.update(nodes, {bones->data(), palette_.boneCount(), 0}), "BonePalette.update");
  }
  nb::ndarray<nb::numpy, const float, nb::ndim<3>> array() const {
    const std::size_t rows = palette_.layout() == BoneLayout::Rows ? 3 : 4;
    const std::size_t shape[3] = {palette_.boneCount(), rows, 4};
    return nb::ndarray<nb::numpy, const float, nb::ndim<3>>(bones->data(), 3, shape, kept(bones));
  }
  std::size_t count() const { return palette_.boneCount(); }
  SkinnedMesh skinned() const { return take(skinnedMeshOf(*binding_)); }

  std::shared_ptr<std::vector<float>> bones;

 private:
  SkinBinding<double>::Pointer binding_;
  BonePalette<double> palette_;
};

template <class Number>
Row4<Number> rows4(const std::vector<std::array<Number, 4>>& rows) {
  const auto owner = std::make_shared<std::vector<std::array<Number, 4>>>(rows);
  const std::size_t shape[2] = {rows.size(), 4};
  return Row4<Number>(owner->empty() ? nullptr : (*owner)[0].data(), 2, shape, kept(owner));
}

}  // namespace

void bindSkins(nb::module_& module) {
  Class<Skin>(module, "Skin", "A render mesh that follows the nodes of a cage, however they move. Needs no world.")
      .words([](const Skin& s) { return counted(s.positions->size() / 3, "vertex", "vertices"); })
      .def(
          "__init__",
          [](Skin* self, const CageModel& cage, const MeshLike& mesh, const Choice<Interpolation>& interpolation,
             const Choice<Normals>& normals, const Choice<OutsideRule>& outside, std::optional<double> maxDistance,
             double hardEdgeDegrees) {
            BindingOptions options;
            options.interpolation = valueOf(interpolation);
            options.normals = valueOf(normals);
            options.outside = valueOf(outside);
            options.maxDistance = maxDistance.value_or(options.maxDistance);
            options.hardEdgeDegrees = hardEdgeDegrees;
            new (self) Skin(cage, meshOf(mesh), options);
          },
          "cage"_a, "mesh"_a, nb::kw_only(), "interpolation"_a = "linear", "normals"_a = "none",
          "outside"_a = "nearest", "max_distance"_a = nb::none(), "hard_edge_degrees"_a = kHardEdgeDegrees,
          "Embeds the mesh in the cage at rest. interpolation: 'linear' or 'quadratic'; normals: 'none', 'transformed' "
          "or 'recomputed'; outside: 'nearest' or 'barycentric': which tet carries a vertex outside the cage; "
          "max_distance: rest units; a vertex farther than this from every tet raises an Error; hard_edge_degrees: "
          "recomputed normals stay split where rest normals at an edge differ by more.")
      .def(
          "update",
          [](Skin& skin, const ArrayLike& nodes) {
            skin.update(nodes);
            return rowsOf(skin.positions, skin.positionsArray);
          },
          "nodes"_a,
          "Computes the surface for these nodes: (n, 3) numbers, world space, in the cage's order. Returns "
          "positions. On an Error, the surface stays as it was.")
      .def_prop_ro(
          "positions", [](const Skin& skin) { return rowsOf(skin.positions, skin.positionsArray); },
          "(vertices, 3) float32, world space. A read-only view, which each update overwrites.")
      .def_prop_ro(
          "normals", [](const Skin& skin) { return rowsOf(skin.normals, skin.normalsArray); },
          "(vertices, 3) float32, unit length, or (0, 3). A read-only view, which each update overwrites.")
      .def_prop_ro(
          "bounds",
          [](const Skin& skin) { return nb::make_tuple(vectorOf(skin.bounds().min()), vectorOf(skin.bounds().max())); },
          kBoundsType, "The box of the positions: two corners, world space.")
      .def_prop_ro("node_count", &Skin::nodeCount, "Number of nodes that an update needs.")
      .def_prop_ro("report", &Skin::report, "A text on how well the mesh fits the cage.");

  Class<Palette>(module, "BonePalette",
                 "Affine bones, one per node, for an engine's own linear blend skinning. Needs no world.")
      .words([](const Palette& p) { return counted(p.count(), "bone", "bones"); })
      .def(
          "__init__",
          [](Palette* self, const CageModel& cage, const MeshLike& mesh, const Choice<Interpolation>& interpolation,
             bool gradients, const Choice<Layouts>& layout) {
            new (self) Palette(cage, meshOf(mesh), valueOf(interpolation), gradients, layout.name);
          },
          "cage"_a, "mesh"_a, nb::kw_only(), "interpolation"_a = "linear", "gradients"_a = false, "layout"_a = "rows",
          "layout: 'rows', 3 rows of 4, or 'columns', the 4 columns of a 4x4 matrix. gradients: bones of the linear "
          "surface carry the gradients of the nodes, for normals in a shader.")
      .def(
          "update",
          [](Palette& palette, const ArrayLike& nodes) {
            const Numbers<double> numbers(nodes, "nodes", 3);
            palette.update({numbers.data(), numbers.rows()});
            return palette.array();
          },
          "nodes"_a, "Computes the bones for these nodes, (n, 3) numbers, world space. Returns bones.")
      .def_prop_ro("bones", &Palette::array,
                   "(n, 3, 4) or (n, 4, 4) float32. A read-only view, which each update overwrites.")
      .def_prop_ro("bone_count", &Palette::count, "Number of bones, one per node.")
      .def_prop_ro(
          "vertex_bones", [](const Palette& palette) { return rows4(palette.skinned().bones); },
          "(vertices, 4) uint16: the bones of each vertex. A new array.")
      .def_prop_ro(
          "vertex_weights", [](const Palette& palette) { return rows4(palette.skinned().weights); },
          "(vertices, 4) float32, which sum to 1. A new array.");
}

}  // namespace tetskin::python
