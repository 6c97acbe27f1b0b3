// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Boxes drawn beside a soft surface, in the frames of one mesh.
#pragma once

#include <btBulletDynamicsCommon.h>
#include <tetskin/io/obj_sequence.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tetskin::materials {

/// A surface and some boxes as one mesh, whose frames it writes.
class SeenBoxes {
 public:
  SeenBoxes(const std::string& folder, TriangleMesh surface,
            std::vector<std::pair<const btRigidBody*, btVector3>> boxes)
      : boxes_(std::move(boxes)) {
    constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (std::size_t box = 0; box < boxes_.size(); ++box) {
      const int first = static_cast<int>(surface.vertexCount());
      for (int corner = 0; corner < 8; ++corner) surface.positions.emplace_back(0, 0, 0);
      for (const auto& s : kSides) {
        surface.triangles.push_back({first + s[0], first + s[1], first + s[2]});
        surface.triangles.push_back({first + s[0], first + s[2], first + s[3]});
      }
    }
    files_ = ObjSequenceWriter::create(folder, ObjLayout::create(surface)).value();
  }

  /// Writes a frame, and returns its path.
  std::string write(int frame, std::vector<float> points) {
    for (const auto& [body, half] : boxes_) {
      for (int corner = 0; corner < 8; ++corner) {
        const btVector3 own((corner & 1 ? 1 : -1) * half.x(), (corner & 2 ? 1 : -1) * half.y(),
                            (corner & 4 ? 1 : -1) * half.z());
        const btVector3 at = body->getWorldTransform() * own;
        for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(at[k]));
      }
    }
    const Status written = files_.write(frame, PointView<const float>(points.data(), points.size() / 3));
    if (!written.ok()) throw std::runtime_error(written.message);
    return files_.framePath(frame);
  }

 private:
  std::vector<std::pair<const btRigidBody*, btVector3>> boxes_;  ///< and half their sides
  ObjSequenceWriter files_;
};

}  // namespace tetskin::materials
