// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rest mesh + rest cage + deformed cage -> deformed mesh: the skin without Bullet, for cages from any simulator; and a
// sequence of deformed cages -> an animation.
#include <tetskin/core/cage.h>
#include <tetskin/io/animation.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/materials.h"
#include "scenes/scene.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct DeformCommand {
  ModelOptions model;
  SkinOptions skin;
  std::vector<std::string> deformed;  ///< at least one
  double frameRate = kFrameRate;
  std::string output;
  std::string embedding;
  std::string json;
  bool quiet = false;
};

/// By node: whether it is at the middle of an edge of a quadratic tet.
std::vector<bool> midpointsOf(const Cage& cage) {
  std::vector<bool> is(cage.mesh.nodeCount(), false);
  const auto tets = quadraticTets(cage);
  require(tets.status());
  for (const QuadraticTet& tet : tets.value()) {
    for (std::size_t k = 4; k < kQuadraticNodes; ++k) is[tet.nodes[k]] = true;
  }
  return is;
}

/// The nodes of every tet in ascending order, with the tets in ascending order as well: independent of their order and
/// orientation. Those between midpoints are left out: around which diagonal of its quadratic tet they are, depends on
/// the shape.
std::vector<Tet> sortedTets(const TetMesh& mesh, const std::vector<bool>& isMidpoint) {
  std::vector<Tet> tets = mesh.tets;
  const auto isInner = [&](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](int node) { return isMidpoint[node]; });
  };
  tets.erase(std::remove_if(tets.begin(), tets.end(), isInner), tets.end());
  for (Tet& tet : tets) std::sort(tet.begin(), tet.end());
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// Equal counts do not make it the same cage: in a cage with duplicate tets, a different order of nodes would carry
/// vertices with the wrong duplicate, and nothing would show it.
void requireSameTets(const DeformCommand& command, const std::string& name, const TetMesh& deformed, const Cage& rest) {
  const std::vector<bool> isMidpoint = midpointsOf(rest);
  const std::vector<Tet> now = sortedTets(deformed, isMidpoint), then = sortedTets(rest.mesh, isMidpoint);
  const auto [other, wanted] = std::mismatch(now.begin(), now.end(), then.begin(), then.end());
  if (other == now.end() && wanted == then.end()) return;
  const bool extra = wanted == then.end() || (other != now.end() && *other < *wanted);
  const Tet& tet = extra ? *other : *wanted;
  throw InputError(name + ": has " + (extra ? "a" : "no") + " tet of nodes " + std::to_string(tet[0]) + ", " +
                   std::to_string(tet[1]) + ", " + std::to_string(tet[2]) + " and " + std::to_string(tet[3]) +
                   ", but the rest cage " + command.model.cage + " has " + (extra ? "none" : "one") +
                   "; export both from one simulation, with its nodes in the same order");
}

/// The nodes of the deformed cage. Its tets only show whether it is the same cage: their order and orientation may
/// differ, as simulators change them.
TetMesh loadDeformed(const DeformCommand& command, const std::string& name, const Cage& rest) {
  Result<TetMesh> deformed = loadTetMesh(name);
  require(deformed.status());
  const auto demand = [&](std::size_t count, std::size_t wanted, const char* what) {
    if (count == wanted) return;
    throw InputError(name + ": has " + std::to_string(count) + " " + what + ", but the rest cage " +
                     command.model.cage + " has " + std::to_string(wanted) +
                     "; export both from one simulation, with its nodes in the same order");
  };
  demand(deformed.value().nodeCount(), rest.mesh.nodeCount(), "nodes");
  demand(deformed.value().tetCount(), rest.mesh.tetCount(), "tets");
  requireSameTets(command, name, deformed.value(), rest);
  return std::move(deformed).value();
}

/// Columns vertex,tet,b0,b1,b2,b3,inside: indices from 0, and weights of the nodes in the order of the cage's file, as
/// the shortest texts that read back as the same floats.
std::string embeddingText(const Embedding& embedding) {
  std::string text = "vertex,tet,b0,b1,b2,b3,inside\n";
  std::size_t vertex = 0;
  for (const VertexBinding& binding : embedding.bindings()) {
    appendNumber(text, vertex++);
    text += ',';
    appendNumber(text, binding.tet);
    for (const float weight : binding.weights) {
      text += ',';
      appendNumber(text, weight);
    }
    text += binding.inside ? ",1\n" : ",0\n";
  }
  return text;
}

void writeSurface(const MeshSkin<double>& skin, const ObjLayout& layout, const std::string& path) {
  const PointView<const double> positions = skin.positions();
  if (!fitsFloat(skin.bounds())) return require(layout.writeTo(path, positions, skin.normals()));
  std::vector<Eigen::Vector3f> rounded(positions.size());
  for (std::size_t v = 0; v < rounded.size(); ++v) {
    rounded[v] = Eigen::Map<const Eigen::Vector3d>(positions[v]).cast<float>();
  }
  require(layout.writeTo(path, viewOf(std::as_const(rounded)), skin.normals()));
}

/// The format of the output: its extension in lower case.
std::string formatOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// The outputs that the command line requests from the deformed cages, one after the other.
class Output {
 public:
  Output(const DeformCommand& command, const Model& model, const SkinBinding<double>& binding)
      : command_(command), format_(formatOf(command.output)) {
    if (format_ == ".glb") {
      auto writer = GlbWriter::create(command.output, command.frameRate);
      require(writer.status());
      glb_.emplace(std::move(writer).value());
      glb_->setMaterials(surfaceMaterials());
      const std::string name = std::filesystem::path(model.name).stem().string();
      const auto added = glb_->addModel(name, model.cage, model.mesh, binding.embedding(), command.skin.interpolation);
      require(added.status());
      glb_->addBody(added.value(), name);
    } else if (format_ == ".pc2") {
      auto writer = Pc2Writer::create(command.output, model.mesh.vertexCount());
      require(writer.status());
      pc2_.emplace(std::move(writer).value());
    }
  }

  void add(const TetMesh& deformed, const MeshSkin<double>& skin, const ObjLayout& layout) {
    if (glb_) return require(glb_->addFrame({viewOf(deformed.nodes)}));
    if (pc2_) return require(pc2_->addFrame(skin.positions()));
    writeSurface(skin, layout, command_.output);
  }
  void finish() {
    if (glb_) require(glb_->finish());
    if (pc2_) require(pc2_->finish());
  }

 private:
  const DeformCommand& command_;
  std::string format_;
  std::optional<GlbWriter> glb_;
  std::optional<Pc2Writer> pc2_;
};

void requireOneFrame(const DeformCommand& command) {
  if (command.deformed.size() == 1 || formatOf(command.output) != ".obj") return;
  throw InputError(command.output + ": an OBJ file holds one frame, and --deformed names " +
                   std::to_string(command.deformed.size()) + "; use .glb or .pc2");
}

nlohmann::ordered_json summarise(const Model& model, const DeformCommand& command, const EmbedReport& fit,
                                 const QuadraticReport& quadratic, double updateUs) {
  nlohmann::ordered_json json = summaryOf(model, fit);
  if (command.skin.interpolation == Interpolation::Quadratic) {
    json["thin_nodes"] = quadratic.underdeterminedNodes;
    json["plain_nodes"] = quadratic.averagedNodes;
  }
  json["frames"] = command.deformed.size();
  json["update_us"] = updateUs;
  json["out"] = command.output;
  return json;
}

int run(const DeformCommand& command) {
  requireOneFrame(command);
  Model model;
  static_cast<Surface&>(model) = loadSurface(command.model);
  Result<ObjLayout> layout = objLayoutFor(command.model.mesh, model.mesh);
  require(layout.status());
  model.cage = loadCage(command.model.cage, model);
  gatherLooseVertices(model, model.cage, command.quiet);
  TetMesh deformed = loadDeformed(command, command.deformed.front(), model.cage);

  EmbedReport fit;
  auto made = SkinBinding<double>::create(model.cage, model.mesh, command.skin, &fit);
  requireFit(made.status(), fit, command.model);
  const SkinBinding<double>::Pointer binding = std::move(made).value();
  MeshSkin<double> skin;
  Output output(command, model, *binding);
  const ObjLayout written = layoutWith(command.skin.normals, layout.value());
  double updateUs = 0.0;
  for (const std::string& name : command.deformed) {
    if (&name != &command.deformed.front()) deformed = loadDeformed(command, name, model.cage);
    const WallTimer timer;
    const Status bound = skin.bind(binding, viewOf(std::as_const(deformed.nodes)));
    updateUs += timer.microseconds() / static_cast<double>(command.deformed.size());
    if (!bound.ok()) throw InputError(name + ": " + bound.message);
    output.add(deformed, skin, written);
  }
  output.finish();
  if (!command.embedding.empty()) writeFile(command.embedding, embeddingText(binding->embedding()));
  if (!command.json.empty())
    writeJson(summarise(model, command, fit, binding->quadraticReport(), updateUs), command.json);
  if (command.quiet) return kDone;
  std::printf("%s", fit.describe().c_str());
  if (command.skin.interpolation == Interpolation::Quadratic) {
    std::printf("%s\n", binding->quadraticReport().describe().c_str());
  }
  std::printf("%s\n", command.output.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  DeformCommand command;
  constexpr auto kRequired = CommandLine::Need::Required;
  CommandLine line(
      "Deforms a mesh with its cage of tetrahedra, whatever program has deformed the cage.",
      {{{"tetskin_deform --mesh yours.obj --cage rest.vtk --deformed now.vtk -o now.obj",
         "the mesh, deformed as the cage is"},
        {"tetskin_deform --mesh yours.obj --cage rest.vtk --deformed now.vtk -o now.obj --normals transformed",
         "the deformed mesh with its normals"},
        {"tetskin_deform --mesh yours.obj --cage rest.vtk --deformed rest.vtk now.vtk -o all.glb",
         "the mesh moving as the cages do, one after the other; or all.pc2"}},
       ""});
  line.addInput("--mesh", command.model.mesh, "at rest", kRequired);
  line.addInput("--cage", command.model.cage, "at rest", kRequired);
  line.addInputs("--deformed", command.deformed, "several for .glb and .pc2: a frame each", kRequired);
  line.addOutput("-o,--output", command.output, "the deformed mesh: .obj, .glb or .pc2", kRequired,
                 {".obj", ".glb", ".pc2"});
  line.addPositive("--frame-rate", command.frameRate, "Frames per second of a .glb");
  line.addInterpolationOption(command.skin);
  line.addSkinOptions(command.skin);
  line.addOutput("--dump-embedding", command.embedding);
  line.addSummaryOption(command.json);
  line.addQuietOption(command.quiet);
  return line.run(argc, argv, [&] { return run(command); });
}
