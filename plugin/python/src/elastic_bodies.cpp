// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::python {
namespace {

void make(ElasticModel* self, const CageModel& cage, double youngsModulus, double poissonRatio, double stiffnessDamping,
          double density, double tolerance, int maxIterations, bool deterministic) {
  ElasticOptions options;
  options.youngsModulus = youngsModulus;
  options.poissonRatio = poissonRatio;
  options.stiffnessDamping = stiffnessDamping;
  options.density = density;
  options.tolerance = tolerance;
  options.maxIterations = maxIterations;
  options.deterministic = deterministic;
  new (self) ElasticModel{std::make_shared<ElasticBody<double>>(
                              released([&] { return take(ElasticBody<double>::create(*cage.cage, options)); })),
                          cage.cage->mesh.tetCount()};
}

void assign(PointView<double> target, const ArrayLike& array, const char* name) {
  const Numbers<double> numbers(array, name, 3);
  if (numbers.rows() != target.size()) {
    fail(StatusCode::SizeMismatch, std::string(name) + ": " + std::to_string(numbers.rows()) + " for " +
                                       std::to_string(target.size()) + " nodes");
  }
  const PointView<const double> points(numbers.data(), numbers.rows());
  if (firstUnusable(points) != points.size())
    fail(StatusCode::NonFinite, std::string(name) + ": a number is not finite, or larger than 1e18");
  for (std::size_t i = 0; i < points.size(); ++i) std::copy(points[i], points[i] + 3, target[i]);
}

}  // namespace

Class<ElasticModel> bindElasticBodies(nb::module_& module) {
  Class<ElasticModel> body(module, "ElasticBody",
                           "A body of elastic tets by itself, without contact, for use in any engine.");
  body.words([](const ElasticModel& m) { return counted(m.body->nodeCount(), "node", "nodes"); })
      .def("__init__", make, "cage"_a, nb::kw_only(), "youngs_modulus"_a = 1e5, "poisson_ratio"_a = 0.3,
           "stiffness_damping"_a = 0.0, "density"_a = 1.0, "tolerance"_a = 5e-3, "max_iterations"_a = 200,
           "deterministic"_a = false,
           "youngs_modulus: pressure units, above 0; poisson_ratio: 0 to below 0.5; stiffness_damping: seconds; "
           "density: mass per "
           "volume, above 0; tolerance: residual of a step relative to that at its start.")
      .def_prop_ro(
          "node_count", [](const ElasticModel& m) { return m.body->nodeCount(); }, "Number of nodes.")
      .def_prop_rw(
          "positions", [](const ElasticModel& m) { return view3<double>(m.body->positions(), m.body); },
          [](ElasticModel& m, const ArrayLike& array) { assign(m.body->positions(), array, "positions"); },
          "(n, 3) float64, world space. A read-only view, which each step overwrites; assign an array to move nodes.")
      .def_prop_rw(
          "velocities", [](const ElasticModel& m) { return view3<double>(m.body->velocities(), m.body); },
          [](ElasticModel& m, const ArrayLike& array) { assign(m.body->velocities(), array, "velocities"); },
          "(n, 3) float64, world length per second. A read-only view, which each step overwrites; assign an array.")
      .def(
          "set_pinned",
          [](ElasticModel& m, const ArrayLike& nodes, bool pinned) {
            for (const int node : indicesOf(nodes, "nodes", m.body->nodeCount()))
              m.body->setPinned(static_cast<std::size_t>(node), pinned);
          },
          "nodes"_a, "pinned"_a = true, "Pins or releases nodes: a mask of n booleans, or indices.")
      .def(
          "step",
          [](ElasticModel& m, double dt, const Vec3& acceleration) {
            if (!(dt >= 0.0 && dt <= 1e6)) throw nb::value_error("dt: must be 0 or more, and finite");
            finite(acceleration, "acceleration");
            if (dt == 0.0) return 0;
            return m.body->step(dt, acceleration);
          },
          "dt"_a, "acceleration"_a = Vec3{},
          "Advances by dt seconds; returns the number of iterations: 0 for 0 seconds. acceleration: of all nodes that "
          "are not pinned, such as gravity.")
      .def(
          "forces",
          [](ElasticModel& m) {
            std::vector<double> rows;
            for (const auto& force : m.body->forces()) rows.insert(rows.end(), force.begin(), force.end());
            return newRows3(std::move(rows));
          },
          "(n, 3) float64 elastic forces at the current positions. A new array.")
      .def_prop_ro(
          "energy", [](ElasticModel& m) { return m.body->energy(); }, "Elastic energy at the current positions.");
  return body;
}

}  // namespace tetskin::python
