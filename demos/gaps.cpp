// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Measures how far from an obstacle a body is drawn that lies on it, and how deep a body is drawn in an obstacle that
// it has just hit: with contact by the visual surface, and by the cage's nodes.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gaps/gap_bodies.h"
#include "gaps/gap_run.h"
#include "measure/report.h"
#include "scenes/printed_table.h"

using namespace tetskin;
using namespace tetskin::gaps;
using namespace tetskin::measure;
using namespace tetskin::scenes;

namespace {

struct GapOptions {
  std::vector<std::string> bodies = bodyNames();
  std::vector<std::string> obstacles;
  std::vector<std::size_t> tets = {300, 1000, 3000};
  std::size_t triangles = 20000;
  double seconds = 6.0;
  double speed = 15.0;  ///< body lengths per second
  ReportOptions report;
};

/// The table's columns, and with both of their words the names of its figures.
const std::vector<TableColumn>& columns() {
  static const std::vector<TableColumn> all = {
      {"gap at rest", "by surface", 11},         {"speed at rest", "by surface", 13},
      {"gap at rest", "by nodes", 11},           {"speed at rest", "by nodes", 13},
      {"least gap in impact", "by surface", 22}, {"least gap in impact", "by nodes", 22}};
  return all;
}

PrintedTable emptyTable() {
  std::vector<TableColumn> all = columns();
  all.insert(all.begin(), {"body on obstacle", "", 24});
  all.push_back({"verdict"});
  return PrintedTable(all);
}

std::vector<std::string> cellsOf(const SceneResult& result) {
  std::vector<std::string> cells = {result.scene};
  for (const TableColumn& column : columns()) cells.push_back(textOf(result.figures, column.title + " " + column.unit));
  cells.emplace_back(brokenIn({result}) == 0 ? "passed" : "FAILED");
  return cells;
}

SceneResult measured(const GapOptions& options, const std::string& name, const GapObstacle& obstacle,
                     const ModelPtr& body) {
  const auto scene = [&](Run& run) {
    for (const Kind kind : {Kind::Surface, Kind::Nodes}) {
      run.kind = kind;
      rest(run, obstacle, body, options.seconds);
      hit(run, obstacle, body, options.speed);
    }
  };
  return runScene({"gap/" + obstacle.name + "/" + name, scene}, Kind::Surface);
}

int run(const GapOptions& options) {
  std::vector<const GapObstacle*> obstacles;
  for (const std::string& name : options.obstacles) obstacles.push_back(&obstacleNamed(name));
  for (const GapObstacle& obstacle : gapObstacles()) {
    if (options.obstacles.empty()) obstacles.push_back(&obstacle);
  }
  SceneResults results;
  PrintedTable table = emptyTable();
  if (!options.report.quiet) std::printf("%s", table.header().c_str());
  for (const std::string& name : options.bodies) {
    for (const std::size_t tets : options.tets) {
      const ModelPtr body = makeGapBody(name, tets, options.triangles);
      for (const GapObstacle* obstacle : obstacles) {
        if (obstacle->roundOnly && name != "round") continue;
        results.push_back(measured(options, name + "/" + std::to_string(tets), *obstacle, body));
        table.add(cellsOf(results.back()));
        if (options.report.quiet) continue;
        std::printf("%s", table.latest().c_str());
        std::fflush(stdout);
      }
    }
  }
  return finish(results, table.markdown(), options.report);
}

}  // namespace

int main(int argc, char** argv) {
  GapOptions options;
  CommandLine line(
      "Measures the gaps between bodies and the obstacles that they rest on or hit, with contact at the rendered "
      "surface and at the cage's nodes, in body lengths.",
      {{{"tetskin_gaps --markdown gaps.md", "all shapes on all obstacles, in minutes"},
        {"tetskin_gaps --shapes serpent --obstacles floor --tets 300", "one body on the floor"}},
       "a gap at rest is larger than promised"});
  line.addWords("--shapes", options.bodies, "Shapes of the bodies");
  line.addWords("--obstacles", options.obstacles, "Obstacles: floor, edge, sphere, pole, hull, mesh, ball", "all");
  line.addPositive("--seconds", options.seconds, "after it a body counts as at rest");
  line.addPositive("--speed", options.speed, "Speed of the impacts, in body lengths per second");
  line.addCount("--triangles", options.triangles, "", 500000);
  line.addCounts("--tets", options.tets, "a list");
  addReportOptions(line, options.report);
  return line.run(argc, argv, [&] { return run(options); });
}
