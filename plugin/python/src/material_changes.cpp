// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plastic flow, growth and muscles: the same for a body in a world and for one by itself.
#include "handles.h"

#include <tetskin/elastic/elastic_body.h>

namespace tetskin::python {
namespace {

// Where the two kinds of bodies differ.
DeformableBody& changeable(BodyHandle& body) {
  return alive(body);
}
ElasticBody<double>& changeable(ElasticModel& body) {
  return *body.body;
}
std::size_t tetCount(const BodyHandle& body) {
  return body.state->cage->mesh.tetCount();
}
std::size_t tetCount(const ElasticModel& body) {
  return body.tets;
}
template <class Call>
auto guarded(BodyHandle& body, Call&& call) {
  const Locked lock(*body.world);
  return call();
}
template <class Call>
auto guarded(ElasticModel&, Call&& call) {
  return call();
}

/// One number for all, or an array of one by tet.
std::vector<double> numbersOf(const nb::object& given, const char* name) {
  double one = 0.0;
  if (nb::try_cast(given, one)) return {one};
  const Numbers<double> numbers(ArrayLike{given}, name, 0);
  return {numbers.data(), numbers.data() + numbers.rows()};
}

template <class Body>
void setPlasticity(Body& body, const std::optional<nb::object>& yieldStress, double hardening,
                   const std::optional<double>& flowRate, const std::optional<double>& largest) {
  if (!yieldStress) return guarded(body, [&] { check(changeable(body).endPlasticity()); });
  Plasticity plasticity;
  const std::vector<double> stresses = numbersOf(*yieldStress, "yield_stress");
  double one = 0.0;
  if (nb::try_cast(*yieldStress, one)) {
    plasticity.yieldStress = one;
  } else {
    plasticity.yieldStresses = stresses;
  }
  plasticity.hardening = hardening;
  if (flowRate) plasticity.flowRate = *flowRate;
  if (largest) plasticity.largestStrain = *largest;
  guarded(body, [&] { check(changeable(body).setPlasticity(plasticity)); });
}

int dimensionsOf(const nb::object& array) {
  return nb::cast<int>(nb::module_::import_("numpy").attr("ndim")(array));
}

template <class Body>
void setGrowth(Body& body, const nb::object& growth) {
  double one = 0.0;
  if (nb::try_cast(growth, one)) return guarded(body, [&] { check(changeable(body).setGrowth(one)); });
  if (dimensionsOf(growth) == 1) {
    const std::vector<double> lengths = numbersOf(growth, "growth");
    return guarded(body, [&] { check(changeable(body).setGrowth(lengths)); });
  }
  const nb::module_ numpy = nb::module_::import_("numpy");
  const auto shape = nb::cast<std::vector<std::size_t>>(nb::list(numpy.attr("shape")(growth)));
  if (shape.size() != 3 || shape[1] != 3 || shape[2] != 3) {
    fail(StatusCode::SizeMismatch, "growth: a factor, one by tet (tets,), or matrices (tets, 3, 3)");
  }
  const Numbers<double> numbers(ArrayLike{numpy.attr("reshape")(growth, nb::make_tuple(-1, 9))}, "growth", 9);
  std::vector<std::array<double, 9>> tensors(numbers.rows());
  for (std::size_t t = 0; t < tensors.size(); ++t) std::copy_n(numbers.data() + 9 * t, 9, tensors[t].begin());
  guarded(body, [&] { check(changeable(body).setGrowthTensors(tensors)); });
}

/// A muscle of a body, which keeps it.
template <class Body>
struct MuscleOf {
  Body body;
  int number = 0;
};

/// One direction (3,), or rows of them.
std::vector<Eigen::Vector3d> directionsOf(const ArrayLike& array, const char* name) {
  const ArrayLike rows{dimensionsOf(array.object) == 1
                           ? nb::module_::import_("numpy").attr("reshape")(array.object, nb::make_tuple(1, -1))
                           : array.object};
  const Numbers<double> numbers(rows, name, 3);
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t k = 0; k < numbers.rows(); ++k)
    directions.emplace_back(Eigen::Vector3d::Map(numbers.data() + 3 * k));
  return directions;
}

template <class Body>
MuscleOf<Body> addMuscle(Body& body, const ArrayLike& tets, const ArrayLike& fibres, double stress,
                         const std::optional<ArrayLike>& lengthFactors) {
  Muscle muscle;
  muscle.tets = indicesOf(tets, "tets", tetCount(body));
  muscle.stress = stress;
  muscle.fibres = directionsOf(fibres, "fibres");
  if (lengthFactors) {
    const Numbers<double> points(*lengthFactors, "length_factors", 2);
    for (std::size_t k = 0; k < points.rows(); ++k)
      muscle.lengthFactors.push_back({points.data()[2 * k], points.data()[2 * k + 1]});
  }
  return {body, guarded(body, [&] { return take(changeable(body).addMuscle(muscle)); })};
}

template <class Body>
void addFibres(Body& body, const ArrayLike& tets, const ArrayLike& directions, double stiffness, bool tensionOnly) {
  const Fibres fibres{indicesOf(tets, "tets", tetCount(body)), directionsOf(directions, "directions"), stiffness,
                      tensionOnly};
  guarded(body, [&] { check(changeable(body).addFibres(fibres)); });
}

ElasticLaw lawOf(const std::string& name, double c2, double c3) {
  return {facade::valueOf(facade::Choice<ElasticLaw::Kind>{name}), c2, c3};
}

template <class Body>
void setElasticLaw(Body& body, const std::string& law, double c2, double c3, const std::optional<ArrayLike>& tets) {
  const ElasticLaw wanted = lawOf(law, c2, c3);
  std::vector<int> some;
  if (tets) {
    some = indicesOf(*tets, "tets", tetCount(body));
    if (some.empty()) return check(checkElasticLaw(wanted));
  }
  guarded(body, [&] { check(changeable(body).setElasticLaw(wanted, some)); });
}

nb::typed<nb::dict, nb::str, double> fitted(const std::string& law, const ArrayLike& points,
                                            const std::string& loading) {
  const Numbers<double> numbers(points, "points", 2);
  const Loading how = facade::valueOf(facade::Choice<Loading>{loading});
  std::vector<StressPoint> curve;
  for (std::size_t k = 0; k < numbers.rows(); ++k)
    curve.push_back({numbers.data()[2 * k], numbers.data()[2 * k + 1], how});
  const FittedLaw fit = take(fitElasticLaw(lawOf(law, 0.0, 0.0).kind, curve));
  nb::dict found;
  found["youngs_modulus"] = fit.youngsModulus;
  found["c2"] = fit.law.c2;
  found["c3"] = fit.law.c3;
  found["error"] = fit.error;
  return found;
}

template <class Body>
void bindMuscle(nb::module_& module, const char* name) {
  Class<MuscleOf<Body>>(module, name, "Tets of a body that contract along their fibres. Made by add_muscle.")
      .words([](const MuscleOf<Body>& m) { return "number " + std::to_string(m.number); })
      .def_prop_rw(
          "activation",
          [](MuscleOf<Body>& m) { return guarded(m.body, [&] { return changeable(m.body).activation(m.number); }); },
          [](MuscleOf<Body>& m, double activation) {
            guarded(m.body, [&] { check(changeable(m.body).setActivation(m.number, activation)); });
          },
          "0 to 1, at first 0: the share of its stress with which it pulls.");
}

template <class Body>
void bind(Class<Body>& type) {
  type.def("set_plasticity", setPlasticity<Body>, "yield_stress"_a.none(), "hardening"_a = 0.0,
           "flow_rate"_a.none() = nb::none(), "largest"_a.none() = nb::none(),
           "Lets the material flow where it yields. yield_stress: pressure units, above 0: the von Mises stress, which "
           "is that of a pulled bar; a number, or one by tet; None: nothing flows any more. hardening: pressure units: "
           "by how much it grows per plastic strain. flow_rate: per second, at which what is beyond it flows; None: at "
           "once. largest: the largest plastic strain that may remain, logarithmic; None: 3, a stretch by 20.")
      .def(
          "reset_plastic_flow", [](Body& b) { guarded(b, [&] { check(changeable(b).resetPlasticFlow()); }); },
          "The body returns to its first shape; it flows again when it has been there, below its yield stress, for "
          "half a second.")
      .def_prop_ro(
          "plastic_strains",
          [](Body& b) { return newColumn(guarded(b, [&] { return changeable(b).plasticStrains(); })); },
          "(tets,) float64: how much each tet has flowed in all, to and fro. A new array.")
      .def("set_growth", setGrowth<Body>, "growth"_a,
           "Makes tets grow to multiples of their first size, at which they are at rest; masses stay. growth: a factor "
           "of length, one by tet (tets,), or symmetric matrices (tets, 3, 3); 0.05 to 20, 1: none.")
      .def(
          "set_stiffness_scale",
          [](Body& b, const ArrayLike& factors) {
            const std::vector<double> byTet = numbersOf(factors.object, "factors");
            guarded(b, [&] { check(changeable(b).setStiffnessScale(byTet)); });
          },
          "factors"_a,
          "Multiplies the stiffness of each tet, as it was when the body was made: (tets,), 1e-6 to 1e6. A large "
          "change in one step is a blow to a body under load.")
      .def(
          "set_damping_scale",
          [](Body& b, const ArrayLike& factors) {
            const std::vector<double> byTet = numbersOf(factors.object, "factors");
            guarded(b, [&] { check(changeable(b).setDampingScale(byTet)); });
          },
          "factors"_a, "Multiplies the damping of each tet, on top of what is painted in its cage: (tets,), 0 or more.")
      .def("set_elastic_law", setElasticLaw<Body>, "law"_a, "c2"_a = 0.0, "c3"_a = 0.0, "tets"_a.none() = nb::none(),
           "How stress follows from large strains: 'corotated' (linear in the strain), 'neo-hookean', or 'yeoh', which "
           "stiffens when it is pulled, as rubber and flesh do, with C20 / C10 = c2 and C30 / C10 = c3: see "
           "fit_elastic_law. Small strains are the same with each. tets: a mask or indices; None: all.")
      .def("add_fibres", addFibres<Body>, "tets"_a, "directions"_a, "stiffness"_a, "tension_only"_a = false,
           "Adds fibres that make tets stiffer along them, for good. tets: a mask or indices. directions: rest space: "
           "one (3,), or one for each of these tets (n, 3). stiffness: pressure units: their tension on the area at "
           "rest per strain. tension_only: nothing resists where they become shorter, as a rope.")
      .def("add_muscle", addMuscle<Body>, "tets"_a, "fibres"_a, "stress"_a = 3e5, "length_factors"_a = nb::none(),
           "Adds a muscle, which is relaxed: set its activation. tets: a mask or indices. fibres: directions, rest "
           "space: one (3,), or one for each of its tets (n, 3). stress: pressure units: its tension at activation 1 "
           "and its rest length. length_factors: (points, 2) stretches along it, ascending, and factors of the tension "
           "there, linear between them: it then pulls at any length by them, beside its elasticity.");
}

}  // namespace

void bindMaterialChanges(nb::module_& module, Class<BodyHandle>& body, Class<ElasticModel>& elastic) {
  const auto fibresOf = [](const CageModel& cage, const ArrayLike& tets, const ArrayLike& curve) {
    const TetMesh& mesh = cage.cage->mesh;
    const std::vector<int> indices = indicesOf(tets, "tets", mesh.tetCount());
    const Numbers<double> numbers(curve, "curve", 3);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t k = 0; k < numbers.rows(); ++k) points.emplace_back(Eigen::Vector3d::Map(numbers.data() + 3 * k));
    std::vector<double> rows;
    for (const Eigen::Vector3d& fibre : take(fibresAlong(mesh, indices, points))) {
      rows.insert(rows.end(), fibre.data(), fibre.data() + 3);
    }
    return newRows3(std::move(rows));
  };
  module.def(
      "fibres_along", fibresOf, "cage"_a, "tets"_a, "curve"_a,
      "(n, 3) float64 fibres for add_muscle: for each of n tets (a mask or indices) the direction of the nearest "
      "piece of a curve of points (m, 3), rest space. Of two points: the axis between them. A new array.");
  module.def(
      "fit_elastic_law", fitted, "law"_a, "points"_a, "loading"_a = "uniaxial",
      "The law that meets a measured curve best, by relative errors, as a dict: youngs_modulus, c2, c3 and error, "
      "the root mean square. points: (n, 2) stretches (length over length at rest) and nominal stresses (force "
      "over area at rest), of one loading: 'uniaxial', 'equibiaxial' or 'planar'.");
  bindMuscle<BodyHandle>(module, "Muscle");
  bindMuscle<ElasticModel>(module, "ElasticMuscle");
  bind(body);
  bind(elastic);
}

}  // namespace tetskin::python
