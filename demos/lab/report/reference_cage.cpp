// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/reference_cage.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>

#include <algorithm>
#include <cassert>

#include "report/quadratic_cage.h"
#include "scenes/caged_mesh.h"

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

}  // namespace

ReferenceSource referenceFor(const TriangleMesh& mesh, const ReportOptions& options,
                             const scenes::Placement& placement) {
  ReferenceSource source;
  source.tets = options.referenceTets;
  if (!options.reference.empty()) {
    Cage cage = scenes::loadCage(options.reference);
    (void)repairTetMesh(cage.mesh);
    requireFit(mesh, cage, options);
    source.from = options.reference;
    source.cage = placement.toWorld(std::move(cage));
    source.tets = source.cage->mesh.tetCount();
  } else if (Filling filling = fillingFor(options.model, placement)) {
    source.fewest = scenes::fewestConformingTets(options.model.builtIn);
    if (options.referenceTets >= source.fewest) {
      source.from = kFormula;
      source.filling = std::move(filling);
      source.tets =
          kSubTets * source.filling(std::max(options.referenceTets / kSubTets, source.fewest)).mesh.tetCount();
    }
  }
  requireFiner(options, source.tets);
  return source;
}

std::string describe(const ReferenceSource& source) {
  const std::string tets = std::to_string(source.tets) + " tets";
  if (source.from == kBuilt) return "a built cage of about " + tets;
  return tets + (source.from == kFormula ? " by formula" : " from " + source.from);
}

std::size_t ReferenceShelf::elementsAt(ReferenceTets tets, int level) const {
  std::size_t count = tets == ReferenceTets::Quadratic ? source_.tets / kSubTets : source_.tets;
  for (int k = 0; k < level; ++k) count /= kLevelRatio;
  return count;
}

int ReferenceShelf::levelCount(ReferenceTets tets) const {
  if (source_.cage) return 1;
  int levels = 1;
  while (levels < kLevels && elementsAt(tets, levels) >= std::max<std::size_t>(source_.fewest, 1)) ++levels;
  return levels;
}

ShelvedCage ReferenceShelf::made(ReferenceTets tets, int level) const {
  if (source_.cage) return shelved(*source_.cage, false);
  CageOptions options;
  options.targetTets = elementsAt(tets, level);
  options.fit = false;
  Cage cage = source_.filling ? source_.filling(options.targetTets) : scenes::builtCage(mesh_, options);
  if (tets == ReferenceTets::Quadratic) return shelved(quadraticCage(cage, mesh_), false);
  return shelved(std::move(cage), true);
}

const ShelvedCage& ReferenceShelf::at(ReferenceTets tets, int level) {
  assert(level >= 0 && level < levelCount(tets));
  const auto found = cages_.find({tets, level});
  if (found != cages_.end()) return found->second;
  return cages_[{tets, level}] = made(tets, level);
}

}  // namespace tetskin::report
