// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Measures how far from an obstacle a body is drawn that lies on it, and how deep a body is drawn in an obstacle that
// it has just hit: with contact by the visual surface, and by the cage's nodes.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gaps/gap_table.h"
#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"

using namespace tetskin;
using namespace tetskin::gaps;
using namespace tetskin::scenes;

namespace {

struct GapOptions {
  std::vector<std::string> bodies = bodyNames();
  std::vector<std::string> obstacles;
  std::vector<std::size_t> tets = {300, 1000, 3000};
  std::size_t triangles = 20000;
  double seconds = 6.0;
  double speed = 15.0;  ///< body lengths per second
  bool quiet = false;
  std::string json;
  std::string markdown;
};

GapRow measured(const GapOptions& options, const GapObstacle& obstacle, const GapBody& body, GapRow row) {
  row.surface = restOn(obstacle, body, Contact::Surface, options.seconds);
  row.cage = restOn(obstacle, body, Contact::Cage, options.seconds);
  row.deepest = deepestAt(options.speed, obstacle, body, Contact::Surface);
  row.deepestByCage = deepestAt(options.speed, obstacle, body, Contact::Cage);
  return row;
}

void print(const GapRow& row) {
  const auto word = [](const Rest& rest) { return !rest.touches() ? "off" : rest.still() ? "still" : "moves"; };
  std::printf("%-8s  %-8s %6zu  %+8.4f %-6s  %+8.4f %-6s  %+9.4f  %+9.4f  %s\n", row.obstacle.c_str(), row.body.c_str(),
              row.tets, row.surface.gap, word(row.surface), row.cage.gap, word(row.cage), row.deepest,
              row.deepestByCage, holds(row) ? "" : "FAILED");
  std::fflush(stdout);
}

void printHeader() {
  std::printf("%-8s  %-8s %6s  %-32s  %s\n", "obstacle", "shape", "tets", "gap at rest", "least gap of an impact");
  std::printf("%-8s  %-8s %6s  %-15s  %-15s  %9s  %9s\n", "", "", "", " surface", " cage", "surface", "cage");
}

std::vector<GapRow> measureAll(const GapOptions& options, const std::vector<const GapObstacle*>& obstacles) {
  std::vector<GapRow> rows;
  if (!options.quiet) printHeader();
  for (const std::string& name : options.bodies) {
    for (const std::size_t tets : options.tets) {
      const GapBody body = makeGapBody(name, tets, options.triangles);
      for (const GapObstacle* obstacle : obstacles) {
        if (obstacle->roundOnly && name != "round") continue;
        GapRow row;
        row.obstacle = obstacle->name;
        row.body = name;
        row.tets = tets;
        rows.push_back(measured(options, *obstacle, body, row));
        if (!options.quiet) print(rows.back());
      }
    }
  }
  return rows;
}

int run(const GapOptions& options) {
  std::vector<const GapObstacle*> obstacles;
  for (const std::string& name : options.obstacles) obstacles.push_back(&obstacleNamed(name));
  for (const GapObstacle& obstacle : gapObstacles()) {
    if (options.obstacles.empty()) obstacles.push_back(&obstacle);
  }
  const std::vector<GapRow> rows = measureAll(options, obstacles);
  if (!options.json.empty()) writeJson(toJson(rows), options.json);
  if (!options.markdown.empty()) writeFile(options.markdown, toMarkdown(rows));
  const auto broken = std::count_if(rows.begin(), rows.end(), [](const GapRow& row) { return !holds(row); });
  if (!options.quiet) {
    std::printf("\n%zu rows; in %td the gap at rest, by the surface, is larger than %g %% of the body's size\n",
                rows.size(), broken, 100.0 * kPromised);
  }
  return broken == 0 ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  GapOptions options;
  CommandLine line(
      "Measures the gaps between bodies and the obstacles that they rest on or hit, with contact at the rendered "
      "surface "
      "and at the cage's nodes, in body lengths.",
      {{{"tetskin_gaps --markdown gaps.md", "all shapes on all obstacles, in minutes"},
        {"tetskin_gaps --shapes serpent --obstacles floor --tets 300", "one body on the floor"}},
       "a gap at rest is larger than promised"});
  line.addWords("--shapes", options.bodies, "Shapes of the bodies");
  line.addWords("--obstacles", options.obstacles, "Obstacles: floor, edge, sphere, pole, hull, mesh, ball", "all");
  line.addPositive("--seconds", options.seconds, "after it a body counts as at rest");
  line.addPositive("--speed", options.speed, "Speed of the impacts, in body lengths per second");
  line.addCount("--triangles", options.triangles, "", 500000);
  line.addCounts("--tets", options.tets, "a list");
  line.addSummaryOption(options.json);
  line.addOutput("--markdown", options.markdown);
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] { return run(options); });
}
