// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/shared_options.h"

#include <algorithm>

namespace tetskin::scenes {

const std::vector<SharedOption>& sharedOptions() {
  static const std::vector<SharedOption> options = {
      {"--mesh", "Model", "Render mesh, as OBJ, PLY, STL, OFF, glTF, or in any format that assimp reads"},
      {"--model", "Model", "Built-in model"},
      {"--triangles", "Model", "Triangles of a built-in model"},
      {"--cage", "Model", "Tet mesh to use as the cage: .vtk, or .ele with .node"},
      {"--deformed", "Model", "The same tet mesh, deformed, with its nodes in the same order"},
      {"--tets", "Model", "Approximate number of tets of a built cage"},
      {"--no-duplicate-elements", "Model",
       "Do not duplicate cage elements where components of the mesh are less than a tet apart; such components fuse"},
      {"--no-fit", "Model", "Do not fit the cage's boundary to the surface; all tets keep one shape"},
      {"--calibrate", "Model", "Scale the cage's stiffness to match the mesh; coarse tets are too stiff"},
      {"--bodies", "Model", "Number of bodies"},
      {"--elasticity", "Simulation", "Elastic model and solver: tetskin's or Bullet's"},
      {"--body", "Simulation",
       "Elastic body, simulated with the cage's tets, or reduced body, with vibration modes of fine tets in Bullet's "
       "reduced solver and contact at the cage's nodes"},
      {"--modes", "Simulation", "Vibration modes of a reduced body"},
      {"--fine-tets", "Simulation", "Tets from which the vibration modes of a reduced body are computed"},
      {"--contact", "Simulation", "What touches rigid bodies: the rendered surface, or the cage's nodes as in Bullet"},
      {"--self-contact", "Simulation",
       "Self-contact at the rendered surface; auto: with --contact surface, if the mesh is closed"},
      {"--frames", "Simulation", "Frames to simulate, of 1/60 s each"},
      {"--seconds", "Simulation", "Simulated time, in seconds"},
      {"--only", "Simulation", "Run only scenes with this text in their names"},
      {"--quick", "Simulation", "Run a small selection"},
      {"--interpolation", "Surface", "Interpolation of the surface between the cage's nodes"},
      {"--normals", "Surface", "How normals of the deformed surface are computed"},
      {"--outside", "Surface", "Which tet a vertex outside the cage is bound to"},
      {"--max-distance", "Surface",
       "Refuse a mesh with a vertex farther than this outside the cage, in the mesh's unit"},
      {"--output", "Output", "File to write"},
      {"--out", "Output", "Folder to write to"},
      {"--format", "Output",
       "Formats, separated by commas: obj, a file per frame; glb, a skinned mesh that moves, in one file; pc2, a point "
       "cache and its mesh"},
      {"--every", "Output", "Write every Nth frame as OBJ and PC2; GLB and the page have all"},
      {"--view", "Output", "Write an HTML page that plays the run in a browser"},
      {"--no-view", "Output", "Do not write the HTML page"},
      {"--write-cage", "Output", "Write the deformed cage of each frame, in files cage_0000.vtk and so on"},
      {"--dump-embedding", "Output", "Write the tet and the barycentric weights of every vertex to this CSV file"},
      {"--json", "Output", "Write the results to this JSON file"},
      {"--hash", "Output", "Print a hash of the node positions in all frames; identical runs print the same one"},
      {"--check-determinism", "Output",
       "Make each step twice, from a snapshot, and compare every bit; takes twice the time"},
      {"--record", "Output", "Write the run to this file, which tetskin_replay plays again"},
      {"--replay", "Output", "Play the run of this file, compare every step, and stop where one differs"},
      {"--quiet", "Output", "Print errors only"}};
  return options;
}

const SharedOption* sharedOption(const std::string& names) {
  const std::string name = names.substr(names.rfind(',') + 1);
  const auto& all = sharedOptions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SharedOption& o) { return o.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace tetskin::scenes
