// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/bone_palette.h>
#include <tetskin/io/animation.h>
#include <tetskin/io/src/animation/affine_bone.h>
#include <tetskin/io/src/animation/glb_scene.h>
#include <tetskin/io/src/animation/skinned_geometry.h>
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

namespace tetskin {
namespace {

using io::GlbNode;

/// Approximate bytes of the text that describes one moving property, and one node.
constexpr double kChannelText = 200.0, kNodeText = 110.0;

/// Reference point of positions: the centre of a box that is far from the origin for its size, otherwise the origin.
Eigen::Vector3d originFor(const Box3& box) {
  constexpr double kFarOut = 100.0;
  if (box.isEmpty() || box.center().norm() <= kFarOut * box.sizes().maxCoeff()) return Eigen::Vector3d::Zero();
  return box.center();
}

void appendTranslation(const Eigen::Vector3d& translation, GlbNode& node) {
  for (int k = 0; k < 3; ++k) node.translations.push_back(static_cast<float>(translation[k]));
}

/// Appends the one of a rotation's two quaternions that is nearer to the last.
void appendRotation(const Eigen::Matrix3d& rotation, GlbNode& node) {
  Eigen::Vector4d now = Eigen::Quaterniond(rotation).normalized().coeffs();
  if (!node.rotations.empty()) {
    const Eigen::Map<const Eigen::Vector4f> last(&node.rotations[node.rotations.size() - 4]);
    if (now.dot(last.cast<double>()) < 0.0) now = -now;
  }
  for (int k = 0; k < 4; ++k) node.rotations.push_back(static_cast<float>(now[k]));
}

void appendScale(const Eigen::Vector3d& scale, GlbNode& node) {
  for (int k = 0; k < 3; ++k) node.scales.push_back(static_cast<float>(scale[k]));
}

Status animationFinished() {
  return {StatusCode::FileNotWritable, "the animation is finished; create another writer"};
}

Status checkTriangles(const std::string& path, const std::string& name, const io::GlbMesh& mesh) {
  if (!mesh.parts.empty()) return {};
  return io::fileError(StatusCode::Empty, path, 0, "cannot hold " + name + ", which has no triangles");
}

}  // namespace

struct GlbWriter::Impl {
  struct Model {
    std::string name;
    Interpolation interpolation = Interpolation::Linear;
    std::size_t mesh = 0;  ///< in the scene
    std::size_t nodeCount = 0;
    std::vector<std::size_t> bones;  ///< the nodes that are bones, ascending
    std::unique_ptr<BonePalette<double>> palette;
  };
  struct Body {
    std::size_t model = 0, firstNode = 0;  ///< the scene's node of its first bone; a bone is one node or two
    std::vector<io::AffineBone> bones;     ///< of a quadratic body: those of the last frame
  };
  struct Object {
    std::size_t node = 0;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< reference point of its positions
    bool moves = false;
  };

  std::size_t materialNumber(const std::string& name, bool textured);
  io::MaterialNumber materialNumbers() {
    return [this](const std::string& name, bool textured) { return materialNumber(name, textured); };
  }
  std::string uniqueName(const std::string& wanted);
  std::size_t addNode(const std::string& wanted) {
    scene.nodes.emplace_back().name = uniqueName(wanted);
    return scene.nodes.size() - 1;
  }
  bool isQuadratic(const Body& body) const { return models[body.model].interpolation == Interpolation::Quadratic; }
  void begin(const std::vector<PointView<const double>>& nodes);
  Status checkFrame(const std::vector<PointView<const double>>& nodes, const std::vector<Eigen::Affine3d>& places);
  void addTranslations(const Body& body, PointView<const double> nodes);
  void addAffineBones(Body& body, PointView<const double> nodes);
  double bytesFor(double frames) const;

  std::string path;
  double framesPerSecond = 0.0;
  io::GlbScene scene;
  std::vector<Model> models;
  std::vector<Body> bodies;
  std::vector<Object> objects;
  std::set<std::string> names;             ///< of nodes
  std::vector<SurfaceMaterial> materials;  ///< as given; those in use are in the scene
  std::vector<float> matrices;             ///< of one model
};

std::size_t GlbWriter::Impl::materialNumber(const std::string& name, bool textured) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name == io::asUtf8(name) && scene.materials[m].textured == textured) return m;
  }
  io::GlbMaterial material;
  for (const SurfaceMaterial& known : materials) {
    if (known.name == name) static_cast<SurfaceMaterial&>(material) = known;
  }
  material.name = io::asUtf8(name);
  material.textured = textured;
  scene.materials.push_back(material);
  return scene.materials.size() - 1;
}

/// Players address nodes by name, so each name must be unique.
std::string GlbWriter::Impl::uniqueName(const std::string& wanted) {
  const std::string base = wanted.empty() ? "body" : io::asUtf8(wanted);
  std::string name = base;
  for (int number = 2; !names.insert(name).second; ++number) name = base + "_" + std::to_string(number);
  return name;
}

GlbWriter::GlbWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlbWriter::~GlbWriter() = default;
GlbWriter::GlbWriter(GlbWriter&& other) noexcept = default;
GlbWriter& GlbWriter::operator=(GlbWriter&& other) noexcept = default;

std::string GlbWriter::whyNot() {
  return io::whyNoGltf();
}

Result<GlbWriter> GlbWriter::create(const std::string& path, double framesPerSecond) {
  if (const std::string reason = whyNot(); !reason.empty()) {
    return io::fileError(StatusCode::UnsupportedFormat, path, 0, "cannot be written: " + reason);
  }
  if (!(framesPerSecond > 0.0 && std::isfinite(framesPerSecond))) {
    return io::fileError(StatusCode::InvalidOption, path, 0, "the frames per second must be above 0 and finite");
  }
  // Opened and removed again: it is better to learn before a run than after it that a file cannot be written.
  if (const Result<io::AtomicFile> probe = io::AtomicFile::create(path); !probe.ok()) return probe.status();
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->framesPerSecond = framesPerSecond;
  return GlbWriter(std::move(impl));
}

void GlbWriter::setMaterials(std::vector<SurfaceMaterial> materials) {
  if (!impl_) return;
  assert(impl_->scene.meshes.empty());
  impl_->materials = std::move(materials);
}

Result<std::size_t> GlbWriter::addModel(const std::string& name, const Cage& cage, const TriangleMesh& mesh,
                                        const Embedding& embedding, Interpolation interpolation) {
  if (!impl_) return animationFinished();
  assert(impl_->scene.times.empty());
  BindingOptions options;
  options.interpolation = interpolation;
  const auto binding = SkinBinding<double>::create(cage, mesh, options, embedding);
  if (!binding.ok()) return io::fileError(binding.status().code, impl_->path, 0, binding.status().message);

  Impl::Model model;
  model.name = name;
  model.interpolation = interpolation;
  model.mesh = impl_->scene.meshes.size();
  model.nodeCount = cage.mesh.nodeCount();
  model.bones = io::bonesOf(embedding);
  if (model.bones.size() > SkinnedMesh::kMaxBones) {
    return io::fileError(
        StatusCode::TooLarge, impl_->path, 0,
        "cannot hold " + name + ", as " + std::to_string(model.bones.size()) +
            " nodes of its cage carry vertices, but at most 65536 bones are possible; use a coarser cage");
  }
  if (interpolation == Interpolation::Quadratic) {
    auto palette = BonePalette<double>::create(binding.value());
    if (!palette.ok()) return palette.status();
    model.palette = std::make_unique<BonePalette<double>>(std::move(palette).value());
  }
  io::GlbMesh geometry = io::skinnedGeometry(io::asUtf8(name), cage, mesh, embedding, interpolation, model.bones,
                                             originFor(boundingBox(cage.mesh.nodes)), impl_->materialNumbers());
  if (Status status = checkTriangles(impl_->path, name, geometry); !status.ok()) return status;
  impl_->scene.meshes.push_back(std::move(geometry));
  impl_->models.push_back(std::move(model));
  return impl_->models.size() - 1;
}

void GlbWriter::addBody(std::size_t model, const std::string& name) {
  if (!impl_) return;
  assert(impl_->scene.times.empty() && model < impl_->models.size());
  io::GlbScene& scene = impl_->scene;
  const Impl::Model& shared = impl_->models[model];
  const std::size_t drawn = impl_->addNode(name);
  const std::string unique = scene.nodes[drawn].name;
  const std::size_t root = impl_->addNode(unique + "_cage");
  scene.nodes[drawn].mesh = static_cast<int>(shared.mesh);
  scene.nodes[drawn].skin = static_cast<int>(scene.skins.size());
  scene.roots.insert(scene.roots.end(), {drawn, root});
  io::GlbSkin& skin = scene.skins.emplace_back();
  skin.mesh = shared.mesh;

  Impl::Body body;
  body.model = model;
  body.firstNode = scene.nodes.size();
  for (const std::size_t node : shared.bones) {
    const std::string bone = unique + "_node" + std::to_string(node);
    const std::size_t upper = impl_->addNode(bone);
    scene.nodes[root].children.push_back(upper);
    skin.joints.push_back(upper);
    if (!shared.palette) continue;
    skin.joints.back() = impl_->addNode(bone + "_turn");
    scene.nodes[upper].children.push_back(skin.joints.back());
  }
  if (shared.palette) body.bones.resize(shared.bones.size());
  impl_->bodies.push_back(std::move(body));
}

Status GlbWriter::addObject(const std::string& name, const TriangleMesh& mesh, bool moves) {
  if (!impl_) return animationFinished();
  assert(impl_->scene.times.empty());
  Impl::Object object;
  object.moves = moves;
  object.origin = originFor(boundingBox(mesh.positions));
  io::GlbMesh geometry = io::rigidGeometry(io::asUtf8(name), mesh, object.origin, impl_->materialNumbers());
  if (Status status = checkTriangles(impl_->path, name, geometry); !status.ok()) return status;
  object.node = impl_->addNode(name);
  impl_->scene.nodes[object.node].mesh = static_cast<int>(impl_->scene.meshes.size());
  impl_->scene.meshes.push_back(std::move(geometry));
  impl_->scene.roots.push_back(object.node);
  impl_->objects.push_back(object);
  return {};
}

double GlbWriter::Impl::bytesFor(double frames) const {
  double floats = 0.0, channels = 0.0;
  for (const Body& body : bodies) {
    const double bones = static_cast<double>(models[body.model].bones.size());
    floats += bones * (isQuadratic(body) ? 14.0 : 3.0);
    channels += bones * (isQuadratic(body) ? 4.0 : 1.0);
  }
  for (const Object& object : objects) {
    floats += object.moves ? 7.0 : 0.0;
    channels += object.moves ? 2.0 : 0.0;
  }
  return io::binaryBytes(scene) + sizeof(float) * floats * (frames - static_cast<double>(scene.times.size())) +
         kChannelText * channels + kNodeText * static_cast<double>(scene.nodes.size());
}

double GlbWriter::bytesFor(int frames) const {
  return impl_ ? impl_->bytesFor(frames) : 0.0;
}

/// Chooses the reference points of positions.
void GlbWriter::Impl::begin(const std::vector<PointView<const double>>& nodes) {
  Box3 box;
  for (const PointView<const double>& body : nodes) box.extend(boundingBox(body));
  scene.origin = originFor(box);
  for (const Object& object : objects) {
    if (!object.moves) scene.nodes[object.node].translation = object.origin - scene.origin;
  }
}

Status GlbWriter::Impl::checkFrame(const std::vector<PointView<const double>>& nodes,
                                   const std::vector<Eigen::Affine3d>& places) {
  const auto moving = std::count_if(objects.begin(), objects.end(), [](const Object& o) { return o.moves; });
  const auto differs = [&](const char* what, std::size_t given, std::size_t wanted) {
    return io::fileError(
        StatusCode::SizeMismatch, path, 0,
        std::to_string(given) + " " + what + " were given, but the animation has " + std::to_string(wanted));
  };
  if (nodes.size() != bodies.size()) return differs("bodies", nodes.size(), bodies.size());
  if (places.size() != static_cast<std::size_t>(moving)) {
    return differs("moving objects", places.size(), static_cast<std::size_t>(moving));
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::size_t count = models[bodies[b].model].nodeCount;
    if (nodes[b].size() != count) return differs("nodes", nodes[b].size(), count);
    const std::size_t bad = firstUnusable(nodes[b]);
    if (bad < count) {
      return io::fileError(
          StatusCode::NonFinite, path, 0,
          "node " + std::to_string(bad) + " of body " + std::to_string(b) + " is not finite, or too far away");
    }
  }
  for (const Eigen::Affine3d& place : places) {
    if (!place.matrix().allFinite()) {
      return io::fileError(StatusCode::NonFinite, path, 0, "the place of an object is not finite");
    }
  }
  if (bytesFor(static_cast<double>(scene.times.size() + 1)) <= io::kMaxGlbBytes) return {};
  return io::fileError(StatusCode::TooLarge, path, 0,
                       "has no room for frame " + std::to_string(scene.times.size()) +
                           ", as a GLB has at most 4 GB; write fewer frames, or a coarser cage");
}

void GlbWriter::Impl::addTranslations(const Body& body, PointView<const double> nodes) {
  const std::vector<std::size_t>& bones = models[body.model].bones;
  for (std::size_t j = 0; j < bones.size(); ++j) {
    const Eigen::Map<const Eigen::Vector3d> at(nodes[bones[j]]);
    appendTranslation(at - scene.origin, scene.nodes[body.firstNode + j]);
  }
}

void GlbWriter::Impl::addAffineBones(Body& body, PointView<const double> nodes) {
  const Model& model = models[body.model];
  constexpr std::size_t kFloats = boneFloats(BoneLayout::Rows);
  matrices.resize(kFloats * model.nodeCount);
  [[maybe_unused]] const StatusCode code = model.palette->update(nodes, {matrices.data(), model.nodeCount, 0});
  assert(code == StatusCode::Ok);
  for (std::size_t j = 0; j < model.bones.size(); ++j) {
    const std::size_t bone = model.bones[j];
    const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> matrix(&matrices[kFloats * bone]);
    body.bones[j].set(matrix.leftCols<3>().cast<double>());
    GlbNode &upper = scene.nodes[body.firstNode + 2 * j], &lower = scene.nodes[body.firstNode + 2 * j + 1];
    const Eigen::Map<const Eigen::Vector3d> at(nodes[bone]);
    appendTranslation(at - scene.origin, upper);
    appendRotation(body.bones[j].upper, upper);
    appendScale(body.bones[j].scale, upper);
    appendRotation(body.bones[j].lower.transpose(), lower);
  }
}

Status GlbWriter::addFrame(const std::vector<PointView<const double>>& nodes,
                           const std::vector<Eigen::Affine3d>& places) {
  if (!impl_) return animationFinished();
  io::GlbScene& scene = impl_->scene;
  if (Status status = impl_->checkFrame(nodes, places); !status.ok()) return status;
  if (scene.times.empty()) impl_->begin(nodes);
  scene.times.push_back(static_cast<float>(static_cast<double>(scene.times.size()) / impl_->framesPerSecond));
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    Impl::Body& body = impl_->bodies[b];
    if (impl_->isQuadratic(body)) {
      impl_->addAffineBones(body, nodes[b]);
    } else {
      impl_->addTranslations(body, nodes[b]);
    }
  }
  auto place = places.begin();
  for (const Impl::Object& object : impl_->objects) {
    if (!object.moves) continue;
    appendTranslation(*place * object.origin - scene.origin, scene.nodes[object.node]);
    appendRotation(place->linear(), scene.nodes[object.node]);
    ++place;
  }
  return {};
}

Status GlbWriter::finish() {
  if (!impl_) return animationFinished();
  const std::unique_ptr<Impl> impl = std::move(impl_);
  if (impl->scene.times.empty() || impl->scene.roots.empty()) {
    return io::fileError(StatusCode::Empty, impl->path, 0,
                         "cannot be written, as there is nothing to show; add a body and a frame first");
  }
#ifdef TETSKIN_TINYGLTF
  return io::writeFile(impl->path, io::glbBytes(impl->scene));
#else
  return io::fileError(StatusCode::UnsupportedFormat, impl->path, 0, "cannot be written: " + whyNot());
#endif
}

namespace io {

double binaryBytes(const GlbScene& scene) {
  std::size_t bytes = sizeof(float) * scene.times.size();
  const auto add = [&](const auto& numbers) { bytes += (sizeof(numbers[0]) * numbers.size() + 3) / 4 * 4; };
  for (const GlbMesh& mesh : scene.meshes) {
    for (const auto* numbers : {&mesh.positions, &mesh.normals, &mesh.texcoords, &mesh.weights, &mesh.inverseBinds}) {
      add(*numbers);
    }
    add(mesh.joints);
    for (const GlbPart& part : mesh.parts) {
      const std::size_t size = mesh.positions.size() / 3 < 0xFFFF ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
      bytes += (size * part.corners.size() + 3) / 4 * 4;
    }
  }
  for (const GlbNode& node : scene.nodes) {
    for (const auto* numbers : {&node.translations, &node.rotations, &node.scales}) add(*numbers);
  }
  return static_cast<double>(bytes);
}

}  // namespace io

}  // namespace tetskin
