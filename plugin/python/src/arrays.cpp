// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "arrays.h"

#include <cmath>
#include <cstring>
#include <functional>

namespace tetskin::python {
namespace {

/// The one letter of a native number's format; 0 for others.
char letterOf(const char* format) {
  if (!format) return 'B';
  if (*format == '=' || *format == '@' || *format == '<') ++format;
  return std::strlen(format) == 1 ? *format : '\0';
}

template <class From, class To>
To read(const char* at) {
  From number;
  std::memcpy(&number, at, sizeof number);
  return static_cast<To>(number);
}

/// How a number of this format is read as one of the wanted kind; null if it must not be.
template <class To>
To (*readerOf(char letter, Py_ssize_t size))(const char*) {
  if constexpr (std::is_floating_point_v<To>) {
    if (letter == 'd') return read<double, To>;
    if (letter == 'f') return read<float, To>;
  } else {
    if (std::strchr("bhilq", letter) && letter) {
      return size == 8   ? read<std::int64_t, To>
             : size == 4 ? read<std::int32_t, To>
             : size == 2 ? read<std::int16_t, To>
                         : read<std::int8_t, To>;
    }
    if (std::strchr("BHILQ", letter) && letter) {
      return size == 8   ? read<std::uint64_t, To>
             : size == 4 ? read<std::uint32_t, To>
             : size == 2 ? read<std::uint16_t, To>
                         : read<std::uint8_t, To>;
    }
  }
  return nullptr;
}

std::string shapeOf(const Py_buffer& buffer) {
  std::string text = "(";
  for (int k = 0; k < buffer.ndim; ++k) text += (k ? ", " : "") + std::to_string(buffer.shape[k]);
  return text + (buffer.ndim == 1 ? ",)" : ")");
}

/// Lists and the like become arrays of NumPy; in these, a number without a point is a real one where such are wanted.
nb::object asArray(const nb::object& object, bool real = false) {
  if (PyObject_CheckBuffer(object.ptr())) return object;
  const nb::object array = nb::module_::import_("numpy").attr("asarray")(object);
  const bool whole = nb::cast<std::string>(array.attr("dtype").attr("kind")) == "i";
  return real && whole ? array.attr("astype")("float64") : array;
}

void getBuffer(const nb::object& array, Py_buffer& buffer, const char* name) {
  if (PyObject_GetBuffer(array.ptr(), &buffer, PyBUF_RECORDS_RO) == 0) return;
  PyErr_Clear();
  throw nb::type_error((std::string(name) + ": not an array of numbers").c_str());
}

}  // namespace

template <class Number>
Numbers<Number>::Numbers(const ArrayLike& array, const char* name, int columns) {
  const bool real = std::is_floating_point_v<Number>;
  getBuffer(asArray(array.object, real), buffer_, name);
  const auto refuse = [&](auto fault, const std::string& what) {
    PyBuffer_Release(&buffer_);
    throw fault((std::string(name) + ": " + what).c_str());
  };
  const auto make = [](const char* text) { return nb::type_error(text); };
  const auto makeValue = [](const char* text) { return nb::value_error(text); };
  const std::string wanted = columns ? "(n, " + std::to_string(columns) + ")" : "(n,)";
  if (buffer_.ndim != (columns ? 2 : 1) || (columns && buffer_.shape[1] != columns)) {
    // What is empty has no columns to be wrong about.
    if (buffer_.ndim == 1 && buffer_.shape[0] == 0) return;
    refuse(makeValue, "the shape must be " + wanted + ", not " + shapeOf(buffer_));
  }
  const auto reader = readerOf<Number>(letterOf(buffer_.format), buffer_.itemsize);
  if (!reader) {
    refuse(make, std::string("the numbers must be ") + (real ? "float32 or float64" : "integers") +
                     ", not of the format '" + (buffer_.format ? buffer_.format : "B") + "'");
  }
  rows_ = static_cast<std::size_t>(buffer_.shape[0]);
  const Py_ssize_t row = buffer_.strides[0], column = columns ? buffer_.strides[1] : 0;
  const auto width = static_cast<Py_ssize_t>(columns ? columns : 1), item = buffer_.itemsize;
  const bool same = item == sizeof(Number) && letterOf(buffer_.format) == (real ? 'd' : letterOf(buffer_.format)) &&
                    (real || std::strchr("ilq", letterOf(buffer_.format)));
  const bool tight = row == width * item && (!columns || column == item);
  const bool aligned = reinterpret_cast<std::uintptr_t>(buffer_.buf) % alignof(Number) == 0;
  if (same && tight && aligned) {
    data_ = static_cast<const Number*>(buffer_.buf);
    return;
  }
  copy_.reserve(rows_ * static_cast<std::size_t>(width));
  for (std::size_t i = 0; i < rows_; ++i) {
    const char* at = static_cast<const char*>(buffer_.buf) + static_cast<Py_ssize_t>(i) * row;
    for (Py_ssize_t k = 0; k < width; ++k) copy_.push_back(reader(at + k * column));
  }
  data_ = copy_.data();
}

template <class Number>
Numbers<Number>::~Numbers() {
  PyBuffer_Release(&buffer_);
}

template class Numbers<double>;
template class Numbers<std::int64_t>;

std::vector<Eigen::Vector3d> pointsOf(const ArrayLike& array, const char* name) {
  const Numbers<double> numbers(array, name, 3);
  std::vector<Eigen::Vector3d> points(numbers.rows());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Eigen::Map<const Eigen::Vector3d>(numbers.data() + 3 * i);
  return points;
}

std::vector<int> indicesOf(const ArrayLike& array, const char* name, std::size_t count) {
  const ArrayLike made{asArray(array.object)};
  Py_buffer buffer{};
  getBuffer(made.object, buffer, name);
  const bool mask = letterOf(buffer.format) == '?' && buffer.ndim == 1;
  std::vector<int> indices;
  if (mask) {
    const bool fits = static_cast<std::size_t>(buffer.shape[0]) == count;
    for (std::size_t i = 0; fits && i < count; ++i) {
      if (static_cast<const char*>(buffer.buf)[static_cast<Py_ssize_t>(i) * buffer.strides[0]])
        indices.push_back(static_cast<int>(i));
    }
    PyBuffer_Release(&buffer);
    if (!fits)
      throw nb::value_error(
          (std::string(name) + ": a mask must have a value for each of " + std::to_string(count)).c_str());
    return indices;
  }
  const bool empty = buffer.ndim == 1 && buffer.shape[0] == 0;
  PyBuffer_Release(&buffer);
  if (empty) return indices;
  const Numbers<std::int64_t> numbers(made, name, 0);
  for (std::size_t i = 0; i < numbers.rows(); ++i) {
    const std::int64_t index = numbers.data()[i];
    if (index < 0 || static_cast<std::size_t>(index) >= count) {
      throw nb::index_error(
          (std::string(name) + ": there is no " + std::to_string(index) + " among " + std::to_string(count)).c_str());
    }
    indices.push_back(static_cast<int>(index));
  }
  return indices;
}

Column<bool> newMask(const std::vector<char>& mask) {
  const auto owner = std::make_shared<std::vector<char>>(mask);
  return view1<bool>(reinterpret_cast<const bool*>(owner->data()), owner->size(), owner);
}

Vector3 newVector(const Vec3& vector) {
  auto* numbers = new Vec3(vector);
  return Vector3(numbers->data(), {3}, nb::capsule(numbers, [](void* p) noexcept { delete static_cast<Vec3*>(p); }));
}

Vector4 newQuaternion(const Quaternion& quaternion) {
  auto* numbers = new Quaternion(quaternion);
  return Vector4(numbers->data(), {4},
                 nb::capsule(numbers, [](void* p) noexcept { delete static_cast<Quaternion*>(p); }));
}

ProgressCall::ProgressCall(const nb::object& call, const char* what) : call_(call) {
  if (call.ptr() == Py_False) call_ = nb::none();
  if (call.ptr() == Py_True) call_ = nb::module_::import_("tetskin.progress").attr("Bar")(what);
}

std::function<bool(double)> ProgressCall::function() {
  if (call_.is_none()) return {};
  return [this](double fraction) {
    const nb::gil_scoped_acquire acquire;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      const nb::object answer = call_(fraction);
      return answer.is_none() || PyObject_IsTrue(answer.ptr()) == 1;
    } catch (...) {
      raised_ = std::current_exception();
      return false;
    }
  };
}

void ProgressCall::rethrow() {
  if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

}  // namespace tetskin::python
