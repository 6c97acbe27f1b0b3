// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "arrays.h"

#include <cstring>
#include <functional>

namespace tetskin::python {
namespace {

/// The one letter of a number's format, whatever its byte order; 0 for others.
char letterOf(const Py_buffer& buffer) {
  const char* format = buffer.format ? buffer.format : "B";
  if (*format && std::strchr("@=<>!", *format)) ++format;
  return std::strlen(format) == 1 ? *format : '\0';
}

/// Numbers that convert to these without loss, except rounding of those with more than 53 bits.
template <class Number>
bool isTaken(const Py_buffer& buffer) {
  const char letter = letterOf(buffer);
  return letter && std::strchr(std::is_floating_point_v<Number> ? "bhilqBHILQefd" : "bhilqBHILQ", letter);
}

/// Whether the buffer holds these numbers themselves, contiguously.
template <class Number>
bool areThese(const Py_buffer& buffer) {
  const char letter = letterOf(buffer);
  const bool ordered = buffer.format && *buffer.format && std::strchr("<>!", *buffer.format);
  const bool same = std::is_floating_point_v<Number> ? letter == 'd' : letter && std::strchr("ilq", letter);
  return same && !ordered && buffer.itemsize == sizeof(Number) && PyBuffer_IsContiguous(&buffer, 'C') &&
         reinterpret_cast<std::uintptr_t>(buffer.buf) % alignof(Number) == 0;
}

std::string shapeOf(const Py_buffer& buffer) {
  std::string text = "(";
  for (int k = 0; k < buffer.ndim; ++k) text += (k ? ", " : "") + std::to_string(buffer.shape[k]);
  return text + (buffer.ndim == 1 ? ",)" : ")");
}

nb::object numpy(const char* function) {
  return nb::module_::import_("numpy").attr(function);
}

/// Lists and the like become arrays of NumPy.
nb::object asArray(const nb::object& object) {
  return PyObject_CheckBuffer(object.ptr()) ? object : numpy("asarray")(object);
}

void getBuffer(const nb::object& array, Py_buffer& buffer, const char* name) {
  if (PyObject_GetBuffer(array.ptr(), &buffer, PyBUF_RECORDS_RO) == 0) return;
  PyErr_Clear();
  throw nb::type_error((std::string(name) + ": not an array of numbers").c_str());
}

}  // namespace

template <class Number>
Numbers<Number>::Numbers(const ArrayLike& array, const char* name, int columns) {
  constexpr bool kReal = std::is_floating_point_v<Number>;
  const nb::object given = asArray(array.object);
  getBuffer(given, buffer_, name);
  const auto refused = [&](const std::string& what) {
    PyBuffer_Release(&buffer_);
    return std::string(name) + ": " + what;
  };
  if (buffer_.ndim != (columns ? 2 : 1) || (columns && buffer_.shape[1] != columns)) {
    // An empty array has no wrong number of columns.
    if (buffer_.ndim == 1 && buffer_.shape[0] == 0) return;
    const std::string wanted = columns ? "(n, " + std::to_string(columns) + ")" : "(n,)";
    throw nb::value_error(refused("the shape must be " + wanted + ", not " + shapeOf(buffer_)).c_str());
  }
  if (!isTaken<Number>(buffer_)) {
    const std::string type = nb::cast<std::string>(numpy("asarray")(given).attr("dtype").attr("name"));
    const std::string wanted = kReal ? "real, of 64 bits or fewer" : "integers";
    throw nb::type_error(refused("the numbers must be " + wanted + ", not " + type).c_str());
  }
  rows_ = static_cast<std::size_t>(buffer_.shape[0]);
  if (!areThese<Number>(buffer_)) {
    // Cached, as looking them up would take longer than the call. No static constant: the look-up may release the GIL
    // while the constant's lock is held, for which others would wait with the GIL.
    static PyObject *convert = nullptr, *type = nullptr;
    if (!type) convert = numpy("ascontiguousarray").release().ptr();
    if (!type) type = numpy(kReal ? "float64" : "int64").release().ptr();
    PyBuffer_Release(&buffer_);
    getBuffer(nb::handle(convert)(given, nb::handle(type)), buffer_, name);
  }
  if (!areThese<Number>(buffer_)) {  // not aligned
    PyBuffer_Release(&buffer_);
    getBuffer(numpy("array")(given), buffer_, name);
  }
  data_ = static_cast<const Number*>(buffer_.buf);
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
  const bool mask = letterOf(buffer) == '?' && buffer.ndim == 1;
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

std::string PathLike::text() const {
  const nb::object path = nb::steal(PyOS_FSPath(object.ptr()));
  if (!path.is_valid()) throw nb::python_error();
  nb::object bytes = path;
  if (PyUnicode_Check(path.ptr())) {
#ifndef _WIN32
    bytes = nb::steal(PyUnicode_EncodeFSDefault(path.ptr()));
#else
    bytes = nb::steal(PyUnicode_AsUTF8String(path.ptr()));
#endif
    if (!bytes.is_valid()) {  // no file has such a name
      PyErr_Clear();
      bytes = nb::steal(PyUnicode_AsEncodedString(path.ptr(), "utf-8", "surrogatepass"));
      if (!bytes.is_valid()) throw nb::python_error();
    }
  }
  const std::string text(PyBytes_AsString(bytes.ptr()), static_cast<std::size_t>(PyBytes_Size(bytes.ptr())));
  if (text.find('\0') != std::string::npos) throw nb::value_error("path: no file's name has the character 0");
  return text;
}

nb::str textOf(const std::string& text) {
  PyObject* made = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace");
  if (!made) throw nb::python_error();
  return nb::steal<nb::str>(made);
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

Column<bool> newMask(const std::vector<unsigned char>& mask) {
  const auto owner = std::make_shared<std::vector<unsigned char>>(mask);
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
  return [this](double fraction) {
    const nb::gil_scoped_acquire acquire;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (call_.is_none()) return true;
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
