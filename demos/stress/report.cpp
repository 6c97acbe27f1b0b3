// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/report.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "measure/report.h"
#include "scenes/printed_table.h"
#include "scenes/summary.h"

namespace tetskin::stress {
namespace {

using scenes::PrintedTable;
using scenes::TableColumn;

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

/// end  columns after those of the kind of case
std::vector<TableColumn> columnsOf(const Row& row, const std::vector<TableColumn>& end) {
  std::vector<TableColumn> columns = {{"case", "", 50},      {"simulation", "", 10}, {"largest extent", "", 14},
                                      {"surface", "", 10},   {"status", "", 10},     {"amplification", "", 13},
                                      {"rest error", "", 10}};
  if (row.stressCase.claim)
    columns = {{"claim", "", 74}, {"energy", "", 7}, {"momentum lost", "", 13}, {"extent", "", 7}};
  columns.insert(columns.end(), end.begin(), end.end());
  return columns;
}

std::vector<std::string> cellsOf(const Row& row, const std::vector<std::string>& end) {
  const auto& [stressCase, verdict] = row;
  std::vector<std::string> cells = {stressCase.name};
  if (stressCase.claim) {
    for (const char* figure : {"energy", "momentum lost", "extent over its start"}) {
      cells.push_back(measure::textOf(verdict.figures, figure));
    }
  } else {
    cells.insert(cells.end(),
                 {simulationWord(verdict), scenes::formatted("%.3g", verdict.extentMax),
                  verdict.skinFinite ? "finite" : "not finite", verdict.status,
                  scenes::formatted("%.4f", verdict.amplification), scenes::formatted("%.1e", verdict.restError)});
  }
  cells.insert(cells.end(), end.begin(), end.end());
  return cells;
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
    row["expected"] = toString(stressCase.simulation);
    row["passed"] = verdict.passed();
    row["broken"] = verdict.broken;
    const std::optional<bool> cannot = bulletCannot(each, rows);
    row["bullet_cannot_tetskin_can"] = cannot ? nlohmann::ordered_json(*cannot) : nlohmann::ordered_json();
    row["hash"] = hashWord(verdict);
    row["figures"] = measure::toJson(verdict.promised, verdict.figures);
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
  for (std::size_t k = 0; k < rows.size();) {
    const std::string& group = rows[k].stressCase.group;
    PrintedTable table(columnsOf(rows[k], {{"stable with tetskin only"}, {"expectations"}}));
    for (; k < rows.size() && rows[k].stressCase.group == group; ++k) {
      table.add(cellsOf(rows[k], {cannotWord(rows[k], rows), pinnedWord(rows[k].verdict)}));
    }
    text += "\n## " + group + "\n\n" + table.markdown();
  }
  return text;
}

void RowPrinter::print(const Row& row) {
  const TableColumn hash = hash_ ? TableColumn{"hash", "", 16} : TableColumn{};
  PrintedTable table(columnsOf(row, {hash, {"", "ms", 7}, {"expectations"}}));
  table.add(cellsOf(row, {hash_ ? hashWord(row.verdict) : "", scenes::formatted("%.0f", row.verdict.milliseconds),
                          pinnedWord(row.verdict)}));
  const bool isClaim = row.stressCase.claim.has_value();
  if (headed_ != isClaim) std::printf("%s", table.header().c_str());
  headed_ = isClaim;
  std::printf("%s", table.latest().c_str());
  std::fflush(stdout);
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
