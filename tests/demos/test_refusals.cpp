// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Refusals of the programs: in one line that names the reason, and before they write a file.
#include <tetskin/io/files.h>

#include <set>

#include "drop_run.h"
#include "report/cage_kind.h"
#include "report/solver.h"
#include "scenes/table.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Words = std::vector<std::string>;

template <class Things, class Name>
Words namesOf(const Things& things, const Name& name) {
  Words names;
  for (const auto& thing : things) names.emplace_back(name(thing));
  return names;
}

void writeInputs(const CommandFolder& folder) {
  const std::string cube = cubeVtk();
  folder.write("box.obj", boxObj());
  folder.write("large.obj", boxObj(400.0));
  folder.write("nan.obj", boxObj(0.4, "nan"));
  folder.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n");
  folder.write("horn.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.6 0\nf 1 2 3\n");
  folder.write("cube.vtk", cube);
  folder.write("cut.vtk", cube.substr(0, cube.find("4 0 6 4")));
  TetMesh other = loadTetMesh(folder.path("cube.vtk")).value();
  other.nodes.emplace_back(5, 5, 5);
  ASSERT_TRUE(saveTetMesh(other, folder.path("more.vtk")).ok());
  other.nodes.pop_back();
  other.tets.pop_back();
  ASSERT_TRUE(saveTetMesh(other, folder.path("fewer.vtk")).ok());
  folder.write("file", "in the way");
  ASSERT_EQ(folder.run(TETSKIN_CAGE, words("--model bar --triangles 4000 --tets 1500 --quiet -o bar.vtk")).status, 0);
}

/// Arguments, and what the line has to contain.
struct Refusal {
  std::string arguments;
  Words words;
};
/// Arguments that come first in all rows of a program; if an option is given twice, the last counts.
struct Refused {
  std::string program, first;
  std::vector<Refusal> rows;
};

const std::vector<Refused>& refusals() {
  static const std::vector<Refused> all = {
      {TETSKIN_DROP,
       "",
       {{"--body reduced --contact surface", {"--contact surface"}},
        {"--elasticity bullet --contact surface", {"--contact surface"}},
        {"--elasticity bullet --self-contact on", {"--self-contact on"}},
        {"--body reduced --self-contact on", {"--self-contact on: a reduced body"}},
        {"--mesh sheet.obj --tets 60 --self-contact on", {"--self-contact on: sheet.obj: "}},
        {"--self-contact perhaps", {"--self-contact"}},
        {"--mesh nowhere.obj", {"nowhere.obj"}},
        {"--mesh nan.obj", {"nan.obj:3", "not finite"}},
        {"--mesh box.obj --cage nowhere.vtk", {"nowhere.vtk"}},
        {"--mesh box.obj --cage cut.vtk", {"cut.vtk:18", "complete"}},
        {"--mesh large.obj --cage cube.vtk", {"large.obj", "cube.vtk", "units"}},
        {"--mesh box.obj --tets 60 --frames 2 --out file/o", {"file/o"}},
        {"--modes 5", {"--modes needs --body reduced"}},
        {"--fine-tets 5000", {"--fine-tets needs --body reduced"}},
        {"--tets 10 --cage c.vtk", {"excludes --"}},
        {"--mesh m.obj --triangles 3000", {"excludes --"}},
        {"--mesh m.obj --model hand", {"excludes --"}},
        {"--format fbx", {"'fbx' is not one of obj|glb|pc2"}},
        {"--view no/where/view.html", {"no/where/view.html"}},
        {"--view a.html --no-view", {"--no-view"}}}},
      {TETSKIN_PILE,
       "",
       {{"--scene pond", {"--scene"}},
        {"--scene pit --mesh box.obj", {"takes no --mesh"}},
        {"--scene bin --mesh box.obj", {"takes no --mesh"}},
        {"--scene pit --triangles 3000", {"takes no --triangles"}},
        {"--scene bin --triangles 3000", {"takes no --triangles"}},
        {"--scene pit --calibrate", {"takes no --calibrate"}},
        {"--scene bin --calibrate", {"takes no --calibrate"}},
        {"--bodies 101", {"--scene column: --bodies 101 is more than 100"}},
        {"--scene heap --bodies 101", {"--scene heap: --bodies 101 is more than 100"}},
        {"--scene bin --bodies 1001", {"from 1 to 1000"}}}},
      {TETSKIN_MEASURE,
       "",
       {{"--only flying", {"flying"}},
        {"--group stress --elasticity tetskin --only mesh/", {"mesh/"}},
        {"--elasticity bullet --contact surface", {"--contact surface"}},
        {"--frames 3", {"--frames"}}}},
      {TETSKIN_REPLAY, "", {{"file", {"file"}}, {"missing.replay", {"missing.replay"}}}},
      {TETSKIN_CAGE,
       "",
       {{"--mesh nowhere.obj -o c.vtk", {"nowhere.obj"}},
        {"--mesh nan.obj -o c.vtk", {"nan.obj:3"}},
        {"--mesh point.obj -o c.vtk", {"point.obj"}},
        {"--mesh sheet.obj -o c.xyz", {"c.xyz"}},
        {"--mesh sheet.obj -o no/such/c.vtk", {"no/such/c.vtk"}},
        {"--mesh sheet.obj", {"--output"}},
        {"--filled nowhere.vtk -o c.vtk", {"nowhere.vtk"}},
        {"--filled cube.vtk --tets 100 -o c.vtk", {"takes no --tets"}},
        {"--mesh sheet.obj --quadratic -o c.vtk", {"--filled"}}}},
      {TETSKIN_DEFORM,
       "--mesh box.obj --cage cube.vtk -o o.obj ",
       {{"", {"--deformed"}},
        {"--deformed nowhere.vtk", {"nowhere.vtk"}},
        {"--deformed cut.vtk", {"cut.vtk"}},
        {"--deformed more.vtk", {"more.vtk", "9 nodes", "cube.vtk has 8", "same order"}},
        {"--deformed fewer.vtk", {"fewer.vtk", "5 tets", "has 6"}}}},
      {TETSKIN_DEFORM,
       "--mesh box.obj --cage cube.vtk --deformed cube.vtk -o o.obj ",
       {{"--mesh nowhere.obj", {"nowhere.obj"}},
        {"--mesh nan.obj", {"nan.obj:3"}},
        {"--mesh large.obj", {"large.obj", "cube.vtk", "units"}},
        {"--mesh horn.obj --max-distance 0.05", {"horn.obj", "vertex 2"}},
        {"--cage nowhere.vtk", {"nowhere.vtk"}},
        {"--cage cut.vtk", {"cut.vtk"}},
        {"-o o.ply", {"o.ply", ".obj"}},
        {"-o no/such/o.obj", {"no/such/o.obj"}}}},
      {TETSKIN_ERROR_VS_TIME,
       "",
       {{"--mesh nowhere.obj", {"nowhere.obj"}},
        {"--scenes fly", namesOf(scenes::sceneTable(), [](const auto& entry) { return entry.name; })},
        {"--tets 0", {"--tets"}},
        {"--tets 3000 --reference-tets 3000", {"reference"}},
        {"--substeps 0", {"--substeps"}},
        {"--substeps 4,128", {"no more substeps than the reference, which has 64"}},
        {"--target-error -1", {"--target-error"}},
        {"--full --quick", {"--full"}},
        {"--cages same,solid", namesOf(report::kCageKinds, [](const auto& kind) { return nameOf(kind); })},
        {"--cages calibrated --no-calibration", {"--no-calibration"}},
        {"--quick --out file", {"file"}},
        {"--reference nowhere.vtk", {"nowhere.vtk"}},
        {"--reference cut.vtk", {"cut.vtk"}},
        {"--reference bar.vtk --reference-tets 9000", {"--reference-tets"}},
        {"--reference bar.vtk --full", {"--full"}},
        {"--model bar --reference bar.vtk --tets 3000", {"fewer tets"}},
        {"--triangles 4000 --reference bar.vtk --tets 300", {"bar.vtk"}},
        {"--solvers havok", namesOf(report::kSolvers, [](const auto& solver) { return nameOf(solver); })},
        {"--solvers xpbd --scenes drop", {"no contact"}},
        {"--solvers xpbd --cages same", {"--cages"}},
        {"--solvers xpbd --view v.html", {"--view"}},
        {"--solvers xpbd --xpbd-substeps 0", {"--xpbd-substeps"}},
        {"--xpbd-substeps 4", {"--solvers"}},
        {"--repetitions 4", {"--solvers"}}}}};
  return all;
}

/// The files in the folder, without those that hold what a program says.
std::set<std::string> filesIn(const CommandFolder& folder) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path(""))) {
    const std::string name = entry.path().filename().string();
    if (name.front() != '.') files.insert(name);
  }
  return files;
}

TEST(Refusals, NameWhatIsWrongAndWriteNoFiles) {
  const CommandFolder folder;
  ASSERT_NO_FATAL_FAILURE(writeInputs(folder));
  const std::set<std::string> before = filesIn(folder);
  for (const Refused& refused : refusals()) {
    for (const Refusal& row : refused.rows) {
      SCOPED_TRACE(refused.program + " " + row.arguments);
      const CommandResult result = folder.run(refused.program, words(refused.first + row.arguments));
      for (const std::string& word : row.words) expectRefused(result, word);
      ASSERT_EQ(filesIn(folder), before);
    }
  }
}

}  // namespace
}  // namespace tetskin::test
