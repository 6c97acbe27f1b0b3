// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Undamped bodies that fall on the floor: how high they rise again in the steps of a game, and in fine ones.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kDrop = 1.0;
constexpr int kGame = 4, kFine = 64;  // substeps per frame

struct Bounce {
  double rebound = 0.0;  ///< the height to which the centre rises, over that from which it has fallen
  double energy = 0.0;   ///< the largest, over that at the beginning
};

Bounce bounce(Run& run, const ModelPtr& model, const AngleAxisd& turn, double youngsModulus, int substeps) {
  MeasuringWorld world(run);
  world.addFloor();
  BodyOptions options;
  options.youngsModulus = youngsModulus;
  options.damping = 0.0;
  double lowest = 0.0;
  for (const Vector3d& p : model->mesh.positions) lower(lowest, (turn * p).y());
  const double start = kDrop - lowest;
  SoftObject& body = world.addSoft(model, options, Eigen::Translation3d(0, start, 0) * Eigen::Isometry3d(turn));
  const auto energy = [&] { return world.energy() - options.mass * scenes::kEarth * (start - kDrop); };
  const double before = energy();
  Bounce found;
  bool met = false;
  for (int k = 0; k < 75 * substeps; ++k) {
    world.step(1.0 / (60 * substeps));
    const RigidMotion motion = body.motion();
    const double height = motion.centroid.y() - start + kDrop;
    raise(found.energy, energy() / before);
    met |= motion.velocity.y() > 0.0;
    if (met) raise(found.rebound, height / kDrop);
  }
  return found;
}

void compare(Run& run, const ModelPtr& model, const AngleAxisd& turn, double youngsModulus) {
  const Bounce game = bounce(run, model, turn, youngsModulus, kGame);
  const Bounce fine = bounce(run, model, turn, youngsModulus, kFine);
  run.report("rebound", game.rebound);
  run.report("rebound beside 64 substeps", game.rebound - fine.rebound);
  run.report("energy over its start", std::max(game.energy, fine.energy));
}

}  // namespace

void addBounceScenes(ContactScenes& scenes) {
  const AngleAxisd flat = AngleAxisd::Identity(), edge(EIGEN_PI / 4, Vector3d::UnitZ()),
                   corner(std::atan(std::sqrt(2.0)), Vector3d(1, 0, -1).normalized());
  const auto add = [&](const std::string& name, const ModelPtr& model, const AngleAxisd& turn) {
    for (const double modulus : {300.0, 1000.0, 3000.0}) {
      scenes.push_back({"bounce/" + name + "/" + text(modulus) + "Pa",
                        [=](Run& run) { compare(run, model, turn, modulus); },
                        {Kind::Surface}});
    }
  };
  add("ball", makeBall(400), flat);
  const ModelPtr cube = makeBox(Vector3d::Constant(0.35), 6);
  add("cube on a face", cube, flat);
  add("cube on an edge", cube, edge);
  add("cube on a corner", cube, corner);
}

}  // namespace tetskin::contact_demo
