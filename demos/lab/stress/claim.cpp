// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/claim.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

constexpr double kModuli[] = {1, 1e3, 1e5, 1e7, 1e9}, kDensities[] = {0, 1000}, kDampings[] = {0, 0.02};
constexpr double kSpins[] = {0, 0.1, 1, 10}, kSteps[] = {1.0 / 60, 1.0 / 240, 1.0 / 1000}, kTolerances[] = {5e-3, 1e-6};
constexpr Claim::Shape kShapes[] = {Claim::Shape::Sphere, Claim::Shape::Bar, Claim::Shape::Serpent};
constexpr ClaimEvent kClaimEvents[] = {ClaimEvent::Free, ClaimEvent::Landing, ClaimEvent::Dragged};

/// The index of the value of each kind.
using Choice = std::vector<int>;

Choice choiceOf(const Claim& claim) {
  const auto indexOf = [](const auto& values, const auto& value) {
    return static_cast<int>(std::find(std::begin(values), std::end(values), value) - std::begin(values));
  };
  return {static_cast<int>(claim.shape),         indexOf(kModuli, claim.youngsModulus),
          indexOf(kDensities, claim.density),    indexOf(kDampings, claim.damping),
          indexOf(kSpins, claim.spin),           indexOf(kSteps, claim.seconds),
          indexOf(kTolerances, claim.tolerance), static_cast<int>(claim.event)};
}

/// All subsets with this many of its values, each with its kind.
std::vector<Choice> groupsOf(const Choice& choice, std::size_t many) {
  std::vector<Choice> groups;
  for (int a = 0; a < static_cast<int>(choice.size()); ++a) {
    for (int b = 0; b < a; ++b) {
      const Choice pair{a, choice[static_cast<std::size_t>(a)], b, choice[static_cast<std::size_t>(b)]};
      if (many == 2) groups.push_back(pair);
      for (int c = 0; c < b && many == 3; ++c) {
        groups.push_back(pair);
        groups.back().insert(groups.back().end(), {c, choice[static_cast<std::size_t>(c)]});
      }
    }
  }
  return groups;
}

}  // namespace

std::string nameOf(const Claim& claim) {
  const char* const shapes[] = {"sphere", "bar", "serpent"};
  const char* const events[] = {"free", "landing", "dragged"};
  return std::string(events[static_cast<int>(claim.event)]) + "/" + shapes[static_cast<int>(claim.shape)] +
         "/E=" + text(claim.youngsModulus) + (claim.density > 0.0 ? "/" + text(claim.density) + "kg_m3" : "/1kg") +
         "/c=" + text(claim.damping) + "/spin=" + text(claim.spin) + "/dt=" + stepText(claim.seconds) +
         "/tol=" + text(claim.tolerance);
}

std::vector<Claim> allClaims() {
  std::vector<Claim> claims{{}};
  const auto forEach = [&](const auto& values, auto Claim::*member) {
    std::vector<Claim> more;
    for (const Claim& claim : claims) {
      for (const auto& value : values) {
        more.push_back(claim);
        more.back().*member = value;
      }
    }
    claims = std::move(more);
  };
  forEach(kClaimEvents, &Claim::event);
  forEach(kShapes, &Claim::shape);
  forEach(kModuli, &Claim::youngsModulus);
  forEach(kDensities, &Claim::density);
  forEach(kDampings, &Claim::damping);
  forEach(kSpins, &Claim::spin);
  forEach(kSteps, &Claim::seconds);
  forEach(kTolerances, &Claim::tolerance);
  return claims;
}

/// Each choice has the most pairs that no earlier one has; once all pairs occur, the most triples.
std::vector<Claim> chosenClaims(std::size_t count) {
  std::vector<Claim> left = allClaims(), chosen;
  std::set<Choice> seen;
  for (std::size_t many = 2; chosen.size() < count && !left.empty();) {
    auto best = left.end();
    std::size_t maximum = 0;
    for (auto claim = left.begin(); claim != left.end(); ++claim) {
      std::size_t fresh = 0;
      for (const Choice& group : groupsOf(choiceOf(*claim), many)) fresh += seen.count(group) == 0;
      if (fresh > maximum) {
        maximum = fresh;
        best = claim;
      }
    }
    if (maximum == 0) {
      if (many == 3) break;
      many = 3;
      continue;
    }
    for (std::size_t k : {2u, 3u}) {
      for (const Choice& group : groupsOf(choiceOf(*best), k)) seen.insert(group);
    }
    chosen.push_back(*best);
    left.erase(best);
  }
  return chosen;
}

void addClaims(Cases& cases) {
  constexpr std::size_t kChosen = 150, kQuick = 40;
  const auto add = [&](const Claim& claim, bool quick, bool lasts) {
    StressCase row = named("claim", {nameOf(claim)});
    row.force = Force::Elastic;
    row.claim = claim;
    row.stiffness = claim.youngsModulus;
    row.damping = claim.damping;
    row.timeStep = claim.seconds;
    row.substeps = 1;
    row.frames = static_cast<int>(std::lround(1.0 / claim.seconds));
    row.scene = "claim";
    row.quick = quick;
    row.lasts = lasts;
    cases.push_back(std::move(row));
  };
  std::size_t k = 0;
  for (const Claim& claim : chosenClaims(kChosen)) add(claim, k++ < kQuick, false);
  for (Claim claim : allClaims()) {
    claim.compared = false;
    add(claim, false, true);
  }
}

}  // namespace tetskin::stress
