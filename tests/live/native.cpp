// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays a scene of the live page natively, for comparison with JavaScript: the state's bits, with `deterministic`, and
// the time.
//   live_native SCENE FRAMES [--any] [--fast]   SCENE: what describe.js writes
// Prints the hash of the state after each 30 frames of four substeps, and the median time of frames, in milliseconds,
// with the instructions that each processor of this architecture has.
//   --any   with those that this processor has
//   --fast  without `deterministic`
#include <btBulletDynamicsCommon.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/replay/src/exported/state_hash.h>
#include <tetskin/world/world.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace tetskin;

/// The words of a line, and then numbers.
class Words {
 public:
  explicit Words(const std::string& line) : stream_(line) {}
  std::string word() {
    std::string text;
    if (!(stream_ >> text)) throw std::runtime_error("a line of the scene is too short");
    return text;
  }
  double number() { return std::strtod(word().c_str(), nullptr); }
  btVector3 vector() {
    const auto x = btScalar(number()), y = btScalar(number()), z = btScalar(number());
    return {x, y, z};
  }
  btTransform pose() {
    const btVector3 position = vector();
    const auto x = btScalar(number()), y = btScalar(number()), z = btScalar(number()), w = btScalar(number());
    return btTransform(btQuaternion(x, y, z, w).normalized(), position);
  }
  /// The same, of a cage.
  Eigen::Affine3d placement() {
    double n[7];
    for (double& x : n) x = number();
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
    placement.translate(Eigen::Vector3d(n[0], n[1], n[2]));
    const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
    if (q.vec() != Eigen::Vector3d::Zero()) placement.rotate(q.normalized());
    return placement;
  }

 private:
  std::istringstream stream_;
};

/// Two counts, positions of three 64-bit floats, triangles of three 32-bit integers.
TriangleMesh readMesh(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::int32_t counts[2] = {};
  file.read(reinterpret_cast<char*>(counts), sizeof counts);
  TriangleMesh mesh;
  if (file) {
    mesh.positions.resize(static_cast<std::size_t>(counts[0]));
    mesh.triangles.resize(static_cast<std::size_t>(counts[1]));
  }
  for (Eigen::Vector3d& p : mesh.positions) file.read(reinterpret_cast<char*>(p.data()), 3 * sizeof(double));
  for (auto& triangle : mesh.triangles) file.read(reinterpret_cast<char*>(&triangle[0]), 3 * sizeof(std::int32_t));
  if (!file) throw std::runtime_error(path + ": not read");
  return mesh;
}

class Scene {
 public:
  Scene(const std::string& path, const WorldOptions& options) : world_(options) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) add(Words(line));
    if (world_.bodies().empty()) throw std::runtime_error(path + ": no scene");
  }

  void step() { (void)world_.step(1.0 / 60).value(); }

  std::uint64_t hash() const { return bullet_detail::stateHash(world_.bullet()); }

  std::size_t tets() const {
    std::size_t sum = 0;
    for (const auto& body : world_.bodies()) sum += body->cage->mesh.tets.size();
    return sum;
  }

 private:
  void add(Words words) {
    const std::string kind = words.word();
    if (kind == "mesh") {
      const std::string name = words.word();
      meshes_[name] = std::make_shared<const TriangleMesh>(readMesh(words.word()));
    } else if (kind == "box") {
      addRigid(std::make_shared<btBoxShape>(words.vector()), words);
    } else if (kind == "sphere") {
      addRigid(std::make_shared<btSphereShape>(btScalar(words.number())), words);
    } else if (kind == "body") {
      addBody(words);
    } else {
      throw std::runtime_error("the scene has an unknown " + kind);
    }
  }

  /// Mass, position, rotation, friction.
  void addRigid(std::shared_ptr<btCollisionShape> shape, Words& words) {
    const double mass = words.number();
    const btTransform pose = words.pose();
    (void)world_.addRigidBody(std::move(shape), mass, pose, words.number()).value();
  }

  /// Mesh, tets, position, rotation, mass, relative stiffness, damping, friction, kind of contact among soft bodies.
  void addBody(Words& words) {
    const auto mesh = meshes_.at(words.word());
    CageOptions cageOptions;
    cageOptions.targetTets = static_cast<std::size_t>(words.number());
    const Eigen::Affine3d placement = words.placement();
    WorldBodyOptions options;
    options.material.faceTree = false;
    options.material.mass = words.number();
    options.material.relativeStiffness = words.number();
    options.material.stiffnessDamping = words.number();
    options.material.friction = words.number();
    const std::string contact = words.word();
    options.softContact = contact != "none";
    options.selfContact = contact == "self";
    const auto cage = std::make_shared<const Cage>(createCage(*mesh, cageOptions).value());
    (void)world_.addBody(cage, mesh, options, placement).value();
  }

  World world_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace

int main(int argc, char** argv) try {
  const int frames = argc > 2 ? std::atoi(argv[2]) : 0;
  bool any = false, fast = false;
  for (int i = 3; i < argc; ++i) {
    any |= std::strcmp(argv[i], "--any") == 0;
    fast |= std::strcmp(argv[i], "--fast") == 0;
  }
  if (frames < 1) return std::puts("usage: live_native SCENE FRAMES [--any] [--fast]"), 2;
  if (!any) setInstructionSet(InstructionSet::Baseline);
  WorldOptions options;
  options.deterministic = !fast;
  Scene scene(argv[1], options);
  std::vector<double> times;
  for (int frame = 0; frame < frames; ++frame) {
    const auto start = std::chrono::steady_clock::now();
    scene.step();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    if ((frame + 1) % 30 != 0) continue;
    std::printf("hash %d %016llx\n", frame + 1, static_cast<unsigned long long>(scene.hash()));
  }
  std::nth_element(times.begin(), times.begin() + frames / 2, times.end());
  std::printf("tets %zu\nmilliseconds %.3f\n", scene.tets(), times[static_cast<std::size_t>(frames) / 2]);
  return 0;
} catch (const std::exception& fault) {
  return std::puts(fault.what()), 2;
}
