// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/frame_writer.h"

#include "scenes/input_error.h"

namespace tetskin::scenes {

bool fitsFloat(const Box3& box) {
  constexpr double kFarOut = 100.0;  ///< sizes from the origin
  return box.center().norm() <= kFarOut * box.sizes().maxCoeff();
}

FrameWriter::FrameWriter(const std::string& folder, const ObjLayout& layout) {
  Result<ObjSequenceWriter> writer = ObjSequenceWriter::create(folder, layout);
  require(writer.status());
  writer_ = std::move(writer).value();
}

void FrameWriter::write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds,
                        PointView<const float> normals) {
  if (!fitsFloat(bounds)) return require(writer_.write(frame, viewOf(surface), normals));
  rounded_.resize(surface.size());
  for (std::size_t v = 0; v < surface.size(); ++v) rounded_[v] = surface[v].cast<float>();
  require(writer_.write(frame, viewOf(std::as_const(rounded_)), normals));
}

}  // namespace tetskin::scenes
