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
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/replay/src/exported/state_hash.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

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

struct Rigid {
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btDefaultMotionState> motion;  // as in the module: it turns zeros of the basis positive
  std::unique_ptr<btRigidBody> body;
};

struct Soft {
  Cage cage;
  TriangleMesh mesh;
  std::unique_ptr<DeformableBody> body;
  std::shared_ptr<const SoftBodyBinding> binding;
  SoftBodySkin skin;
  std::unique_ptr<SurfaceContact> contact;
};

class Scene {
 public:
  Scene(const std::string& path, bool deterministic) {
    DeformableWorldOptions options;
    options.deterministic = deterministic;
    world_ = std::make_unique<DeformableWorld>(options);
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) add(Words(line));
    if (softs_.empty()) throw std::runtime_error(path + ": no scene");
  }
  ~Scene() {
    for (const auto& soft : softs_) {
      if (contacts_) contacts_->remove(soft->body->body());
    }
    softs_.clear();
    contacts_.reset();
    for (const Rigid& rigid : rigids_) world_->removeRigidBody(rigid.body.get());
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void step() {
    world_->stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 60 / 4);
    std::vector<SoftBodySkin*> skins;
    for (const auto& soft : softs_) skins.push_back(&soft->skin);
    SoftBodySkin::updateAll(skins.data(), skins.size());
  }

  std::uint64_t hash() const { return bullet_detail::stateHash(*world_); }

  std::size_t tets() const {
    std::size_t sum = 0;
    for (const auto& soft : softs_) sum += soft->cage.mesh.tets.size();
    return sum;
  }

 private:
  void add(Words words) {
    const std::string kind = words.word();
    if (kind == "mesh") {
      const std::string name = words.word();
      meshes_[name] = readMesh(words.word());
    } else if (kind == "box") {
      const btVector3 half = words.vector();
      addRigid(std::make_unique<btBoxShape>(half), words);
    } else if (kind == "sphere") {
      const auto radius = btScalar(words.number());
      addRigid(std::make_unique<btSphereShape>(radius), words);
    } else if (kind == "body") {
      addBody(words);
    } else {
      throw std::runtime_error("the scene has an unknown " + kind);
    }
  }

  /// Mass, position, rotation, friction.
  void addRigid(std::unique_ptr<btCollisionShape> shape, Words& words) {
    const auto mass = btScalar(words.number());
    const btTransform pose = words.pose();
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    auto motion = std::make_unique<btDefaultMotionState>(pose);
    btRigidBody::btRigidBodyConstructionInfo info(mass, motion.get(), shape.get(), inertia);
    info.m_friction = btScalar(words.number());
    auto body = std::make_unique<btRigidBody>(info);
    world_->addRigidBody(body.get());
    rigids_.push_back({std::move(shape), std::move(motion), std::move(body)});
  }

  /// Mesh, tets, position, rotation, mass, relative stiffness, damping, friction, kind of contact among soft bodies.
  void addBody(Words& words) {
    auto soft = std::make_unique<Soft>();
    soft->mesh = meshes_.at(words.word());
    CageOptions cageOptions;
    cageOptions.targetTets = static_cast<std::size_t>(words.number());
    soft->cage = createCage(soft->mesh, cageOptions).value();
    Cage placed = soft->cage;
    const Eigen::Affine3d placement = words.placement();
    for (Eigen::Vector3d& node : placed.mesh.nodes) node = placement * node;
    SoftBodyOptions material;
    material.faceTree = false;
    material.mass = words.number();
    material.relativeStiffness = words.number();
    material.stiffnessDamping = words.number();
    material.friction = words.number();
    soft->body = DeformableBody::add(*world_, placed, material).value();
    soft->binding = SoftBodyBinding::create(soft->cage, soft->mesh).value();
    if (!soft->skin.bind(soft->body->body(), soft->binding).ok()) throw std::runtime_error("not bound");
    soft->contact = SurfaceContact::add(*world_, soft->body->body(), *soft->binding, soft->mesh).value();
    const std::string contact = words.word();
    if (contact != "none") {
      if (!contacts_) contacts_ = SoftContacts::add(*world_).value();
      const auto shape = ContactShape::create(soft->cage, soft->mesh).value();
      if (!contacts_->add(soft->body->body(), shape, contact == "self").ok()) throw std::runtime_error("no contact");
    }
    softs_.push_back(std::move(soft));
  }

  std::unique_ptr<DeformableWorld> world_;
  std::map<std::string, TriangleMesh> meshes_;
  std::vector<Rigid> rigids_;
  std::unique_ptr<SoftContacts> contacts_;
  std::vector<std::unique_ptr<Soft>> softs_;
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
  Scene scene(argv[1], !fast);
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
