// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/run_case.h"

#include <chrono>

#include "stress/events.h"

namespace tetskin::stress {
namespace {

/// RMS in diagonals, under its own weight or shortly after an event, of a shape that counts as recovered.
constexpr double kRecovered = 0.02;

void expectOfBullet(const StressCase& stressCase, Verdict& verdict) {
  if (stressCase.recovers) verdict.expect(verdict.shapeError <= kRecovered, "Bullet recovers the body's shape");
  if (stressCase.simulation == Simulation::Either) return;
  const bool bounded = stressCase.simulation == Simulation::Bounded;
  verdict.expect(verdict.simulationBounded == bounded,
                 bounded ? "Bullet stays bounded" : "Bullet does not stay bounded");
}

void simulate(const StressCase& stressCase, const StressModel& model, StressWorld& world, SoftBodySkin& skin,
              Verdict& verdict) {
  EventScript event(stressCase, model, world);
  SkinJudge judge(stressCase, model, world.body(), skin, verdict);
  for (int frame = 0; frame < stressCase.frames; ++frame) {
    if (event.before(frame)) judge.update();
    if (event.takeBack()) judge.update();
    world.step(stressCase);
    judge.update();
  }
  judge.judgeShape();
  event.restore();
  judge.judgeRest();
}

/// A case that must be refused: the skin stays unbound, while the body goes on.
void expectRefusal(const StressCase& stressCase, const EmbedReport& fit, SoftBodySkin& skin, Verdict& verdict) {
  verdict.status = "refused: " + std::string(toString(fit.status.code));
  verdict.expect(fit.status.code == stressCase.refusal, "the mesh is refused with the right status");
  verdict.expect(!fit.status.message.empty(), "the refusal has a message");
  verdict.expect(skin.update() == UpdateStatus::Unbound, "a skin that was refused stays unbound");
}

void bindAndRun(const StressCase& stressCase, Verdict& verdict) {
  const StressModel model = makeModel(stressCase.cage, stressCase.surface);
  btSoftBodyWorldInfo info;
  const Result<btSoftBody*> probe = makeSoftBody(model.bodyCage, info);
  std::unique_ptr<btSoftBody> owned(probe.value());
  if (!probe.ok()) {
    verdict.status = "refused: " + std::string(toString(probe.status().code));
    verdict.expect(probe.status().code == stressCase.refusal, "the cage is refused with the right status");
    MeshSkin<btScalar> skin;
    verdict.expect(skin.bind(model.cage, model.mesh).status.code == stressCase.refusal, "the skin refuses it likewise");
    return;
  }
  const std::unique_ptr<StressWorld> world = StressWorld::make(stressCase, model);
  SkinOptions options;
  options.interpolation = stressCase.interpolation;
  options.normals = stressCase.normals;
  options.origin = model.offset;
  SoftBodySkin skin;
  const EmbedReport fit = skin.bind(world->body(), model.cage, model.mesh, options);
  if (!fit.ok() || stressCase.refusal != StatusCode::Ok) return expectRefusal(stressCase, fit, skin, verdict);
  simulate(stressCase, model, *world, skin, verdict);
  expectOfBullet(stressCase, verdict);
}

}  // namespace

Verdict runCase(const StressCase& stressCase) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  Verdict verdict;
  bindAndRun(stressCase, verdict);
  verdict.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return verdict;
}

}  // namespace tetskin::stress
