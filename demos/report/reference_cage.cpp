// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/reference_cage.h"

#include <tetskin/core/embedding.h>

#include "scenes/files.h"

namespace tetskin::report {
namespace {

/// Throws InputError if the tets are another model's.
void requireFit(const TriangleMesh& mesh, const Cage& cage, const ReportOptions& options) {
  scenes::ModelOptions model = options.model;
  model.cage = options.reference;
  EmbedReport report;
  const auto embedded = embed(cage.mesh, viewOf(mesh.positions), {}, &report);
  scenes::requireFit(embedded.status(), report, model);
}

template <class Value>
std::uint64_t hashOf(const std::vector<Value>& values, std::uint64_t seed) {
  return scenes::hashOf(values.data(), values.size() * sizeof(Value), seed);
}

std::uint64_t hashOf(const Cage& cage) {
  std::uint64_t hash = hashOf(cage.mesh.tets, hashOf(cage.mesh.nodes, scenes::kNoHash));
  hash = hashOf(cage.vertexTets, hash);
  for (const std::vector<double>* values : {&cage.volumeFraction, &cage.stiffnessFactor, &cage.masses})
    hash = hashOf(*values, hash);
  return hash;
}

}  // namespace

ReferenceCage referenceCageFor(const TriangleMesh& mesh, const ReportOptions& options,
                               const scenes::Placement& placement) {
  ReferenceCage reference;
  if (!options.reference.empty()) {
    Cage cage = scenes::loadCage(options.reference);
    (void)repairTetMesh(cage.mesh);
    requireFit(mesh, cage, options);
    reference.from = options.reference;
    reference.cage = std::move(cage);
  } else if (options.model.mesh.empty()) {
    reference.cage = scenes::conformingTets(options.model.builtIn, options.referenceTets);
    if (reference.cage) reference.from = kFormula;
  }
  reference.tets = options.referenceTets;
  if (reference.cage) {
    reference.cage = placement.toWorld(std::move(*reference.cage));
    reference.tets = reference.cage->mesh.tetCount();
    reference.hash = hashOf(*reference.cage);
  }
  requireFiner(options, reference.tets);
  return reference;
}

std::string describe(const ReferenceCage& reference) {
  const std::string tets = std::to_string(reference.tets) + " tets";
  std::string text = isBuilt(reference)           ? "a built cage of about " + tets
                     : reference.from == kFormula ? tets + " by formula"
                                                  : tets + " from " + reference.from;
  if (reference.factor == 1.0) return text;
  char factor[64];
  std::snprintf(factor, sizeof factor, ", calibrated (stiffness scaled by %.3f)", reference.factor);
  return text + factor;
}

}  // namespace tetskin::report
