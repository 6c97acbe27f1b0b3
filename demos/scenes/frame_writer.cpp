// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/frame_writer.h"

#include <tetskin/io/tet_files.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

#include "scenes/files.h"
#include "scenes/input_error.h"

namespace tetskin::scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* kListName = ".tetskin_frames";

std::string cageName(int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "cage_%04d.vtk", frame);
  return name;
}

/// Whether a line of the list is a name that a run here gives: the list may have been edited.
bool isOurs(const std::string& name) {
  const std::size_t first = name.find('_') + 1, end = name.find('.');
  const auto is = [&](const char* base, const char* extension) {
    return name.compare(0, first, base) == 0 && name.compare(end, std::string::npos, extension) == 0;
  };
  if (end == std::string::npos || end <= first || !(is("frame_", ".obj") || is("cage_", ".vtk"))) return false;
  return name.find_first_not_of("0123456789", first) == end;
}

}  // namespace

bool fitsFloat(const Box3& box) {
  constexpr double kFarOut = 100.0;  ///< sizes from the origin
  return box.center().norm() <= kFarOut * box.sizes().maxCoeff();
}

FrameWriter::FrameWriter(const FramePlan& plan, const ObjLayout& layout) : plan_(plan) {
  Result<ObjSequenceWriter> writer = ObjSequenceWriter::create(plan.folder, layout);
  require(writer.status());
  writer_ = std::move(writer).value();
}

void FrameWriter::write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds,
                        PointView<const float> normals) {
  if (frame == 0) replaceEarlierRun();
  if (!fitsFloat(bounds)) return require(writer_.write(frame, viewOf(surface), normals));
  rounded_.resize(surface.size());
  for (std::size_t v = 0; v < surface.size(); ++v) rounded_[v] = surface[v].cast<float>();
  require(writer_.write(frame, viewOf(std::as_const(rounded_)), normals));
}

void FrameWriter::writeCage(int frame, const TetMesh& cage) {
  require(saveTetMesh(cage, (fs::path(plan_.folder) / cageName(frame)).string()));
}

std::string FrameWriter::announcement() const {
  const int count = (plan_.frames - 1) / plan_.every + 1;
  double megabytes = 0.0;
  for (const std::string& name : filesOf(0)) {
    megabytes += 1e-6 * count * static_cast<double>(fs::file_size(fs::path(plan_.folder) / name));
  }
  char text[96];
  std::snprintf(text, sizeof text, "writing %d frames, about %.*f MB, to ", count, megabytes < 10.0 ? 1 : 0, megabytes);
  return text + plan_.folder;
}

std::vector<std::string> FrameWriter::filesOf(int frame) const {
  std::vector<std::string> names = {fs::path(writer_.framePath(frame)).filename().string()};
  if (plan_.cages) names.push_back(cageName(frame));
  return names;
}

void FrameWriter::replaceEarlierRun() const {
  std::set<std::string> names;
  std::string list;
  for (int frame = 0; frame < plan_.frames; frame += plan_.every) {
    for (const std::string& name : filesOf(frame)) {
      names.insert(name);
      list += name + "\n";
    }
  }
  const fs::path listPath = fs::path(plan_.folder) / kListName;
  std::ifstream earlier(listPath);
  for (std::string name; std::getline(earlier, name);) {
    std::error_code error;
    if (isOurs(name) && names.count(name) == 0) fs::remove(fs::path(plan_.folder) / name, error);
    if (error) throw InputError(plan_.folder + ": " + name + " of an earlier run cannot be removed");
  }
  writeFile(listPath.string(), list);
}

}  // namespace tetskin::scenes
