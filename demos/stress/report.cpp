// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/report.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/summary.h"

namespace tetskin::stress {
namespace {

std::string simulationWord(const Verdict& verdict) {
  if (!verdict.simulationFinite) return "not finite";
  return verdict.simulationBounded ? "bounded" : "exploded";
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : "; ") + word;
  return all;
}

std::string hashWord(const Verdict& verdict) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, verdict.hash);
  return text;
}

std::string pinnedWord(const Verdict& verdict) {
  return verdict.passed() ? "passed" : "FAILED: " + joined(verdict.broken);
}

std::string cannotWord(const Row& row, const std::vector<Row>& rows) {
  const std::optional<bool> cannot = bulletCannot(row, rows);
  return !cannot ? "" : *cannot ? "yes" : "no";
}

/// One line per stiffness, one letter per time step.
void printMapOf(const std::vector<const Row*>& cells, const char* title) {
  std::printf("\n%s: stable (o) or not (x); rows: Young's modulus in Pa, columns: steps per second\n%10s", title, "");
  double stiffness = -1.0;
  for (const Row* cell : cells) {
    if (cell->stressCase.stiffness == cells.front()->stressCase.stiffness) {
      std::printf("%6.0f", 1.0 / cell->stressCase.timeStep);
    }
  }
  for (const Row* cell : cells) {
    if (cell->stressCase.stiffness != stiffness) {
      stiffness = cell->stressCase.stiffness;
      std::printf("\n%10.0e", stiffness);
    }
    std::printf("%6s", cell->verdict.simulationBounded ? "o" : "x");
  }
  std::printf("\n");
}

}  // namespace

std::optional<bool> bulletCannot(const Row& ours, const std::vector<Row>& rows) {
  bool any = false, bullet = false;
  for (const Row& row : rows) {
    if (!areTwins(ours.stressCase, row.stressCase)) continue;
    any = true;
    bullet = bullet || row.verdict.simulationBounded;
  }
  if (!any) return {};
  return ours.verdict.simulationBounded && !bullet;
}

nlohmann::ordered_json toJson(const std::vector<Row>& rows) {
  auto json = nlohmann::ordered_json::array();
  for (const Row& each : rows) {
    const auto& [stressCase, verdict] = each;
    nlohmann::ordered_json row;
    row["name"] = stressCase.name;
    row["group"] = stressCase.group;
    row["simulation_finite"] = verdict.simulationFinite;
    row["simulation_bounded"] = verdict.simulationBounded;
    row["skin_finite"] = verdict.skinFinite;
    row["status"] = verdict.status;
    row["amplification"] = verdict.amplification;
    row["rest_error"] = verdict.restError;
    row["shape_error"] = verdict.shapeError;
    row["normal_error"] = verdict.normalError;
    row["weight_error"] = verdict.weightError;
    row["extent_max"] = verdict.extentMax;
    row["lowest"] = verdict.lowest;
    row["rest_speed"] = verdict.restSpeed;
    row["energy"] = verdict.energy;
    row["energy_stored"] = verdict.energyStored;
    row["momentum_lost"] = verdict.momentumLost;
    row["expected"] = toString(stressCase.simulation);
    row["passed"] = verdict.passed();
    row["broken"] = verdict.broken;
    const std::optional<bool> cannot = bulletCannot(each, rows);
    row["bullet_cannot_tetskin_can"] = cannot ? nlohmann::ordered_json(*cannot) : nlohmann::ordered_json();
    row["hash"] = hashWord(verdict);
    row["milliseconds"] = verdict.milliseconds;
    scenes::tellSolve(verdict.solve, row);
    row["force"] = toString(stressCase.force);
    row["implicit"] = stressCase.implicit;
    row["stiffness"] = stressCase.stiffness;
    row["poisson"] = stressCase.poisson;
    row["damping"] = stressCase.damping;
    row["time_step"] = stressCase.timeStep;
    row["substeps"] = stressCase.substeps;
    row["event"] = stressCase.scene;
    row["harshness"] = stressCase.harshness;
    row["cage"] = toString(stressCase.cage);
    row["mesh"] = toString(stressCase.surface);
    row["interpolation"] = toString(stressCase.interpolation);
    row["normals"] = toString(stressCase.normals);
    json.push_back(std::move(row));
  }
  return json;
}

std::string toMarkdown(const std::vector<Row>& rows) {
  std::string text;
  std::string group;
  for (const Row& row : rows) {
    const auto& [stressCase, verdict] = row;
    if (stressCase.group != group) {
      group = stressCase.group;
      text += "\n## " + group +
              "\n\n| case | simulation | largest extent | surface | status | amplification | rest error | stable with "
              "tetskin "
              "only | expectations |\n|---|---|---|---|---|---|---|---|---|\n";
    }
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, " | %s | %.3g | %s | %s | %.4f | %.1e | ", simulationWord(verdict).c_str(),
                  verdict.extentMax, verdict.skinFinite ? "finite" : "not finite", verdict.status.c_str(),
                  verdict.amplification, verdict.restError);
    text += "| " + stressCase.name + numbers + cannotWord(row, rows) + " | " + pinnedWord(verdict) + " |\n";
  }
  return text;
}

void printRow(const Row& row, bool hash) {
  const Verdict& verdict = row.verdict;
  const std::string end = (hash ? hashWord(verdict) + "  " : "") + pinnedWord(verdict);
  if (row.stressCase.claim) {
    std::printf("%-72s energy %7.4f  momentum %8.1e  extent %7.4g %7.0f ms  %s\n", row.stressCase.name.c_str(),
                verdict.energy, verdict.momentumLost, verdict.extentMax, verdict.milliseconds, end.c_str());
    return;
  }
  std::printf("%-48s %-10s %8.3g  %-10s %7.4f %9.1e %7.0f ms  %s\n", row.stressCase.name.c_str(),
              simulationWord(verdict).c_str(), verdict.extentMax, verdict.status.c_str(), verdict.amplification,
              verdict.restError, verdict.milliseconds, end.c_str());
}

void printMap(const std::vector<Row>& rows) {
  const auto print = [&rows](const char* title, bool ours, bool implicit) {
    std::vector<const Row*> cells;
    for (const Row& row : rows) {
      const StressCase& cell = row.stressCase;
      if (cell.group == "map" && isOurs(cell.force) == ours && cell.implicit == implicit) cells.push_back(&row);
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [](const Row* a, const Row* b) { return a->stressCase.stiffness < b->stressCase.stiffness; });
    if (!cells.empty()) printMapOf(cells, title);
  };
  print("Bullet's elasticity, explicit", false, false);
  print("Bullet's elasticity, implicit", false, true);
  print("tetskin's elasticity and solver", true, false);
}

}  // namespace tetskin::stress
