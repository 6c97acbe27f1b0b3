// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/stress_scenes.h"

#include <tetskin/solver/deformable_body.h>

#include <cmath>

#include "scenes/table.h"
#include "stress/changed.h"
#include "stress/skin_judge.h"

namespace tetskin::stress {
namespace {

using measure::Run;

/// RMS in diagonals, under gravity or shortly after an event, of a shape that counts as recovered.
constexpr double kRecovered = 0.02;
/// Depth below a floor, in units of the body's size, that a surface may have reached at the end, when it may still
/// move.
constexpr double kSunk = 0.02;
/// Speed that counts as rest, in body lengths per second.
constexpr double kAtRest = 0.02;

void expectOfBody(const StressCase& stressCase, Verdict& verdict) {
  if (stressCase.staysAbove) verdict.expect(verdict.lowest >= -kSunk, "the surface is above the floor at the end");
  if (stressCase.rests) verdict.expect(verdict.restSpeed <= kAtRest, "the bodies are at rest at the end");
  if (stressCase.recovers && !stressCase.changing)
    verdict.expect(verdict.shapeError <= kRecovered, "the body recovers its shape");
  if (stressCase.simulation == Simulation::Either) return;
  const bool bounded = stressCase.simulation == Simulation::Bounded;
  verdict.expect(verdict.simulationBounded == bounded,
                 bounded ? "the body stays bounded" : "the body does not stay bounded");
}

scenes::SceneOptions sceneOptions(const StressCase& stressCase, const StressModel& model) {
  scenes::SceneOptions options;
  options.force = stressCase.force;
  options.frameSeconds = stressCase.timeStep;
  options.substeps = stressCase.substeps;
  options.frames = stressCase.frames;
  options.harshness = stressCase.harshness;
  options.size = model.size;
  options.offset = model.offset;
  constexpr int kModes = 10;
  if (stressCase.force == scenes::Force::Reduced) {
    options.reduction = std::make_shared<scenes::Reduction>(model.bodyCage, kModes);
    options.modes = kModes;
  }
  SoftBodyOptions& body = options.body;
  if (stressCase.stiffness > 0.0) body.youngsModulus = stressCase.stiffness;
  if (stressCase.force == scenes::Force::MassSpring && stressCase.stiffness > 0.0) {
    body.linkStiffness = stressCase.stiffness;
  }
  body.poissonRatio = stressCase.poisson;
  body.stiffnessDamping = stressCase.damping;
  body.timeStep = stressCase.substep();
  body.implicit = stressCase.implicit;
  return options;
}

void simulate(const StressCase& stressCase, const StressModel& model, scenes::Scene& scene, SoftBodySkin& skin,
              Verdict& verdict) {
  SkinJudge judge(stressCase, model, scene, skin, verdict);
  const int last = static_cast<int>(std::ceil(0.5 / stressCase.timeStep));
  double squaredSpeed = 0.0;
  for (int frame = 1; frame <= stressCase.frames; ++frame) {
    scene.step(frame, [&] { judge.update(); });
    judge.update();
    verdict.hash = scene.world().hashOfNodes(verdict.hash);
    if (frame > stressCase.frames - last) squaredSpeed += scene.nodeSpeed() * scene.nodeSpeed() / last;
  }
  verdict.solve = scene.world().solveTotals();
  verdict.restSpeed = std::sqrt(squaredSpeed);
  if (std::isfinite(scene.floorY)) verdict.lowest = (skin.bounds().min().y() - scene.floorY) / model.size;
  judge.judgeShape();
  scene.restore();
  judge.judgeRest();
}

/// A case that must be refused: the skin stays unbound, while the simulation of the body continues.
void expectRefusal(const StressCase& stressCase, const Status& fit, SoftBodySkin& skin, Verdict& verdict) {
  verdict.status = "refused: " + std::string(toString(fit.code));
  verdict.expect(fit.code == stressCase.refusal, "the mesh is refused with the right status");
  verdict.expect(!fit.message.empty(), "the refusal has a message");
  verdict.expect(skin.update() == StatusCode::Unbound, "a skin that was refused stays unbound");
}

void bindAndRun(const StressCase& stressCase, Verdict& verdict) {
  const StressModel model = makeModel(stressCase.cage, stressCase.surface);
  btSoftBodyWorldInfo info;
  const Result<std::unique_ptr<btSoftBody>> probe = createSoftBody(model.bodyCage, info);
  if (!probe.ok()) {
    verdict.status = "refused: " + std::string(toString(probe.status().code));
    verdict.expect(probe.status().code == stressCase.refusal, "the cage is refused with the right status");
    MeshSkin<btScalar> skin;
    verdict.expect(skin.bind(model.cage, model.mesh).status().code == stressCase.refusal,
                   "the skin refuses the cage with the same status");
    return;
  }
  const std::unique_ptr<scenes::Scene> scene =
      scenes::sceneNamed(stressCase.scene).make(model.bodyCage, sceneOptions(stressCase, model));
  for (const auto& body : scene->world().deformables()) {
    if (stressCase.changing) growAndYield(*body, body->youngsModulus());
    if (stressCase.law != ElasticLaw()) scenes::require(body->setElasticLaw(stressCase.law));
  }
  SkinOptions options;
  options.interpolation = stressCase.interpolation;
  options.normals = stressCase.normals;
  options.origin = model.offset;
  SoftBodySkin skin;
  const Status fit = skin.bind(scene->body(), model.cage, model.mesh, options).status();
  if (!fit.ok() || stressCase.refusal != StatusCode::Ok) return expectRefusal(stressCase, fit, skin, verdict);
  for (std::size_t b = 0; stressCase.touchesBySurface && b < scene->bodyCount(); ++b) {
    scene->world().touchBySurface(scene->body(b), *skin.binding(), model.mesh);
  }
  simulate(stressCase, model, *scene, skin, verdict);
  expectOfBody(stressCase, verdict);
}

void report(const Verdict& verdict, bool ours, Run& run) {
  run.steps = verdict.solve.steps;
  run.iterations = verdict.solve.iterations;
  run.status = verdict.status;
  run.hash = verdict.hash;
  run.broken = verdict.broken;
  run.report("finite", verdict.simulationFinite);
  run.report("bounded", verdict.simulationBounded);
  run.report("largest extent", verdict.extentMax);
  run.report("surface is finite", verdict.skinFinite);
  run.report("amplification", verdict.amplification);
  run.report("rest error", verdict.restError);
  run.report("shape error", verdict.shapeError);
  run.report("lowest", verdict.lowest);
  run.report("speed at the end", verdict.restSpeed);
  if (ours) run.report("steps that did not converge", verdict.solve.unconverged);
}

void runCase(const StressCase& stressCase, Run& run) {
  if (stressCase.claim) return runClaim(*stressCase.claim, run);
  Verdict verdict;
  bindAndRun(stressCase, verdict);
  report(verdict, isOurs(stressCase.force), run);
}

}  // namespace

measure::MeasuredScenes stressScenes(bool changing, const ElasticLaw& law) {
  measure::MeasuredScenes scenes;
  for (StressCase& stressCase : stressCases()) {
    if ((changing || law != ElasticLaw()) && !isOurs(stressCase.force)) continue;
    stressCase.changing = changing;
    stressCase.law = law;
    // What has been stretched tenfold comes back more slowly: other laws are softer there than a linear one.
    if (law != ElasticLaw() && stressCase.recovers) stressCase.frames *= 4;
    if (stressCase.claim) {
      stressCase.claim->changing = changing;
      stressCase.claim->law = law;
    }
    const measure::Kind kind = isOurs(stressCase.force) ? measure::Kind::Surface : measure::Kind::Bullet;
    const measure::Often often = stressCase.lasts   ? measure::Often::Long
                                 : stressCase.quick ? measure::Often::Quick
                                                    : measure::Often::Usual;
    scenes.push_back({stressCase.name, [stressCase](Run& run) { runCase(stressCase, run); }, {kind}, often});
  }
  return scenes;
}

}  // namespace tetskin::stress
