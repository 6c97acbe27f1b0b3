// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How far from an obstacle a body is drawn that lies on it, and how deep in it one that has just hit it: with contact
// by the visual surface, and by the cage's nodes.
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
  double speed = 15.0;  ///< sizes a second
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
  std::printf("%-7s %-8s %5zu   rest %+.4f %-5s  cage %+.4f %-5s   impact %+.4f  cage %+.4f  %s\n",
              row.obstacle.c_str(), row.body.c_str(), row.tets, row.surface.gap, word(row.surface), row.cage.gap,
              word(row.cage), row.deepest, row.deepestByCage, holds(row) ? "" : "NOT HELD");
  std::fflush(stdout);
}

std::vector<GapRow> measureAll(const GapOptions& options, const std::vector<const GapObstacle*>& obstacles) {
  std::vector<GapRow> rows;
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
    std::printf("\n%zu rows; in %td the surface rests farther than %g sizes from what it lies on\n", rows.size(),
                broken, kPromised);
  }
  return broken == 0 ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  GapOptions options;
  CommandLine line(
      "Gaps between bodies and what they rest on or hit, by the surface and by the cage's nodes, in sizes.",
      {{{"tetskin_gaps --markdown gaps.md", "all bodies on all obstacles: minutes"},
        {"tetskin_gaps --bodies serpent --obstacles floor --tets 300", "one body on the floor"}},
       "a surface rests farther from what it lies on than it may"});
  line.addWords("--bodies", options.bodies, "serpent, round, legs (default: all)");
  line.addWords("--obstacles", options.obstacles, "floor, edge, sphere, pole, hull, mesh, ball (default: all)");
  line.addCounts("--tets", options.tets, "Tets of the cages");
  line.addCount("--triangles", options.triangles, "Triangles of the bodies", 500000);
  line.addPositive("--seconds", options.seconds, "Until a body is taken to be at rest");
  line.addPositive("--speed", options.speed, "Of the impacts, in sizes a second");
  line.addSummaryOption(options.json, "File of the results, a list of rows");
  line.addOutput("--markdown", options.markdown, "File of the results, as tables");
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] { return run(options); });
}
