// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rest mesh + rest cage + deformed cage -> deformed mesh: the skin without Bullet, for cages from any simulator.
#include <tetskin/io/files.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;

struct DeformCommand {
  ModelOptions model;
  SkinOptions skin;
  std::string deformed;
  std::string output;
  std::string embedding;
  std::string json;
  bool quiet = false;
};

/// The nodes of every tet in ascending order, with the tets in ascending order as well: independent of their order and
/// orientation.
std::vector<Tet> sortedTets(const TetMesh& mesh) {
  std::vector<Tet> tets = mesh.tets;
  for (Tet& tet : tets) std::sort(tet.begin(), tet.end());
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// Equal counts do not make it the same cage: in a cage with duplicate tets, a different order of nodes would carry
/// vertices with the wrong duplicate, and nothing would show it.
void requireSameTets(const DeformCommand& command, const TetMesh& deformed, const TetMesh& rest) {
  const std::vector<Tet> now = sortedTets(deformed), then = sortedTets(rest);
  const auto [other, wanted] = std::mismatch(now.begin(), now.end(), then.begin(), then.end());
  if (other == now.end()) return;
  const bool extra = *other < *wanted;
  const Tet& tet = extra ? *other : *wanted;
  throw InputError(command.deformed + ": has " + (extra ? "a" : "no") + " tet of nodes " + std::to_string(tet[0]) +
                   ", " + std::to_string(tet[1]) + ", " + std::to_string(tet[2]) + " and " + std::to_string(tet[3]) +
                   ", but the rest cage " + command.model.cage + " has " + (extra ? "none" : "one") +
                   "; export both from one simulation, with its nodes in the same order");
}

/// The nodes of the deformed cage. Its tets only show whether it is the same cage: their order and orientation may
/// differ, as simulators change them.
TetMesh loadDeformed(const DeformCommand& command, const TetMesh& rest) {
  Result<TetMesh> deformed = loadTetMesh(command.deformed);
  require(deformed.status());
  const auto demand = [&](std::size_t count, std::size_t wanted, const char* what) {
    if (count == wanted) return;
    throw InputError(command.deformed + ": has " + std::to_string(count) + " " + what + ", but the rest cage " +
                     command.model.cage + " has " + std::to_string(wanted) +
                     "; export both from one simulation, with its nodes in the same order");
  };
  demand(deformed.value().nodeCount(), rest.nodeCount(), "nodes");
  demand(deformed.value().tetCount(), rest.tetCount(), "tets");
  requireSameTets(command, deformed.value(), rest);
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

nlohmann::ordered_json summarise(const Model& model, const DeformCommand& command, const EmbedReport& fit,
                                 const QuadraticReport& quadratic, double updateUs) {
  nlohmann::ordered_json json = summaryOf(model, fit);
  if (command.skin.interpolation == Interpolation::Quadratic) {
    json["thin_nodes"] = quadratic.underdeterminedNodes;
    json["plain_nodes"] = quadratic.averagedNodes;
  }
  json["update_us"] = updateUs;
  json["out"] = command.output;
  return json;
}

int run(const DeformCommand& command) {
  Model model;
  static_cast<Surface&>(model) = loadSurface(command.model);
  Result<ObjLayout> layout = objLayoutFor(command.model.mesh, model.mesh);
  require(layout.status());
  model.cage = loadCage(command.model.cage, model);
  const TetMesh deformed = loadDeformed(command, model.cage.mesh);

  EmbedReport fit;
  auto made = SkinBinding<double>::create(model.cage, model.mesh, command.skin, &fit);
  requireFit(made.status(), fit, command.model);
  const SkinBinding<double>::Pointer binding = std::move(made).value();
  MeshSkin<double> skin;
  const WallTimer timer;
  const Status bound = skin.bind(binding, viewOf(deformed.nodes));
  const double updateUs = timer.microseconds();
  if (!bound.ok()) throw InputError(command.deformed + ": " + bound.message);

  writeSurface(skin, layoutWith(command.skin.normals, layout.value()), command.output);
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
         "the deformed mesh with its normals"}},
       ""});
  line.addInput("--mesh", command.model.mesh, "at rest", kRequired);
  line.addInput("--cage", command.model.cage, "at rest", kRequired);
  line.addInput("--deformed", command.deformed, "", kRequired);
  line.addOutput("-o,--output", command.output, "the deformed mesh, .obj", kRequired, {".obj"});
  line.addInterpolationOption(command.skin);
  line.addSkinOptions(command.skin);
  line.addOutput("--dump-embedding", command.embedding);
  line.addSummaryOption(command.json);
  line.addQuietOption(command.quiet);
  return line.run(argc, argv, [&] { return run(command); });
}
