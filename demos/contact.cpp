// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact and joints compared with analytic results: momentum, friction, rolling, energy, rest.
#include <algorithm>
#include <cstdio>
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

struct ContactOptions {
  std::string only, json, markdown, before, bullet;
  Force force = Force::Elastic;
  Contact contact = Contact::Surface;
  bool quiet = false;

  Kind kind() const {
    if (force != Force::Elastic) return Kind::Bullet;
    return contact == Contact::Surface ? Kind::Surface : Kind::Nodes;
  }
};

/// The heading of this run's column.
const char* titleOf(Kind kind) {
  if (kind == Kind::Bullet) return "bullet";
  return kind == Kind::Surface ? "tetskin-surface" : "tetskin-nodes";
}

SceneResult runScene(const ContactScene& scene, Kind kind) {
  const WallTimer timer;
  Run run(kind);
  scene.run(run);
  const double iterations = static_cast<double>(run.iterations) / std::max(1L, run.steps);
  return {scene.name, run.steps, iterations, timer.seconds(), std::move(run.figures)};
}

SceneResults runScenes(const ContactOptions& options) {
  const Kind kind = options.kind();
  SceneResults results;
  for (const ContactScene& scene : contactScenes()) {
    if (scene.name.find(options.only) == std::string::npos || !scene.isFor(kind)) continue;
    results.push_back(runScene(scene, kind));
    if (!options.quiet) print(results.back());
  }
  if (results.empty())
    throw InputError("--only " + options.only + ": no scene that can be run with these options has this in its name");
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
  columns.insert(columns.begin(), {titleOf(options.kind()), runScenes(options)});
  const SceneResults& results = columns.front().results;
  if (!options.json.empty()) writeJson(toJson(results), options.json);
  if (!options.markdown.empty()) writeFile(options.markdown, toMarkdown(columns));
  const std::size_t broken = brokenIn(results);
  if (!options.quiet)
    std::printf("\n%zu scenes; %zu figures outside the limits promised for contact at the surface\n", results.size(),
                broken);
  return broken == 0 || options.kind() != Kind::Surface ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  ContactOptions options;
  CommandLine line(
      "Compares contact and joints with analytic results. S is the body's size, the largest side of its bounding box.",
      {{{"tetskin_contact --json contact.json", "all scenes, in two minutes"},
        {"tetskin_contact --only copies", "the scenes with this in their names"},
        {"tetskin_contact --only stop --elasticity bullet", "the same with Bullet's own solver"}},
       "with contact at the surface, a figure is outside its promised limits"});
  line.addElasticityOption(options.force, "bullet: linear elasticity, explicit, with contact at the cage's nodes");
  line.addContactOption(options.contact);
  line.addText("--only", options.only);
  line.addInput("--before", options.before,
                "Results of an earlier version (its --json file), for a column of the Markdown table");
  line.addInput("--bullet", options.bullet,
                "Results of --elasticity bullet (its --json file), for a column of the Markdown table");
  line.addSummaryOption(options.json);
  line.addOutput("--markdown", options.markdown, "one row per promise, with its worst figure");
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] {
    if (options.force != Force::Elastic && line.given("--contact") && options.contact == Contact::Surface) {
      throw InputError(
          "--contact surface: with --elasticity bullet a body has contact at its cage's nodes only; use "
          "--contact cage, or --elasticity tetskin");
    }
    return run(options);
  });
}
