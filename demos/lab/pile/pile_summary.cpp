// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "pile/pile_summary.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scenes/formats.h"
#include "scenes/printed_table.h"
#include "scenes/summary.h"

namespace tetskin::scenes {
namespace {

/// Values only for scenes that are judged by their rest.
void tellRest(const PileOptions& options, const Pile& pile, const Measurements& measured,
              nlohmann::ordered_json& json) {
  json["simulation_us_per_thing_and_frame"] = 1e3 * json["simulation_ms_per_frame"].get<double>() / options.bodies;
  json["asleep_at_end"] = pile.asleepCount();
  json["fastest_at_end"] = pile.fastest();
  if (!measured.deepestDent) return;
  json["deepest_dent"] = *measured.deepestDent;
  json["deepest_dent_at_end"] = *pile.deepestDent();
}

/// 0 to bodies - 1, in the order in which they were added.
std::string bodiesOf(const nlohmann::ordered_json& pair) {
  if (pair[0] == pair[1]) return "";
  return ", of body " + pair[0].dump() + " in body " + pair[1].dump();
}

void printTimes(const nlohmann::ordered_json& json, const PileOptions& options) {
  const char* const each = "simulation_us_per_thing_and_frame";
  printValue("simulation", formatted("%.2f ms per frame, ", json, "simulation_ms_per_frame") +
                               formatted("%.2f ms of processor time", json, "processor_ms_per_frame") +
                               (json.contains(each) ? formatted("; %.1f us per frame and ", json, each) +
                                                          pileSceneNamed(options.scene).thing
                                                    : ""));
  if (!json.at("slowest_second_ms_per_frame").is_null()) {
    printValue("slowest second", formatted("%.2f ms per frame, ", json, "slowest_second_ms_per_frame") +
                                     formatted("%.2f ms of processor time; of those in which ", json,
                                               "slowest_second_processor_ms_per_frame") +
                                     std::to_string(kManyPairs) + " pairs of bodies touch");
  }
  printStages(json.at("stages_ms_per_frame"), json.at("slowest_second_stages_ms_per_frame"));
}

}  // namespace

nlohmann::ordered_json summarise(const PileOptions& options, const Pile& pile, const Measurements& measured,
                                 const Playback& run) {
  nlohmann::ordered_json json;
  json["scene"] = options.scene;
  json["bodies"] = pile.bodyCount();
  if (pile.ballCount() > 0) json["balls"] = pile.ballCount();
  json["vertices"] = pile.mesh().vertexCount();
  json["tets"] = pile.tetCount();
  json["contact"] = options.contact == Contact::Surface ? "surface" : "cage";
  json["self_contact"] = options.touchThemselves() ? "on" : "off";
  json["seed"] = options.seed;
  json["threads"] = options.threads;
  json["simulation_ms_per_frame"] = run.simulationMs / run.steps();
  json["processor_ms_per_frame"] = measured.meanTime().processor;
  const std::optional<SlowestSecond> slowest = measured.slowestSecond();
  json["slowest_second_ms_per_frame"] = slowest ? nlohmann::ordered_json(slowest->mean.wall) : nullptr;
  json["slowest_second_processor_ms_per_frame"] = slowest ? nlohmann::ordered_json(slowest->mean.processor) : nullptr;
  json["stages_ms_per_frame"] = toJson(pile.stageTimes(), run.steps());
  json["slowest_second_stages_ms_per_frame"] =
      slowest ? toJson(slowest->stages, kFramesPerSecond) : nlohmann::ordered_json();
  tellSolve(pile.world().solveTotals(), json);
  json["deepest_vertex"] = -measured.deepest.depth;
  json["deepest_vertex_frame"] = measured.deepestFrame;
  json["deepest_vertex_bodies"] = {measured.deepest.body, measured.deepest.other};
  json["deepest_vertex_at_end"] = -measured.latest.depth;
  json["deepest_vertex_at_end_bodies"] = {measured.latest.body, measured.latest.other};
  json["vertices_inside_at_end"] = measured.latest.count;
  json["deepest_contact"] = measured.deepestContact;
  json["deepest_contact_at_end"] = pile.deepestContact();
  json["contacts_at_end"] = pile.contactCount();
  json["pairs_at_end"] = pile.pairCount();
  json["node_speed_at_end"] = pile.nodeSpeed();
  if (pile.scene().figures == PileFigures::Rest) tellRest(options, pile, measured, json);
  return json;
}

void printSummary(const nlohmann::ordered_json& json, const PileOptions& options) {
  const bool ofRest = pileSceneNamed(options.scene).figures == PileFigures::Rest;
  const auto depth = [&](const char* key) {
    const double deep = std::abs(json.at(key).get<double>());
    return ofRest ? formatted("%.2f mm", 1e3 * deep) : formatted("%.2f %% of the body's size", 100.0 * deep);
  };
  printValue("bodies", formatted("%.0f", json, "bodies") +
                           (json.contains("balls") ? formatted(" and %.0f balls", json, "balls") : "") +
                           formatted(", %.0f vertices", json, "vertices") + formatted(", %.0f tets", json, "tets"));
  printValue("contact", json.at("contact").get<std::string>());
  printValue("self-contact", json.at("self_contact").get<std::string>());
  printTimes(json, options);
  printSolve(json);
  const std::string measured =
      options.depthEvery == 1 ? "in every frame" : "every " + std::to_string(options.depthEvery) + " frames";
  printValue("deepest vertex", depth("deepest_vertex") + formatted(", in frame %.0f", json, "deepest_vertex_frame") +
                                   bodiesOf(json.at("deepest_vertex_bodies")) + " (measured " + measured + "); " +
                                   depth("deepest_vertex_at_end") + " at the end");
  if (json.contains("deepest_dent")) {
    printValue("deepest dent", depth("deepest_dent") + " below the mat's upper side at rest; " +
                                   depth("deepest_dent_at_end") + " at the end");
  } else {
    printValue("deepest contact", depth("deepest_contact") + ", as the solver measures it; " +
                                      depth("deepest_contact_at_end") + " at the end");
  }
  if (ofRest) {
    printValue("at the end", formatted("%.0f", json, "asleep_at_end") + " asleep, the fastest node or ball at " +
                                 formatted("%.4f m/s", json, "fastest_at_end"));
  } else {
    printValue("speed at the end", formatted("%.3f body lengths per second", json, "node_speed_at_end"));
  }
  printValue("frames", formatted("%.0f", json, "frames"));
  printValue("files", firstFileOf(options.output) + " ... " + summaryPath(options.output));
}

}  // namespace tetskin::scenes
