// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact and joints compared with analytic results: momentum, friction, rolling, energy, rest.
#include "contact/scene_list.h"
#include "measure/report.h"
#include "scenes/input_error.h"

using namespace tetskin;
using namespace tetskin::contact_demo;
using namespace tetskin::measure;
using namespace tetskin::scenes;

namespace {

struct ContactOptions {
  std::string only, before, bullet;
  ReportOptions report;
  Force force = Force::Elastic;
  Contact contact = Contact::Surface;

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

SceneResults runScenes(const ContactOptions& options) {
  const Kind kind = options.kind();
  SceneResults results;
  for (const MeasuredScene& scene : contactScenes()) {
    if (scene.name.find(options.only) == std::string::npos || !scene.isFor(kind)) continue;
    results.push_back(runScene(scene, kind));
    if (!options.report.quiet) print(results.back());
  }
  if (results.empty())
    throw InputError("--only " + options.only + ": no scene that can be run with these options has this in its name");
  return results;
}

int run(const ContactOptions& options) {
  std::vector<ResultColumn> columns;
  if (!options.before.empty()) columns.push_back({"before", readResults(options.before)});
  if (!options.bullet.empty()) columns.push_back({"Bullet", readResults(options.bullet)});
  columns.insert(columns.begin(), {titleOf(options.kind()), runScenes(options)});
  const int status = finish(columns.front().results, toMarkdown(columns), options.report);
  return options.kind() == Kind::Surface ? status : kDone;
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
  addReportOptions(line, options.report, "one row per promise, with its worst figure");
  return line.run(argc, argv, [&] {
    if (options.force != Force::Elastic && line.given("--contact") && options.contact == Contact::Surface) {
      throw InputError(
          "--contact surface: with --elasticity bullet a body has contact at its cage's nodes only; use "
          "--contact cage, or --elasticity tetskin");
    }
    return run(options);
  });
}
