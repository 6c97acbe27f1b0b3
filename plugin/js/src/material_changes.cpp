// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::js {
namespace {

/// stresses           one for all tets, or one for each
/// flowRate, largest  NaN: none
void setPlasticity(BodyHandle& body, Doubles stresses, double hardening, double flowRate, double largest) {
  Plasticity plasticity;
  if (stresses.count == 1) {
    plasticity.yieldStress = *stresses.begin();
  } else {
    plasticity.yieldStresses.assign(stresses.begin(), stresses.end());
  }
  plasticity.hardening = hardening;
  plasticity.flowRate = given(flowRate).value_or(plasticity.flowRate);
  plasticity.largestStrain = given(largest).value_or(plasticity.largestStrain);
  check(alive(*body.state).setPlasticity(plasticity));
}
void endPlasticity(BodyHandle& body) {
  check(alive(*body.state).endPlasticity());
}
void resetPlasticFlow(BodyHandle& body) {
  check(alive(*body.state).resetPlasticFlow());
}
View plasticStrains(BodyHandle& body) {
  return lent(alive(*body.state).plasticStrains());
}

/// growth  a factor, one for each tet, or nine numbers for each
void setGrowth(BodyHandle& body, Doubles growth) {
  DeformableBody& own = alive(*body.state);
  if (growth.count == 1) return check(own.setGrowth(*growth.begin()));
  if (growth.count != 9 * body.state->cage->mesh.tetCount()) {
    return check(own.setGrowth(std::vector<double>(growth.begin(), growth.end())));
  }
  std::vector<std::array<double, 9>> tensors(growth.count / 9);
  for (std::size_t k = 0; k < growth.count; ++k) tensors[k / 9][k % 9] = growth.begin()[k];
  check(own.setGrowthTensors(tensors));
}

void setStiffnessScale(BodyHandle& body, Doubles factors) {
  check(alive(*body.state).setStiffnessScale(std::vector<double>(factors.begin(), factors.end())));
}

void setDampingScale(BodyHandle& body, Doubles factors) {
  check(alive(*body.state).setDampingScale(std::vector<double>(factors.begin(), factors.end())));
}

std::vector<Eigen::Vector3d> directionsOf(Doubles numbers) {
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t k = 0; k + 3 <= numbers.count; k += 3)
    directions.emplace_back(Eigen::Vector3d::Map(numbers.begin() + k));
  return directions;
}

/// lengthFactors  pairs
int addMuscle(BodyHandle& body, Indices tets, Doubles fibres, Doubles lengthFactors, double stress) {
  Muscle muscle;
  muscle.tets.assign(tets.begin(), tets.end());
  muscle.fibres = directionsOf(fibres);
  for (std::size_t k = 0; k + 2 <= lengthFactors.count; k += 2)
    muscle.lengthFactors.push_back({lengthFactors.begin()[k], lengthFactors.begin()[k + 1]});
  muscle.stress = stress;
  return take(alive(*body.state).addMuscle(muscle));
}
void addFibres(BodyHandle& body, Indices tets, Doubles directions, double stiffness, bool tensionOnly) {
  check(alive(*body.state)
            .addFibres({std::vector<int>(tets.begin(), tets.end()), directionsOf(directions), stiffness, tensionOnly}));
}
/// tets  none: all
void setElasticLaw(BodyHandle& body, std::string name, double c2, double c3, Indices tets) {
  const ElasticLaw law{facade::valueOf(facade::Choice<ElasticLaw::Kind>{std::move(name)}), c2, c3};
  check(alive(*body.state).setElasticLaw(law, std::vector<int>(tets.begin(), tets.end())));
}
void setActivation(BodyHandle& body, int muscle, double activation) {
  check(alive(*body.state).setActivation(muscle, activation));
}
double activation(BodyHandle& body, int muscle) {
  return alive(*body.state).activation(muscle);
}

}  // namespace

EMSCRIPTEN_BINDINGS(material_changes) {
  expose<&setPlasticity>("setPlasticity");
  expose<&endPlasticity>("endPlasticity");
  expose<&resetPlasticFlow>("resetPlasticFlow");
  expose<&plasticStrains>("plasticStrains");
  expose<&setGrowth>("setGrowth");
  expose<&setStiffnessScale>("setStiffnessScale");
  expose<&setDampingScale>("setDampingScale");
  expose<&setElasticLaw>("setElasticLaw");
  expose<&addFibres>("addFibres");
  expose<&addMuscle>("addMuscle");
  expose<&setActivation>("setActivation");
  expose<&activation>("activation");
}

}  // namespace tetskin::js
