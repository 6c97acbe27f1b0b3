// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Writes the built-in serpent, and the materials of all demos, for make_page.mjs, as JSON. Run once, when the page is
// built, as WebAssembly: so its bytes are the same wherever that is.
#include "scenes/serpent.h"

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "scenes/materials.h"

namespace {

using namespace tetskin;

void printMaterials() {
  std::printf("\"materials\":{");
  const char* comma = "";
  for (const view::ViewMaterial& m : scenes::viewMaterials()) {
    std::printf("%s\"%s\":{\"colour\":[%g,%g,%g],\"shine\":%g,\"opacity\":%g}", comma, m.name.c_str(), m.colour[0],
                m.colour[1], m.colour[2], m.shine, m.opacity);
    comma = ",";
  }
  std::printf("}");
}

void printGroups(const TriangleMesh& mesh) {
  std::printf("\"groups\":[");
  const char* comma = "";
  for (const TriangleGroup& group : mesh.groups) {
    std::printf("%s{\"first\":%zu,\"count\":%zu,\"material\":\"%s\"}", comma, group.firstTriangle, group.triangleCount,
                group.material.c_str());
    comma = ",";
  }
  std::printf("]");
}

template <class Point, class Print>
void printAll(const char* name, const std::vector<Point>& points, Print&& print) {
  std::printf("\"%s\":[", name);
  const char* comma = "";
  for (const Point& point : points) {
    for (int k = 0; k < 3; ++k, comma = ",") {
      std::printf("%s", comma);
      print(point[k]);
    }
  }
  std::printf("]");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: serpent TRIANGLES\n", stderr), 2;
  const TriangleMesh mesh = scenes::makeSerpent({static_cast<std::size_t>(std::atol(argv[1]))});
  std::printf("{");
  printGroups(mesh);
  std::printf(",");
  printMaterials();
  std::printf(",");
  printAll("positions", mesh.positions, [](double x) { std::printf("%.7g", x); });
  std::printf(",");
  printAll("triangles", mesh.triangles, [](int v) { std::printf("%d", v); });
  std::printf("}\n");
  return 0;
}
