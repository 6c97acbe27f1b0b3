// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes with measurements and the promises about them: contact and joints compared with analytic results, gaps between
// surfaces and obstacles, stiff and extreme cases.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "contact/scene_list.h"
#include "gaps/gap_scenes.h"
#include "measure/report.h"
#include "scenes/command_line.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"
#include "stress/stress_scenes.h"

using namespace tetskin;
using namespace tetskin::measure;
using namespace tetskin::scenes;

namespace {

struct MeasureOptions {
  std::string group = "all", elasticity = "tetskin", law = "corotated", only, json;
  Contact contact = Contact::Surface;
  bool quick = false, lasting = false, changing = false, quiet = false;

  std::vector<Kind> kinds() const {
    if (elasticity == "bullet") return {Kind::Bullet};
    const Kind ours = contact == Contact::Surface ? Kind::Surface : Kind::Nodes;
    return elasticity == "both" ? std::vector<Kind>{ours, Kind::Bullet} : std::vector<Kind>{ours};
  }
};

/// With the coefficients of Yeoh's, 2.5 times the neo-Hookean stress at 1.7 of the length.
ElasticLaw lawOf(const std::string& name) {
  return name == "yeoh" ? ElasticLaw::yeoh(0.4, 0.2) : name == "neo-hookean" ? ElasticLaw::neoHookean() : ElasticLaw();
}

MeasuredScenes scenesOf(const MeasureOptions& options) {
  MeasuredScenes scenes;
  const auto append = [&](const char* name, const std::function<MeasuredScenes()>& make) {
    if (options.group != "all" && options.group != name) return;
    for (MeasuredScene& scene : make()) scenes.push_back(std::move(scene));
  };
  const bool all = !options.changing && options.law == "corotated";
  if (all) append("contact", contact_demo::contactScenes);
  if (all) append("gaps", gaps::gapScenes);
  append("stress", [&] { return stress::stressScenes(options.changing, lawOf(options.law)); });
  return scenes;
}

struct Results {
  SceneResults scenes;
  std::size_t broken = 0;  ///< figures outside their promised limits, or not as expected
};

/// Runs each scene once: by the first of the kinds asked for that it has. Limits are promised of contact at the surface
/// alone; expectations hold for each case that has some.
Results runScenes(const MeasureOptions& options) {
  Results results;
  for (const MeasuredScene& scene : scenesOf(options)) {
    const bool wanted = options.lasting ? scene.often == Often::Long
                        : options.quick ? scene.often == Often::Quick
                                        : scene.often != Often::Long;
    if (!wanted || scene.name.find(options.only) == std::string::npos) continue;
    const std::vector<Kind> kinds = options.kinds();
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](Kind one) { return scene.isFor(one); });
    if (kind == kinds.end()) continue;
    results.scenes.push_back(runScene(scene, *kind));
    const SceneResult& result = results.scenes.back();
    if (*kind == Kind::Surface || !result.status.empty()) results.broken += result.broken.size();
    if (!options.quiet) print(result);
  }
  if (!results.scenes.empty()) return results;
  if (options.only.empty()) throw InputError("--group " + options.group + ": no scene can be run with these options");
  throw InputError("--only " + options.only + ": no scene that can be run with these options has this in its name");
}

int run(const MeasureOptions& options) {
  const Results results = runScenes(options);
  if (!options.json.empty()) writeJson(toJson(results.scenes), options.json);
  if (!options.quiet) {
    std::printf("\n%zu scenes; %zu figures or expectations are not as promised\n", results.scenes.size(),
                results.broken);
  }
  return results.broken == 0 ? kDone : kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  MeasureOptions options;
  CommandLine line(
      "Measures bodies in many scenes, and checks the promises about them: contact and joints compared with analytic "
      "results, gaps between bodies and the obstacles that they rest on or hit, and stiff and extreme cases. S is the "
      "body's size, the largest side of its bounding box.",
      {{{"tetskin_measure --group contact --json contact.json", "all scenes of contact, in two minutes"},
        {"tetskin_measure --only copies", "the scenes with this in their names"},
        {"tetskin_measure --only stop --elasticity bullet", "the same with Bullet's own solver"},
        {"tetskin_measure --only gap/300/floor/round", "one body on the floor"},
        {"tetskin_measure --group stress --quick --elasticity both", "extreme cases, also with Bullet's forces"}},
       "a figure is outside its promised limits, or a case is not as expected"});
  line.addWord("--group", options.group, {"all", "contact", "gaps", "stress"}, "Scenes of one kind");
  line.addFlag("--quick", options.quick, "600 cases of the stress and one gap, about 30 s");
  line.addFlag("--long", options.lasting,
               "Run the long scenes instead: one minute of simulated time each, and all claims (about 20 minutes)");
  line.addFlag(
      "--changing", options.changing,
      "Of the stress, with bodies that have grown by a tenth in length and yield at a strain of 2 %, which need "
      "not recover their shape");
  line.addWord("--law", options.law, {"corotated", "neo-hookean", "yeoh"},
               "Of the stress, with another law of elasticity");
  line.addWord(
      "--elasticity", options.elasticity, {"tetskin", "bullet", "both"},
      "bullet: linear elasticity, explicit, with contact at the cage's nodes, and of the stress cases those of "
      "Bullet's forces; both: these beside tetskin's");
  line.addContactOption(options.contact);
  line.addText("--only", options.only);
  line.addSummaryOption(options.json);
  line.addQuietOption(options.quiet);
  return line.run(argc, argv, [&] {
    if (options.elasticity == "bullet" && line.given("--contact") && options.contact == Contact::Surface) {
      throw InputError(
          "--contact surface: with --elasticity bullet a body has contact at its cage's nodes only; use "
          "--contact cage, or --elasticity tetskin");
    }
    if (options.quick && options.lasting) throw InputError("--quick and --long cannot be used together");
    return run(options);
  });
}
