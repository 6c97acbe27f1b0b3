// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact, and what joins bodies, beside what comes out by hand: momentum, friction, rolling, energy, rest.
#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "contact/report.h"
#include "contact/scene_list.h"
#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

using namespace tetskin;
using namespace tetskin::contact_demo;
using namespace tetskin::scenes;

namespace {

const std::map<std::string, Kind> kKinds = {
    {"tetskin-surface", Kind::Surface}, {"tetskin-nodes", Kind::Nodes}, {"bullet", Kind::Bullet}};

struct ContactOptions {
  std::string only, json, markdown, before, bullet;
  std::string force = "tetskin-surface";
  bool quiet = false;
};

SceneResult runScene(const ContactScene& scene, Kind kind) {
  const WallTimer timer;
  Run run(kind);
  scene.run(run);
  const double iterations = static_cast<double>(run.iterations) / std::max(1L, run.steps);
  return {scene.name, run.steps, iterations, timer.seconds(), std::move(run.figures)};
}

SceneResults runScenes(const ContactOptions& options) {
  const Kind kind = kKinds.at(options.force);
  SceneResults results;
  for (const ContactScene& scene : contactScenes()) {
    if (scene.name.find(options.only) == std::string::npos || !scene.isFor(kind)) continue;
    results.push_back(runScene(scene, kind));
    if (!options.quiet) print(results.back());
  }
  if (results.empty()) throw InputError("no scene that can be run so has '" + options.only + "' in its name");
  return results;
}

std::size_t brokenIn(const SceneResults& results) {
  std::size_t broken = 0;
  for (const SceneResult& result : results) {
    for (const Figure& figure : result.figures) broken += !holds(result, figure);
  }
  return broken;
}

int run(const ContactOptions& options) {
  std::vector<ResultColumn> columns;
  if (!options.before.empty()) columns.push_back({"before", readResults(options.before)});
  if (!options.bullet.empty()) columns.push_back({"Bullet", readResults(options.bullet)});
  columns.insert(columns.begin(), {options.force, runScenes(options)});
  const SceneResults& results = columns.front().results;
  if (!options.json.empty()) writeJson(toJson(results), options.json);
  if (!options.markdown.empty()) writeFile(options.markdown, toMarkdown(columns));
  const std::size_t broken = brokenIn(results);
  if (!options.quiet)
    std::printf("\n%zu scenes; %zu figures are not what is promised by the surface\n", results.size(), broken);
  return broken == 0 || kKinds.at(options.force) != Kind::Surface ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  ContactOptions options;
  CommandLine line("Contact and joints, beside what comes out by hand. S is a body's size.",
                   {{{"tetskin_contact --json contact.json", "all scenes: two minutes"},
                     {"tetskin_contact --only copies", "those with this in their names"},
                     {"tetskin_contact --only stop --force bullet", "by Bullet's own solver"}},
                    "by the surface, a figure is not what is promised"});
  line.addText("--only", options.only, "Part of the scenes' names");
  std::vector<std::string> forces;
  forces.reserve(kKinds.size());
  for (const auto& kind : kKinds) forces.push_back(kind.first);
  line.addWord("--force", options.force, forces, "Whose solver, and what of a body meets rigid ones");
  line.addSummaryOption(options.json, "File of the results, a list of scenes");
  line.addOutput("--markdown", options.markdown,
                 "File of the results, as a table: a line a promise, of its worst figure");
  line.addInput("--before", options.before, "Earlier results, by --json: a column of that table");
  line.addInput("--bullet", options.bullet, "The same by Bullet's own solver");
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] { return run(options); });
}
