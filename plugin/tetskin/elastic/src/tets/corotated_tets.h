// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Elastic forces of a body's tets, with a rotation for each linear one, and for each of four points of quadratic ones:
// see kernels/corotation.h, and kernels/hyperelasticity.h for other laws than the corotated one.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/core/types.h>
#include <tetskin/elastic/elastic_law.h>
#include <tetskin/elastic/material_changes.h>
#include <tetskin/elastic/src/tets/fibre_tets.h>
#include <tetskin/elastic/src/tets/material.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tetskin::elastic_detail {

/// Shapes at which tets are at rest beside their plastic flow.
struct GivenShapes {
  std::vector<std::array<double, 9>> shapes;  ///< deformation gradients from the first ones, by rows; empty: these
  /// Factors of the matrix, at least 1, where a shape that follows the deformation makes forces stiffer than the tet
  /// is; empty: 1
  std::vector<double> stiffer;
};

template <class S>
class TETSKIN_ELASTIC_API CorotatedTets {
 public:
  /// rest    not empty
  /// slotOf  by node: the index of its point
  CorotatedTets(RestTets rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots);

  const RestTets& rest() const { return rest_; }

  void setMaterial(const Lame& lame);
  /// See `elasticInUse`.
  void setDeterministic(bool on) { deterministic_ = on; }

  /// From now on, points are displacements in these frames; see TetWork. Not owned.
  void setFrames(const S* frames, const std::uint32_t* partOf) {
    frames_ = frames;
    partOf_ = partOf;
  }

  /// Elastic forces at `points`, both 4 scalars per slot; updates the tets' rotations.
  void forces(const S* points, S* out, ParallelFor* threads);
  /// The same, and the elastic energy at `points`, without changing anything.
  void probeForces(const S* points, S* out, ParallelFor* threads);
  double energy(const S* points, ParallelFor* threads);

  /// The rotation of tets since `cornersForMatrix`, in radians: root mean square over all rotations, and maximum.
  double meanTurn() const;
  double maxTurn() const;
  /// The least ratio of a tet's volume to that at rest in the last `forces`, at most 1.
  double flattest() const { return static_cast<double>(flattest_); }
  /// The corners for BlockMatrix::assemble, with the current rotations.
  /// flatAlpha  if larger than `alpha`: its value where tets were flat or inverted in the last `forces`, whose points
  ///            must still be there
  const S* cornersForMatrix(S alpha, ParallelFor* threads, S flatAlpha = 0);
  /// The same of a matrix without the tets that were flat or inverted in the last `forces`, to be replaced by one of
  /// `cornersForMatrix` in this step.
  const S* cornersWithoutFlat(S alpha, ParallelFor* threads);
  /// The same result again, for a matrix that is assembled from a snapshot's state.
  const S* cornersAgain(S alpha, ParallelFor* threads);
  /// Writes or reads the rotations.
  /// alpha     of the matrix
  /// ofMatrix  false: without those of the matrix, which will be assembled anew
  /// Returns   true if reading has changed the data from which the matrix is assembled
  bool serialize(StateStream& stream, S alpha, bool ofMatrix);

  // Rest shapes that change, see kernels/rest_change.h. Tets without any have no cost by it.
  /// Factors of the tets' stiffness beside those with which they were made, by tet of the cage; empty: 1. True if they
  /// are other ones than before: `setMaterial` must follow. Cost O(T)
  bool setStiffnessScale(const std::vector<double>& byTet);
  /// Gives shapes to all tets of the cage; none: the first ones. Plastic strains stay. Cost O(T)
  void setGiven(const GivenShapes& byTet);
  /// The same for some of them, once all are known.
  /// cageTets  these
  /// numbers   see `tetNumbers`
  /// given     in their order
  void changeGiven(const std::vector<int>& cageTets, const std::vector<std::uint32_t>& numbers,
                   const GivenShapes& given);
  bool knowsGiven() const { return !given_.shapes.empty(); }
  /// Some tet's forces are stiffer than the matrix counts, or many are less stiff.
  bool isStiffer() const { return isStiffer_ || lawsOutdated_ || (fibres_ && fibres_->outdated().stiffer); }
  /// Laws of the tets of the cage; empty: all are corotated. A quadratic tet has the mean of its parts. Cost O(T)
  void setLaws(const std::vector<ElasticLaw>& byTet);
  bool hasLaws() const { return !linear_.laws.empty() || !quadratic_.laws.empty(); }
  /// How much stiffer than at rest laws make the tets, in the mean, within a seventh: a time scheme that followed it
  /// exactly would need a new matrix in each step. 1 without laws.
  double countedLaws() const { return countedLaws_; }
  void countLaws() {
    constexpr double kSame = 1.15;  // ratio
    if (lawStiffening_ > kSame * countedLaws_ || countedLaws_ > kSame * lawStiffening_) countedLaws_ = lawStiffening_;
  }
  /// Of all tets at rest, if they have laws. Of quadratic ones, half of the height.
  double leastHeight() const { return leastHeight_; }
  /// Seconds of damping that tets have beside the least of their body, by tet of the cage; empty: none.
  void setExtraDamping(const std::vector<double>& byTet);
  /// Counts all this in the matrix from its next assembly on.
  /// perSecond  share of a tet's stiffness that a second of damping adds to the matrix
  void findFactors(double perSecond);
  /// The shares that extra damping has of the tets' parts in the matrix, of linear ones first. Cost O(T)
  std::vector<double> extraShares();
  /// The stiffness of the given shapes, and of the fibres, over that of the first shapes, in the mean.
  double stiffening() const;
  /// See FibreTets; empty: none. Call it again after the stiffness scale has changed.
  /// slotOf  by node
  void setFibres(const std::vector<std::vector<TetFibre>>& families, const std::vector<std::uint32_t>& slotOf);
  /// Those of the last corners.
  kernels::FibreLayers<S> fibreLayers() const { return fibres_ ? fibres_->layers() : kernels::FibreLayers<S>(); }
  /// plasticity  checked; null: nothing flows any more, and what has flowed stays. For this material: call it again
  ///             after `setMaterial`
  void setPlasticity(const Plasticity* plasticity);
  /// Undoes all plastic flow. Nothing flows until nothing has been beyond its yield surface for half a second.
  void forgetFlow();
  /// The seconds in which the next `forces` lets tets flow.
  void flowFor(double seconds);
  bool flows() const { return !returns_ && (!linear_.yields.empty() || !quadratic_.yields.empty()); }
  /// The share of what is beyond the yield stress that flows in some seconds.
  double flowShare(double seconds) const;
  /// The energy of all tets if each is pulled until it yields for the first time.
  double yieldEnergy() const { return yieldEnergy_; }
  /// Equivalent plastic strains since the beginning or `forgetFlow`, by tet of the cage. Cost O(T)
  std::vector<double> plasticStrains(std::size_t cageTets);

  /// lambda / mu, for BlockMatrix::assemble.
  S ratio() const { return ratio_; }

 private:
  /// The tets of one kind, packed, with their rotations.
  template <class Pack>
  struct Packed {
    AlignedVector<Pack> packs;
    AlignedVector<S> rotations, assembled;  ///< by pack and point
    AlignedVector<S> alphas;                ///< by pack and point, see TetWork; empty until some tet may be flat
    AlignedVector<S> changes, assembledChanges, given, yields, flowed;  ///< see TetWork; empty until they are needed
    std::vector<double> stiffer, extraDamping;                          ///< by tet in the packs; empty: 1, 0
    /// By tet in the packs: the volume of its given shape, and the squared norm of its inverse
    std::vector<std::array<double, 2>> stiffenings;
    AlignedVector<S> factors;           ///< see TetWork; empty: 1
    AlignedVector<S> laws, lawStiffer;  ///< see TetWork; empty: all are corotated
    std::size_t firstCorner = 0;
    std::size_t tasks = 0;
  };
  using Linear = Packed<kernels::TetPack<S>>;
  using Quadratic = Packed<kernels::QuadraticPack<S>>;

  template <class Pack>
  void makePacks(std::size_t tets, std::size_t firstCorner, Packed<Pack>& packed);
  void fillPacks(const std::vector<std::uint32_t>& slotOf);
  template <class Visit>
  void forBoth(Visit&& visit) {
    visit(linear_);
    visit(quadratic_);
  }
  template <class Visit>
  void forTets(Visit&& visit);
  template <class Visit>
  void forTet(std::size_t number, Visit&& visit);
  /// By how much extra damping makes a tet count more in the matrix.
  template <class Packed>
  double dampedFactor(const Packed& packed, std::size_t tet) const {
    return packed.extraDamping.empty() ? 1.0 : 1.0 + perSecond_ * packed.extraDamping[tet];
  }
  bool changes() const { return !linear_.changes.empty() || !quadratic_.changes.empty(); }
  void makeChanges();
  bool serializeFactors(StateStream& stream);
  template <class Tets>
  void setGiven(Tets& packed, std::size_t tet, const Eigen::Matrix3d& exact);
  void setStiffer();
  template <class Packs, class Tets>
  void setStiffer(Packs& packed, std::size_t tet, const Tets& cageTets);
  void findStiffening();
  void findLawStiffening();
  void findLeastHeight();
  /// Forces may be a quarter stiffer than the matrix.
  static bool isStale(double wanted, double inMatrix) { return wanted > 1.25 * inMatrix; }
  /// What a tet counts in the matrix over what it does at rest.
  template <class Packed>
  double matrixFactor(const Packed& packed, std::size_t tet) const {
    const double given = packed.stiffer.empty() ? 1.0 : packed.stiffer[tet];
    const double law = packed.lawStiffer.empty() ? 1.0 : static_cast<double>(packed.lawStiffer[tet]);
    return given * law * dampedFactor(packed, tet);
  }
  bool serializeChanges(StateStream& stream, bool ofMatrix);
  void listCorners(const std::vector<std::uint32_t>& slotOf);
  template <class Pack>
  kernels::TetWork<S, Pack> work(Packed<Pack>& packed, std::size_t task);
  template <class Pack>
  bool serializeAssembled(StateStream& stream, Packed<Pack>& packed);
  template <class Pack>
  bool serializeAlphas(StateStream& stream, S alpha, Packed<Pack>& packed);
  const S* corners(S alpha, S flatAlpha, const S* points, ParallelFor* threads);
  /// Calls kernel(work, its loops, number of the task) for all packs.
  template <class Kernel>
  void byPacks(ParallelFor* threads, Kernel&& kernel);
  template <class Query>
  void ask(Query&& query);
  /// sums  see TetWork
  double cornerForces(const S* points, S* sums, bool energy, ParallelFor* threads);

  RestTets rest_;
  GivenShapes given_;  ///< by tet of the cage, since the last `setGiven`; empty: not known
  std::optional<FibreTets<S>> fibres_;
  std::vector<double> madeVolumes_;  ///< of `rest_` as it was made, linear and quadratic; empty: it is as it was made
  Linear linear_;
  Quadratic quadratic_;
  AlignedVector<S> corners_;                             ///< see RestTets
  std::vector<std::uint32_t> cornerStarts_, cornersAt_;  ///< by slot: the corners whose forces it gets
  std::size_t slots_ = 0;
  bool deterministic_ = false;
  const S* points_ = nullptr;  ///< of the last `forces`
  const S* frames_ = nullptr;
  const std::uint32_t* partOf_ = nullptr;
  S ratio_ = 0;
  double mu_ = 0.0;
  double youngsModulus_ = 0.0, flowRate_ = 0.0, yieldEnergy_ = 0.0;
  S flowShare_ = 1, largestStrain_ = 0;  ///< see TetWork
  double stiffening_ = 1.0, lawStiffening_ = 1.0, countedLaws_ = 1.0, leastHeight_ = 0.0;
  bool lawsOutdated_ = false;  ///< see `isStiffer`
  bool isGiven_ = false;       ///< shapes other than the first ones
  bool isStiffer_ = false;     ///< see `isStiffer`
  double perSecond_ = 0.0;     ///< see `findFactors`
  bool everFlowed_ = false;    ///< it may have
  bool yields_ = false;        ///< some tet was beyond its yield surface in the last `forces`
  bool returns_ = false;       ///< since `forgetFlow`
  double calmSeconds_ = 0.0;   ///< of a body that returns: since then nothing was beyond it
  bool isAsked_ = false;       ///< within a question, which lets nothing flow
  S flatAlpha_ = 0;            ///< of the matrix, where tets were flat; 0: no such value
  S flattest_ = 1;
  S maxTurned_ = 0;      ///< squared difference of quaternions
  double turned_ = 0.0;  ///< sum of the squared differences, each a quarter of the squared angle
  std::vector<kernels::TetFindings<S>> findings_;  ///< by task
};

/// Calls visit(packed tets, index of a tet in its packs, tets of the cage that it is). The rest of the last pack
/// repeats the last tet.
template <class S>
template <class Visit>
void CorotatedTets<S>::forTets(Visit&& visit) {
  for (std::size_t number = 0; number < rest_.count() + rest_.quadratic.size(); ++number) forTet(number, visit);
}

/// The same for one tet, and what repeats it.
/// number  see `tetNumbers`
template <class S>
template <class Visit>
void CorotatedTets<S>::forTet(std::size_t number, Visit&& visit) {
  const auto visitAll = [&](auto& packed, std::size_t first, std::size_t count, const auto& cageTets) {
    const std::size_t end = first + 1 < count ? first + 1 : kernels::kGroup * packed.packs.size();
    for (std::size_t k = first; k < end; ++k) visit(packed, k, cageTets);
  };
  if (number < rest_.count()) {
    visitAll(linear_, number, rest_.count(), std::array<std::uint32_t, 1>{rest_.cageTets[number]});
  } else {
    const std::size_t q = number - rest_.count();
    visitAll(quadratic_, q, rest_.quadratic.size(), rest_.quadratic[q].cageTets);
  }
}

}  // namespace tetskin::elastic_detail
