// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstdint>

namespace tetskin {

/// Reads a view of float or double points as double: code that is not a template can use the caller's array in place,
/// without a copy in double. It does not own its memory.
class PointReader {
 public:
  PointReader(PointView<const double> points)  // NOLINT: implicit by design
      : data_(reinterpret_cast<const unsigned char*>(points.data())),
        count_(points.size()),
        stride_(points.strideBytes()) {}
  PointReader(PointView<const float> points)  // NOLINT: implicit by design
      : data_(reinterpret_cast<const unsigned char*>(points.data())),
        count_(points.size()),
        stride_(points.strideBytes()),
        isFloat_(true) {}

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  Eigen::Vector3d operator[](std::size_t i) const {
    assert(i < count_);
    const unsigned char* p = data_ + i * stride_;
    return isFloat_ ? read<float>(p) : read<double>(p);
  }

 private:
  template <class Scalar>
  static Eigen::Vector3d read(const unsigned char* p) {
    const Scalar* s = reinterpret_cast<const Scalar*>(p);
    return {s[0], s[1], s[2]};
  }

  const unsigned char* data_;
  std::size_t count_;
  std::size_t stride_;
  bool isFloat_ = false;
};

}  // namespace tetskin
