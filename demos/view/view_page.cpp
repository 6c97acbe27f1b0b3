// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "view/view_page.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <sstream>

namespace tetskin::view {
namespace {

/// The scripts, in the order in which the page runs them.
constexpr const char* kScripts[] = {"data.js", "skin.js", "shading.js", "stage.js", "player.js"};

std::string partOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || !text) throw ViewError(path + ": cannot be read; the HTML page is made from it");
  return std::move(text).str();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Escapes what would look like the end of a script element.
std::string escaped(const std::string& script) {
  return replaced(script, "</", "<\\/");
}

std::string scripts(const std::string& folder) {
  std::string text;
  for (const char* name : kScripts) text += partOf(folder + "/" + name);
  return text;
}

/// The template, with each word of the form @NAME@ replaced once by its text.
std::string filled(const std::string& text, const std::vector<std::pair<std::string, std::string>>& words) {
  std::string result;
  std::size_t copied = 0;
  for (const auto& [word, instead] : words) {  // in the order of their appearance in the template
    const std::size_t at = text.find(word, copied);
    if (at == std::string::npos) throw ViewError("view.html: does not contain " + word);
    result.append(text, copied, at - copied);
    result += instead;
    copied = at + word.size();
  }
  return result.append(text, copied);
}

Json toJson(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}
Json toJson(const Box3& box) {
  return {{"min", toJson(box.min())}, {"max", toJson(box.max())}};
}

/// A coordinate inside a box, quantised to 16 bits.
std::uint16_t quantised(float x, double low, double size) {
  constexpr double kMax = 65535.0;
  if (size == 0.0) return 0;
  return static_cast<std::uint16_t>(std::lround(std::min(kMax, kMax * (static_cast<double>(x) - low) / size)));
}

}  // namespace

ViewPage::ViewPage(std::string title, std::vector<std::string> facts, Interpolation interpolation,
                   std::vector<ViewMaterial> materials)
    : title_(std::move(title)), facts_(std::move(facts)), interpolation_(interpolation), known_(std::move(materials)) {}

void ViewPage::useMaterial(const std::string& name) {
  for (const ViewMaterial& known : known_) {
    if (known.name != name) continue;
    materials_[name] = {{"colour", known.colour}, {"shine", known.shine}, {"opacity", known.opacity}};
  }
}

void ViewPage::useMaterials(const TriangleMesh& mesh) {
  for (const TriangleGroup& group : mesh.groups) useMaterial(group.material);
}

std::size_t ViewPage::addModel(const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding) {
  Json& json = models_.emplace_back(trianglesOf(mesh));
  json["cage"] = skinOf(cage, mesh, embedding);
  useMaterials(mesh);
  return models_.size() - 1;
}

std::size_t ViewPage::addSurface(const TriangleMesh& mesh) {
  models_.push_back(trianglesOf(mesh));
  useMaterials(mesh);
  return models_.size() - 1;
}

void ViewPage::addBody(const ViewBody& body) {
  assert(body.model < models_.size() && frames_.size() == 0);
  bodies_.push_back(body);
  useMaterial(body.material);
}

void ViewPage::addProp(const TriangleMesh& mesh) {
  assert(frames_.size() == 0);
  props_.push_back(mesh);
  useMaterials(mesh);
}

Box3 ViewPage::focus() const {
  if (!focus_.isEmpty()) return Box3(focus_.min() - frames_.origin(), focus_.max() - frames_.origin());
  Box3 box;
  for (std::size_t k = 0; k < frames_.size(); ++k) box.extend(frames_.box(k));
  return box;
}

Json ViewPage::bodyData(std::size_t body) const {
  Box3 box;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const std::vector<float>& nodes = frames_.nodes(k, body);
    box.extend(boundingBox(PointView<const float>(nodes.data(), nodes.size() / 3)));
  }
  std::vector<std::uint16_t> words;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const std::vector<float>& nodes = frames_.nodes(k, body);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto axis = static_cast<Eigen::Index>(i % 3);
      words.push_back(quantised(nodes[i], box.min()[axis], box.sizes()[axis]));
    }
  }
  const ViewBody& solved = bodies_[body];
  return {{"model", solved.model},       {"label", solved.label}, {"skin", solved.skin},
          {"material", solved.material}, {"box", toJson(box)},    {"nodes", packed(words)}};
}

Json ViewPage::propData(std::size_t prop) const {
  std::vector<float> numbers;  // for each moment: the columns of a matrix, without its last row
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const Eigen::Matrix4f& matrix = frames_.prop(k, prop);
    for (Eigen::Index c = 0; c < 4; ++c) {
      for (Eigen::Index r = 0; r < 3; ++r) numbers.push_back(matrix(r, c));
    }
  }
  Json json = rigidMeshOf(props_[prop], Eigen::Vector3d::Zero());
  json["places"] = packed(numbers);
  return json;
}

Json ViewPage::data() const {
  assert(frames_.size() > 0 && frames_.bodyCount() == bodies_.size() && frames_.propCount() == props_.size());
  Json json;
  json["title"] = title_;
  json["facts"] = facts_;
  json["skin"] = interpolation_ == Interpolation::Linear ? "linear" : "quadratic";
  json["moments"] = frames_.size();
  json["stride"] = frames_.stride();
  json["rate"] = rate_;
  json["origin"] = toJson(frames_.origin());
  json["focus"] = toJson(focus());
  json["materials"] = materials_;
  json["models"] = models_;
  json["bodies"] = Json::array();
  for (std::size_t k = 0; k < bodies_.size(); ++k) json["bodies"].push_back(bodyData(k));
  json["props"] = Json::array();
  for (std::size_t k = 0; k < props_.size(); ++k) json["props"].push_back(propData(k));
  if (!obstacles_.positions.empty()) json["obstacles"] = rigidMeshOf(obstacles_, frames_.origin());
  return json;
}

void ViewPage::setObstacles(const TriangleMesh& mesh) {
  obstacles_ = mesh;
  useMaterials(mesh);
}

std::string ViewPage::html(const ViewFiles& files) const {
  const std::string& folder = files.folder;
  // File names of models may consist of any bytes, and may look like any tag.
  const std::string text = data().dump(-1, ' ', false, Json::error_handler_t::replace);
  return filled(partOf(folder + "/view.html"), {{"@STYLE@", partOf(folder + "/view.css")},
                                                {"@DATA@", replaced(text, "<", "\\u003c")},
                                                {"@NOTICE@", partOf(folder + "/three_notice.txt")},
                                                {"@THREE@", escaped(partOf(files.three))},
                                                {"@CONTROLS@", escaped(partOf(files.orbitControls))},
                                                {"@SCRIPTS@", escaped(scripts(folder))}});
}

std::string withCommas(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

}  // namespace tetskin::view
