// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/body/body_in_world.h>

#include <array>
#include <vector>

namespace tetskin {

using namespace bullet_detail;

double DeformableBody::youngsModulus() const {
  return impl_->material.youngsModulus;
}
double DeformableBody::relativeStiffness() const {
  return impl_->material.youngsModulus / impl_->weightPressure;
}
double DeformableBody::poissonRatio() const {
  return impl_->material.poissonRatio;
}
double DeformableBody::stiffnessDamping() const {
  return impl_->material.damping;
}

Status DeformableBody::setYoungsModulus(double pressure) {
  return impl_->set({pressure, poissonRatio(), stiffnessDamping()});
}

Status DeformableBody::setPoissonRatio(double ratio) {
  return impl_->set({youngsModulus(), ratio, stiffnessDamping()});
}

Status DeformableBody::setStiffnessDamping(double seconds) {
  return impl_->set({youngsModulus(), poissonRatio(), seconds});
}

Status DeformableBody::setPlasticity(const Plasticity& plasticity) {
  return impl_->changeSettings("plasticity", [&](auto& changes) { return changes.setPlasticity(plasticity); });
}

Status DeformableBody::endPlasticity() {
  return impl_->changeSettings("plasticity", [](auto& changes) {
    changes.endPlasticity();
    return Status();
  });
}

Status DeformableBody::resetPlasticFlow() {
  return impl_->changeMaterial("plasticity", [](ElasticForce& elastic) {
    elastic.body().dynamics->tets()->forgetFlow();
    return Status();
  });
}

std::vector<double> DeformableBody::plasticStrains() const {
  ElasticForce* elastic = impl_->corotated();
  if (!elastic) return std::vector<double>(static_cast<std::size_t>(body().m_tetras.size()), 0.0);
  return elastic->body().dynamics->tets()->plasticStrains(elastic->body().tetCount);
}

Status DeformableBody::setGrowth(double length) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowth(length); });
}

Status DeformableBody::setGrowth(const std::vector<double>& lengths) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowth(lengths); });
}

Status DeformableBody::setGrowthTensors(const std::vector<std::array<double, 9>>& deformations) {
  return impl_->changeShapes("growth", [&](auto& changes) { return changes.setGrowthTensors(deformations); });
}

Status DeformableBody::setStiffnessScale(const std::vector<double>& factors) {
  return impl_->changeStiffness("stiffness by tet", [&](auto& changes) { return changes.setStiffnessScale(factors); });
}

Status DeformableBody::setDampingScale(const std::vector<double>& factors) {
  return impl_->changeStiffness("damping by tet", [&](auto& changes) { return changes.setDampingScale(factors); });
}

Status DeformableBody::setElasticLaw(const ElasticLaw& law, const std::vector<int>& tets) {
  return impl_->changeSettings("an elastic law", [&](auto& changes) { return changes.setElasticLaw(law, tets); });
}

Status DeformableBody::addFibres(const Fibres& fibres) {
  return impl_->changeStiffness("fibres", [&](auto& changes) { return changes.addFibres(fibres); });
}

Result<int> DeformableBody::addMuscle(const Muscle& muscle) {
  int number = 0;
  Status status = impl_->changeShapes("a muscle", [&](auto& changes) {
    const Result<int> added = changes.addMuscle(muscle);
    if (added.ok()) number = added.value();
    return added.ok() ? Status() : added.status();
  });
  if (!status.ok()) return status;
  return number;
}

Status DeformableBody::setActivation(int muscle, double activation) {
  if (activation > 0.0 && this->activation(muscle) == activation) return {};
  return impl_->changeShapes("a muscle", [&](auto& changes) { return changes.setActivation(muscle, activation); });
}

double DeformableBody::activation(int muscle) const {
  ElasticForce* elastic = impl_->corotated();
  return elastic ? elastic->body().changes.activation(muscle) : 0.0;
}

}  // namespace tetskin
