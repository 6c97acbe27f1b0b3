// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "models.h"

#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/io/files.h>

namespace tetskin::python {
namespace {

CageModel made(const ArrayLike& nodes, const ArrayLike& tets) {
  TetMesh mesh;
  mesh.nodes = pointsOf(nodes, "nodes");
  mesh.tets = indexRowsOf<4>(tets, "tets");
  check(validate(mesh));
  (void)repairTetMesh(mesh);
  return cageModel(Cage(std::move(mesh)));
}

std::vector<double> mapValues(const std::optional<ArrayLike>& array, const char* name) {
  if (!array) return {};
  const Numbers<double> numbers(*array, name, 0);
  // An empty array is one of the wrong length, not none.
  if (numbers.rows() == 0) fail(StatusCode::SizeMismatch, std::string(name) + ": no values; pass one for each vertex");
  return {numbers.data(), numbers.data() + numbers.rows()};
}

CageModel created(const MeshLike& mesh, std::size_t targetTets, bool duplicateElements, bool fit,
                  const std::optional<ArrayLike>& stiffness, const std::optional<ArrayLike>& density,
                  const std::optional<ArrayLike>& damping, const Progress& progress) {
  const MeshModel model = meshOf(mesh);
  ProgressCall call(progress, "cage");
  CageOptions options;
  options.targetTets = targetTets;
  options.duplicateElements = duplicateElements;
  options.fit = fit;
  options.stiffness = mapValues(stiffness, "stiffness");
  options.density = mapValues(density, "density");
  options.damping = mapValues(damping, "damping");
  options.progress = call.function();
  CageReport report;
  Result<Cage> cage = released([&] { return createCage(*model.mesh, options, &report); });
  call.rethrow();
  return cageModel(take(std::move(cage)), report.describe());
}

CageModel calibrated(const CageModel& model, double poissonRatio, int modeCount, const Progress& progress) {
  ProgressCall call(progress, "calibration");
  CalibrationOptions options;
  options.poissonRatio = poissonRatio;
  options.modeCount = modeCount;
  options.progress = call.function();
  Cage cage = *model.cage;
  const Result<CalibrationReport> report = released([&] { return calibrate(cage, options); });
  call.rethrow();
  check(report.status());
  return cageModel(std::move(cage), model.cage->report + report.value().describe());
}

CageModel painted(const CageModel& model, const MeshLike& mesh, const std::optional<ArrayLike>& stiffness,
                  const std::optional<ArrayLike>& density, const std::optional<ArrayLike>& damping) {
  const MeshModel surface = meshOf(mesh);
  const PaintedMaps maps{mapValues(stiffness, "stiffness"), mapValues(density, "density"),
                         mapValues(damping, "damping")};
  Cage cage = *model.cage;
  check(released([&] { return paintCage(cage, *surface.mesh, maps); }));
  return cageModel(std::move(cage), model.cage->report);
}

std::pair<Column<double>, Column<double>> spreadOver(const CageModel& model, const MeshLike& mesh,
                                                     const ArrayLike& values, bool geometric) {
  const MeshModel surface = meshOf(mesh);
  nb::object array = nb::module_::import_("numpy").attr("asarray")(values.object);
  if (nb::cast<std::string>(array.attr("dtype").attr("kind")) == "b") array = array.attr("astype")("float64");
  const std::vector<double> numbers = mapValues(ArrayLike{array}, "values");
  const MapMean mean = geometric ? MapMean::Geometric : MapMean::Arithmetic;
  SpreadMap map = take(released([&] { return spreadMap(*model.cage, *surface.mesh, numbers, mean); }));
  return {newColumn(std::move(map.tets)), newColumn(std::move(map.nodes))};
}

CageModel quadratic(const CageModel& model) {
  return cageModel(take(refineQuadratic(*model.cage)));
}

/// A property that views one of a cage's arrays.
template <auto Member>
auto arrayOf() {
  return [](const CageModel& model) {
    const auto& values = (*model.cage).*Member;
    return view1(values.data(), values.size(), model.cage);
  };
}

}  // namespace

void bindCages(nb::module_& module) {
  Class<CageModel>(module, "Cage",
                   "Tets at rest, and data about the mesh in them. Immutable; can be pickled. An empty array means "
                   "that the data is unknown.")
      .words([](const CageModel& m) {
        const Cage& c = *m.cage;
        return counted(c.mesh.tetCount(), "tet", "tets") + ", " + counted(c.mesh.nodeCount(), "node", "nodes") +
               (c.quadraticTet.empty() ? "" : ", quadratic") + (c.stiffnessFactor.empty() ? "" : ", calibrated");
      })
      .pickled(cageOfBytes)
      .def(
          "__init__",
          [](CageModel* self, const ArrayLike& nodes, const ArrayLike& tets) {
            new (self) CageModel(made(nodes, tets));
          },
          "nodes"_a, "tets"_a,
          "A cage of tets alone. nodes: (n, 3) numbers, any unit; tets: (t, 4) integers; tets that are oriented "
          "negatively are reversed.")
      .def_prop_ro(
          "nodes", [](const CageModel& m) { return view3(viewOf(m.cage->mesh.nodes), m.cage); },
          "(n, 3) float64, rest space. A read-only view.")
      .def_prop_ro(
          "tets",
          [](const CageModel& m) {
            const std::size_t shape[2] = {m.cage->mesh.tetCount(), 4};
            return Row4<int>(m.cage->mesh.tets[0].data(), 2, shape, kept(m.cage));
          },
          "(t, 4) int32 node indices. A read-only view.")
      .def_prop_ro("vertex_tets", arrayOf<&Cage::vertexTets>(),
                   "(vertices,) int32: index of the tet that carries each vertex. A read-only view.")
      .def_prop_ro("volume_fraction", arrayOf<&Cage::volumeFraction>(),
                   "(t,) float64, 0 to 1: fraction of the tet's volume inside the mesh. A read-only view.")
      .def_prop_ro("stiffness_factor", arrayOf<&Cage::stiffnessFactor>(),
                   "(t,) float64: multiplies the stiffness; see calibrate. A read-only view.")
      .def_prop_ro("painted_stiffness", arrayOf<&Cage::paintedStiffness>(),
                   "(t,) float64, or none: factors of the stiffness from a painted map. A read-only view.")
      .def_prop_ro("painted_density", arrayOf<&Cage::paintedDensity>(),
                   "(t,) float64, or none: factors of the density, which masses contain. A read-only view.")
      .def_prop_ro("painted_damping", arrayOf<&Cage::paintedDamping>(),
                   "(t,) float64, or none: factors of the damping. A read-only view.")
      .def_prop_ro("masses", arrayOf<&Cage::masses>(),
                   "(n,) float64, for a density of 1: their sum is the mesh's volume, or the integral of its painted "
                   "density. A read-only view.")
      .def_prop_ro("component", arrayOf<&Cage::component>(), "(t,) int32: component of the cage. A read-only view.")
      .def_prop_ro("source_tet", arrayOf<&Cage::sourceTet>(),
                   "(t,) int32: equal for all duplicates of one tet. A read-only view.")
      .def_prop_ro(
          "quadratic_tet", arrayOf<&Cage::quadraticTet>(),
          "(t,) int32: number of the quadratic tet that the tet is an eighth of; -1: linear. A read-only view.")
      .def_prop_ro(
          "node_count", [](const CageModel& m) { return m.cage->mesh.nodeCount(); }, "Number of nodes.")
      .def_prop_ro(
          "tet_count", [](const CageModel& m) { return m.cage->mesh.tetCount(); }, "Number of tets.")
      .def_prop_ro(
          "report", [](const CageModel& m) { return m.cage->report; },
          "A text on how it was made, and how well it fits. Empty for a cage from a file or arrays.")
      .def(
          "save",
          [](const CageModel& m, const PathLike& path) {
            released([&, name = path.text()] { check(saveCage(*m.cage, name)); });
          },
          "path"_a, "Writes a .vtk file, with all data of the cage, or the tets alone as .node and .ele.")
      .def(
          "scaled",
          [](const CageModel& m, double scale) {
            if (!(scale > 0.0 && scale < Limits::kMaxCoordinate))
              throw nb::value_error("scale: must be above 0, and finite");
            Cage cage = *m.cage;
            cage.scaleBy(scale);
            check(validate(cage));
            return cageModel(std::move(cage), m.cage->report);
          },
          "scale"_a, "A copy of another size, with masses to match.");

  module.def(
      "create_cage", created, "mesh"_a, nb::kw_only(), "target_tets"_a = 3000, "duplicate_elements"_a = true,
      "fit"_a = true, "stiffness"_a = nb::none(), "density"_a = nb::none(), "damping"_a = nb::none(),
      "progress"_a.none() = nb::none(),
      "Builds a cage of about target_tets tets that contains every vertex of the mesh's triangles. The same input "
      "gives the same cage. Takes about half a second for 60,000 triangles; the GIL is released.\n\n"
      "duplicate_elements: if regions of the mesh are less than a tet apart, each gets its own copy of the tet. fit: "
      "move boundary nodes towards the surface. stiffness, density, damping: (vertices,) factors above 0 (damping: "
      "or 0), painted on the mesh: see paint_cage. progress: called with the fraction done, from 0 to 1; returns False "
      "to "
      "cancel, which raises an Error with the code CANCELLED; an exception in it is raised. True: prints a bar. "
      "Ctrl-C, or a notebook's interrupt button, always cancels.");
  module.def(
      "calibrate", calibrated, "cage"_a, nb::kw_only(), "poisson_ratio"_a = 0.3, "mode_count"_a = 6,
      "progress"_a.none() = nb::none(),
      "A copy of the cage with stiffness factors that make it as compliant as the real body: coarse tets are too "
      "stiff. Takes about two seconds for 3,000 tets; the GIL is released.\n\n"
      "poisson_ratio: 0 to below 0.5, of the material that will be simulated. mode_count: number of vibrations to "
      "compare. progress: as in create_cage.");
  module.def(
      "paint_cage", painted, "cage"_a, "mesh"_a, nb::kw_only(), "stiffness"_a = nb::none(), "density"_a = nb::none(),
      "damping"_a = nb::none(),
      "A copy of the cage with maps painted on its mesh, or on a level of detail of it: (vertices,) factors above "
      "0, of the damping also 0, which replace those before; None leaves them. The inside has the values of the "
      "nearest surface. "
      "Calibrate after painting.");
  module.def("spread_map", spreadOver, "cage"_a, "mesh"_a, "values"_a, nb::kw_only(), "geometric"_a = false,
             "Any map of (vertices,) numbers, or a mask of booleans, averaged over what each tet holds: (t,) and (n,) "
             "float64, by tet and by node. geometric: by logarithms, as the stiffness. For nodes to pin: those of at "
             "least 0.5 of a mask.");
  module.def("refine_quadratic", quadratic, "cage"_a,
             "A cage of quadratic tets: each tet of the cage becomes one, stored as eight. For meshes that fill their "
             "body.");
  module.def(
      "load_cage",
      [](const PathLike& path) { return cageModel(released([name = path.text()] { return take(loadCage(name)); })); },
      "path"_a, "Reads files of Cage.save, and tets from .vtk, .node and .ele files.");
}

}  // namespace tetskin::python
