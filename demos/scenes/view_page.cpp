// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/view_page.h"

#include <cstdio>
#include <filesystem>

#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/materials.h"

namespace tetskin::scenes {
namespace {

constexpr const char* kFolder = TETSKIN_VIEW;
constexpr const char* kThree = TETSKIN_THREE;
constexpr const char* kOrbitControls = TETSKIN_ORBIT_CONTROLS;

}  // namespace

std::string whyNoView() {
  const std::string cure =
      "; install it (Debian: libjs-three) and configure again, or set TETSKIN_THREE and TETSKIN_ORBIT_CONTROLS to the "
      "paths of three.min.js and OrbitControls.js";
  if (std::string(kThree).empty() || std::string(kOrbitControls).empty()) return "three.js was not found" + cure;
  for (const char* path : {kThree, kOrbitControls}) {
    if (!std::filesystem::is_regular_file(path)) return std::string(path) + " no longer exists" + cure;
  }
  return {};
}

void requireViewable() {
  const std::string reason = whyNoView();
  if (!reason.empty()) throw InputError("--view: " + reason);
}

std::string viewPath(const OutputOptions& options) {
  if (options.noView && !options.view.empty()) throw InputError("--view and --no-view cannot be used together");
  if (!options.view.empty()) {
    requireViewable();
    return options.view;
  }
  if (!options.viewByDefault || options.noView) return {};
  const std::string reason = whyNoView();
  if (!reason.empty() && !options.quiet) std::printf("view.html is not written: %s\n", reason.c_str());
  if (!reason.empty()) return {};
  return (std::filesystem::path(options.out) / "view.html").string();
}

view::ViewFiles viewFiles() {
  return {kFolder, kThree, kOrbitControls};
}

ViewPage newPage(std::string title, std::vector<std::string> facts, Interpolation interpolation) {
  return ViewPage(std::move(title), std::move(facts), interpolation, viewMaterials());
}

void writePage(const ViewPage& page, const std::string& path, bool quiet) {
  const std::string text = page.html(viewFiles());
  writeFile(path, text);
  if (quiet) return;
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  std::printf("\nTo see the run in a browser (%s, %s), open file://%s\n", path.c_str(),
              sizeText(static_cast<double>(text.size())).c_str(), absolute.c_str());
}

std::vector<std::string> factsOf(const Model& model) {
  return {withCommas(model.mesh.vertexCount()) + " vertices", withCommas(model.mesh.triangleCount()) + " triangles",
          withCommas(model.cage.mesh.tetCount()) + " tets"};
}

std::string titleOf(const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  return file.empty() ? name : file;
}

std::string factOf(Contact contact, bool withItself) {
  const std::string where = contact == Contact::Surface ? "contact at the surface" : "contact at the cage's nodes";
  return withItself ? where + ", self-contact" : where;
}

}  // namespace tetskin::scenes
