// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact with rigid bodies beside what comes out by hand: momentum, friction, rolling, energy, rest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "contact/promise.h"
#include "contact/scene_list.h"
#include "scenes/command_line.h"
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
  std::string only, json;
  std::string force = "tetskin-surface";
  bool quiet = false;
};

/// A scene that was run.
struct SceneResult {
  std::string scene;
  Run run;
  double seconds = 0.0;

  double iterationsPerStep() const { return static_cast<double>(run.iterations) / std::max(1L, run.steps); }
};

bool holds(const SceneResult& result, const Figure& figure) {
  const Promise* promise = promiseFor(result.scene, figure.name);
  return !promise || promise->holds(figure.value);
}

void print(const SceneResult& result) {
  std::printf("%-42s %6ld steps  %5.1f iterations a step  %6.2f s\n", result.scene.c_str(), result.run.steps,
              result.iterationsPerStep(), result.seconds);
  for (const Figure& figure : result.run.figures) {
    const Promise* promise = promiseFor(result.scene, figure.name);
    std::printf("    %-32s %12.6g   %-14s %s\n", figure.name.c_str(), figure.value,
                promise ? text(*promise).c_str() : "",
                !promise                       ? ""
                : promise->holds(figure.value) ? "holds"
                                               : "NOT HELD");
  }
  std::fflush(stdout);
}

nlohmann::ordered_json toJson(const SceneResult& result) {
  nlohmann::ordered_json json;
  json["scene"] = result.scene;
  json["steps"] = result.run.steps;
  json["iterations_per_step"] = result.iterationsPerStep();
  json["seconds"] = result.seconds;
  auto& figures = json["figures"] = nlohmann::ordered_json::array();
  for (const Figure& figure : result.run.figures) {
    nlohmann::ordered_json one;
    one["name"] = figure.name;
    one["value"] = figure.value;
    if (const Promise* promise = promiseFor(result.scene, figure.name)) {
      if (std::isfinite(promise->least)) one["least"] = promise->least;
      if (std::isfinite(promise->most)) one["most"] = promise->most;
    }
    one["held"] = holds(result, figure);
    figures.push_back(std::move(one));
  }
  return json;
}

SceneResult runScene(const ContactScene& scene, Kind kind) {
  SceneResult result{scene.name, Run(kind)};
  const WallTimer timer;
  scene.run(result.run);
  result.seconds = timer.seconds();
  return result;
}

int run(const ContactOptions& options) {
  const Kind kind = kKinds.at(options.force);
  std::vector<SceneResult> results;
  std::size_t broken = 0;
  for (const ContactScene& scene : contactScenes()) {
    if (scene.name.find(options.only) == std::string::npos || (kind == Kind::Bullet && !scene.withBullet)) continue;
    results.push_back(runScene(scene, kind));
    const SceneResult& result = results.back();
    for (const Figure& figure : result.run.figures) broken += !holds(result, figure);
    if (!options.quiet) print(result);
  }
  if (results.empty()) throw InputError("no scene has '" + options.only + "' in its name");
  if (!options.json.empty()) {
    auto json = nlohmann::ordered_json::array();
    for (const SceneResult& result : results) json.push_back(toJson(result));
    writeJson(json, options.json);
  }
  if (!options.quiet) std::printf("\n%zu scenes; %zu figures do not hold\n", results.size(), broken);
  return broken == 0 || kind != Kind::Surface ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  ContactOptions options;
  CommandLine line("Contact with rigid bodies, beside what comes out by hand. S is a body's size.",
                   {{{"tetskin_contact --json contact.json", "all scenes: two minutes"},
                     {"tetskin_contact --only roll", "those with this in their names"},
                     {"tetskin_contact --only stop --force bullet", "by Bullet's own solver"}},
                    "by the surface, a figure is not what is promised"});
  line.addText("--only", options.only, "Part of the scenes' names");
  std::vector<std::string> forces;
  for (const auto& kind : kKinds) forces.push_back(kind.first);
  line.addWord("--force", options.force, forces, "Whose solver, and what of a body meets rigid ones");
  line.addSummaryOption(options.json, "File of the results, a list of scenes");
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] { return run(options); });
}
