// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/frame_writer.h"

#include <tetskin/io/files.h>

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/materials.h"

namespace tetskin::scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* kListName = ".tetskin_frames";
/// The material library of all frames.
constexpr const char* kLibraryName = "tetskin_frames.mtl";
constexpr const char* kCacheName = "animation.pc2";
constexpr const char* kCacheMeshName = "animation.obj";
constexpr std::size_t kCacheHeader = 32, kCachePoint = 12;  ///< bytes

std::string cageName(int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "cage_%04d.vtk", frame);
  return name;
}

bool isNumbered(const std::string& name, const std::string& base, const std::string& extension) {
  const std::size_t first = base.size(), end = name.find('.');
  if (end == std::string::npos || end <= first) return false;
  return name.compare(0, first, base) == 0 && name.compare(end, std::string::npos, extension) == 0 &&
         name.find_first_not_of("0123456789", first) == end;
}

/// The size of the file that `saveTetMesh` writes as .vtk.
std::size_t vtkBytes(const TetMesh& cage) {
  constexpr std::size_t kHead = 120, kOfTet = sizeof "4 \n10\n" - 1;
  std::string numbers;
  for (const Eigen::Vector3d& p : cage.nodes) {
    for (const double x : p) appendNumber(numbers += ' ', x);
  }
  for (const Tet& tet : cage.tets) {
    for (const int node : tet) appendNumber(numbers += ' ', node);
  }
  return kHead + numbers.size() + kOfTet * cage.tetCount();
}

std::string framesText(int count) {
  return std::to_string(count) + (count == 1 ? " frame" : " frames");
}

/// A file that has its name only at the end of a run.
bool isOfAllFrames(const std::string& name) {
  return name == "animation.glb" || name == kCacheName || name == kCacheMeshName || name == "animation.mtl";
}

}  // namespace

bool isOfFrames(const std::string& name) {
  for (const char* known : {kListName, kLibraryName, "obstacles.obj", "obstacles.mtl"}) {
    if (name == known) return true;
  }
  if (isOfAllFrames(name)) return true;
  return isNumbered(name, "frame_", ".obj") || isNumbered(name, "frame_", ".mtl") || isNumbered(name, "cage_", ".vtk");
}

namespace {

std::set<std::string> filesOfEarlierRun(const fs::path& folder) {
  std::set<std::string> names;
  std::ifstream list(folder / kListName);
  for (std::string name; std::getline(list, name);) {
    if (isOfFrames(name) && name != kListName) names.insert(name);  // otherwise it was edited
  }
  return names;
}

/// The folder need not exist yet.
void requireRoom(const FramePlan& plan, double bytes) {
  std::error_code error;
  auto room = static_cast<double>(fs::space(existingComponent(plan.folder), error).available);
  if (error) return;  // the file system does not report it
  for (const std::string& name : filesOfEarlierRun(plan.folder)) {
    const auto size = fs::file_size(fs::path(plan.folder) / name, error);
    if (!error) room += static_cast<double>(size);
  }
  if (bytes <= room) return;
  throw InputError(plan.folder + ": " + framesText(plan.count()) + (plan.count() == 1 ? " takes" : " take") +
                   " about " + sizeText(bytes) + ", and the disk has room for " + sizeText(room) +
                   "; write fewer with --every or --frames, or to another disk with --out");
}

}  // namespace

void requireRoomFor(const TriangleMesh& mesh, const ObjLayout& layout, const OutputOptions& options) {
  std::vector<Eigen::Vector3f> points(mesh.vertexCount());
  std::transform(mesh.positions.begin(), mesh.positions.end(), points.begin(),
                 [](const Eigen::Vector3d& p) { return p.cast<float>(); });
  std::vector<char> buffer;
  const FramePlan plan = framePlanOf(options);
  double bytes = 0.0;
  if (plan.formats.obj) bytes += static_cast<double>(layout.format(viewOf(std::as_const(points)), buffer).size());
  if (plan.formats.pc2) bytes += static_cast<double>(kCachePoint * points.size());
  requireRoom(plan, plan.count() * bytes);
}

bool fitsFloat(const Box3& box) {
  constexpr double kFarOut = 100.0;  ///< in units of the size, from the origin
  return box.center().norm() <= kFarOut * box.sizes().maxCoeff();
}

FramePlan framePlanOf(const OutputOptions& options) {
  FramePlan plan;
  plan.folder = options.out;
  plan.formats = formatsOf(options);
  plan.frames = options.frames;
  plan.every = options.every;
  plan.quiet = options.quiet;
  return plan;
}

FramePlan framePlanOf(const OutputOptions& options, const TriangleMesh& drawn, const TriangleMesh& obstacles) {
  FramePlan plan = framePlanOf(options);
  plan.materials = materialLibrary(drawn);
  plan.obstacles = obstacles;
  return plan;
}

FrameWriter::FrameWriter(const FramePlan& plan, const ObjLayout& layout)
    : plan_(plan), layout_(plan.materials.empty() ? layout : layout.withMaterialLibrary(kLibraryName)) {
  assert(plan.frames > 0 && plan.every > 0);
  Result<ObjSequenceWriter> writer = ObjSequenceWriter::create(plan.folder, layout_);
  require(writer.status());
  writer_ = std::move(writer).value();
  refuseFramesOfOthers();
}

void FrameWriter::write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds,
                        PointView<const float> normals, const TetMesh* cage) {
  assert((cage != nullptr) == plan_.cages);
  if (!fitsFloat(bounds)) return writeFrame(frame, viewOf(surface), normals, cage);
  rounded_.resize(surface.size());
  for (std::size_t v = 0; v < surface.size(); ++v) rounded_[v] = surface[v].cast<float>();
  writeFrame(frame, viewOf(std::as_const(rounded_)), normals, cage);
}

template <class Scalar>
void FrameWriter::writeFrame(int frame, PointView<const Scalar> surface, PointView<const float> normals,
                             const TetMesh* cage) {
  if (frame == 0) {
    std::vector<char> buffer;
    const std::size_t obj = layout_.format(surface, buffer, normals).size() + plan_.materials.size();
    const std::size_t point = kCachePoint * surface.size(), beside = cage ? vtkBytes(*cage) : 0;
    const auto [writesObj, writesGlb, writesCache] = plan_.formats;
    const std::size_t ofFrame = (writesObj ? obj : 0) + (writesCache ? point : 0) + beside;
    begin(plan_.count() * static_cast<double>(ofFrame) + static_cast<double>(writesCache ? obj + kCacheHeader : 0) +
          otherBytes_);
    if (writesCache) beginCache(surface, normals);
    layout_ = {};
  }
  if (plan_.formats.obj) {
    require(writer_.write(frame, surface, normals));
    writeMaterials(fs::path(writer_.framePath(frame)).stem().string() + ".mtl", plan_.materials);
  }
  if (cache_) require(cache_->addFrame(surface));
  if (cage) require(saveTetMesh(*cage, pathOf(cageName(frame))));
}

template <class Scalar>
void FrameWriter::beginCache(PointView<const Scalar> surface, PointView<const float> normals) {
  require(layout_.writeTo(pathOf(kCacheMeshName), surface, normals));
  writeMaterials("animation.mtl", plan_.materials);
  Result<Pc2Writer> cache =
      Pc2Writer::create(pathOf(kCacheName), surface.size(), 0.0f, static_cast<float>(plan_.every));
  require(cache.status());
  cache_.emplace(std::move(cache).value());
}

void FrameWriter::addOther(const std::string& name, double bytes) {
  others_.push_back(name);
  otherBytes_ += bytes;
  refuseFramesOfOthers();
}

void FrameWriter::finish() {
  if (!cache_) return;
  require(cache_->finish());
  cache_.reset();
}

/// All frames have about as many bytes as the first one.
void FrameWriter::begin(double bytes) {
  requireRoom(plan_, bytes);
  if (!plan_.quiet) std::printf("%s\n", announcement(bytes).c_str());
  replaceEarlierRun();
  writeMaterials(kLibraryName, plan_.materials);
  if (plan_.obstacles.positions.empty()) return;
  const ObjLayout layout = ObjLayout::create(plan_.obstacles).withMaterialLibrary("obstacles.mtl");
  require(layout.writeTo(pathOf("obstacles.obj"), viewOf(plan_.obstacles.positions)));
  writeMaterials("obstacles.mtl", materialLibrary(plan_.obstacles));
}

std::string FrameWriter::announcement(double bytes) const {
  std::vector<std::string> parts;
  if (plan_.formats.obj || plan_.cages) parts.push_back(framesText(plan_.count()));
  if (plan_.formats.pc2) parts.emplace_back(kCacheName);
  parts.insert(parts.end(), others_.begin(), others_.end());
  std::string text = "writing ";
  for (std::size_t k = 0; k < parts.size(); ++k) {
    text += (k == 0 ? "" : k + 1 < parts.size() ? ", " : " and ") + parts[k];
  }
  return text + ", about " + sizeText(bytes) + ", to " + plan_.folder;
}

std::vector<std::string> FrameWriter::filesOf(int frame) const {
  const fs::path path = fs::path(writer_.framePath(frame)).filename();
  std::vector<std::string> names;
  if (plan_.formats.obj) names.push_back(path.string());
  if (plan_.formats.obj && !plan_.materials.empty()) names.push_back(path.stem().string() + ".mtl");
  if (plan_.cages) names.push_back(cageName(frame));
  return names;
}

std::vector<std::string> FrameWriter::filesOfAllFrames() const {
  std::vector<std::string> names = others_;
  if (!plan_.materials.empty()) names.emplace_back(kLibraryName);
  if (plan_.formats.pc2) names.insert(names.end(), {kCacheName, kCacheMeshName});
  if (plan_.formats.pc2 && !plan_.materials.empty()) names.emplace_back("animation.mtl");
  if (!plan_.obstacles.positions.empty()) names.insert(names.end(), {"obstacles.obj", "obstacles.mtl"});
  for (int count = 0; count < plan_.count(); ++count) {
    for (std::string& name : filesOf(count * plan_.every)) names.push_back(std::move(name));
  }
  return names;
}

/// Two sequences in one folder would be mistaken for one.
void FrameWriter::refuseFramesOfOthers() const {
  const std::set<std::string> known = filesOfEarlierRun(plan_.folder);
  const std::vector<std::string> ours = filesOfAllFrames();
  for (const fs::directory_entry& entry : fs::directory_iterator(plan_.folder)) {
    const std::string name = entry.path().filename().string();
    const bool frame = name.rfind("frame_", 0) == 0 && entry.path().extension() == ".obj";
    const bool all = isOfAllFrames(name) && std::count(ours.begin(), ours.end(), name) > 0;
    if ((!frame && !all) || known.count(name) > 0) continue;
    throw InputError(
        plan_.folder + ": " + name +
        " was not written by an earlier tetskin run and would be mixed with the files of this one; move it, or "
        "choose another folder with --out");
  }
}

void FrameWriter::replaceEarlierRun() const {
  const std::vector<std::string> names = filesOfAllFrames();
  const std::set<std::string> kept(names.begin(), names.end());
  for (const std::string& name : filesOfEarlierRun(plan_.folder)) {
    if (kept.count(name) > 0 && !isOfAllFrames(name)) continue;
    std::error_code error;
    fs::remove(pathOf(name), error);
    if (error)
      throw InputError(plan_.folder + ": " + name +
                       ", written by an earlier run, cannot be removed; check the permissions of the folder");
  }
  std::string list;
  for (const std::string& name : names) list += name + "\n";
  writeFile(pathOf(kListName), list);
}

void FrameWriter::writeMaterials(const std::string& name, const std::string& library) const {
  if (!library.empty()) writeFile(pathOf(name), library);
}

std::string FrameWriter::pathOf(const std::string& name) const {
  return (fs::path(plan_.folder) / name).string();
}

}  // namespace tetskin::scenes
