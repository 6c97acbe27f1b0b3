// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Arrays in and out.
#pragma once

#include <facade/models.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace tetskin::python {

namespace nb = nanobind;
using namespace nb::literals;
using namespace facade;

/// Anything that numpy.asarray takes. This type, and those below, have names in the stub from tetskin/typing.py.
struct ArrayLike {
  nb::object object;
};

/// The words of a Choice, which type checkers and editors know.
template <class Of>
constexpr auto kWords = nullptr;
template <>
constexpr auto kWords<Interpolation> = nb::detail::const_name("typing.Literal['linear', 'quadratic']");
template <>
constexpr auto kWords<Normals> = nb::detail::const_name("typing.Literal['none', 'transformed', 'recomputed']");
template <>
constexpr auto kWords<OutsideRule> = nb::detail::const_name("typing.Literal['nearest', 'barycentric']");
struct Layouts {};
template <>
constexpr auto kWords<Layouts> = nb::detail::const_name("typing.Literal['rows', 'columns']");
/// A file's name: text, bytes, or an object with __fspath__.
struct PathLike {
  nb::object object;
  /// In UTF-8, or arbitrary bytes if the system names files so.
  std::string text() const;
};
/// Text from a file or a path. Bytes that are not UTF-8 become \\x and two digits.
nb::str textOf(const std::string& text);
/// Called with the fraction done; True, which prints a bar; or None.
struct Progress {
  nb::object call;
  operator const nb::object&() const { return call; }
};

/// Numbers of an argument, contiguous in memory: those of the array itself if possible, otherwise a copy by NumPy.
/// Holds the array.
template <class Number>
class Numbers {
 public:
  /// columns  0: one dimension
  /// Throws   TypeError for another type of numbers, ValueError for another shape
  Numbers(const ArrayLike& array, const char* name, int columns);
  ~Numbers();
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  const Number* data() const { return data_; }
  std::size_t rows() const { return rows_; }

 private:
  const Number* data_ = nullptr;
  std::size_t rows_ = 0;
  Py_buffer buffer_{};
};
extern template class Numbers<double>;
extern template class Numbers<std::int64_t>;

std::vector<Eigen::Vector3d> pointsOf(const ArrayLike& array, const char* name);
/// Indices below `count` from an array of integers, or from a mask of `count` booleans.
/// Throws  TypeError, ValueError, IndexError
std::vector<int> indicesOf(const ArrayLike& array, const char* name, std::size_t count);
/// Rows of `K` indices.
template <std::size_t K>
std::vector<std::array<int, K>> indexRowsOf(const ArrayLike& array, const char* name) {
  const Numbers<std::int64_t> numbers(array, name, static_cast<int>(K));
  std::vector<std::array<int, K>> rows(numbers.rows());
  for (std::size_t i = 0; i < K * rows.size(); ++i) {
    const std::int64_t number = numbers.data()[i];
    if (number < INT32_MIN || number > INT32_MAX)
      fail(StatusCode::IndexOutOfRange, std::string(name) + ": an index is too large");
    rows[i / K][i % K] = static_cast<int>(number);
  }
  return rows;
}

/// Owns a share of something while an array lives.
template <class Owner>
nb::capsule kept(const std::shared_ptr<Owner>& owner) {
  return nb::capsule(new std::shared_ptr<Owner>(owner),
                     [](void* p) noexcept { delete static_cast<std::shared_ptr<Owner>*>(p); });
}

template <class Number>
using Row2 = nb::ndarray<nb::numpy, const Number, nb::shape<-1, 2>>;
template <class Number>
using Row3 = nb::ndarray<nb::numpy, const Number, nb::shape<-1, 3>>;
template <class Number>
using Row4 = nb::ndarray<nb::numpy, const Number, nb::shape<-1, 4>>;
template <class Number>
using Column = nb::ndarray<nb::numpy, const Number, nb::ndim<1>>;
using Vector3 = nb::ndarray<nb::numpy, double, nb::shape<3>>;
using Vector4 = nb::ndarray<nb::numpy, double, nb::shape<4>>;

/// A read-only view of rows in memory that `owner` keeps.
template <class Number, class Owner>
Row3<Number> view3(const Number* data, std::size_t rows, const std::shared_ptr<Owner>& owner,
                   std::size_t strideBytes = 3 * sizeof(Number)) {
  static const Number none[3] = {};
  const std::size_t shape[2] = {rows, 3};
  const std::int64_t strides[2] = {static_cast<std::int64_t>(strideBytes / sizeof(Number)), 1};
  return Row3<Number>(data ? data : none, 2, shape, kept(owner), strides);
}
template <class Number, class Owner>
Row3<Number> view3(PointView<const Number> points, const std::shared_ptr<Owner>& owner) {
  return view3<Number>(points.data(), points.size(), owner, points.strideBytes());
}
template <class Number, class Owner>
Column<Number> view1(const Number* data, std::size_t count, const std::shared_ptr<Owner>& owner) {
  static const Number none = {};
  const std::size_t shape[1] = {count};
  return Column<Number>(data ? data : &none, 1, shape, kept(owner));
}
/// New arrays, which Python owns.
template <class Number>
Row3<Number> newRows3(std::vector<Number>&& numbers) {
  const auto owner = std::make_shared<std::vector<Number>>(std::move(numbers));
  return view3<Number>(owner->data(), owner->size() / 3, owner);
}
template <class Number>
Column<Number> newColumn(std::vector<Number>&& numbers) {
  const auto owner = std::make_shared<std::vector<Number>>(std::move(numbers));
  return view1<Number>(owner->data(), owner->size(), owner);
}
Column<bool> newMask(const std::vector<unsigned char>& mask);
Vector3 newVector(const Vec3& vector);
Vector4 newQuaternion(const Quaternion& quaternion);
template <class V>
Vector3 vectorOf(const V& v) {
  return newVector({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
}

/// A class of nanobind whose properties may return arrays that own a share of something. By default, nanobind makes
/// everything that a property returns keep its object alive, and refuses such arrays.
template <class T>
class Class : public nb::class_<T> {
 public:
  using nb::class_<T>::class_;
  template <class... Args>
  Class& def(Args&&... args) {
    nb::class_<T>::def(std::forward<Args>(args)...);
    return *this;
  }
  template <class... Args>
  Class& def_static(Args&&... args) {
    nb::class_<T>::def_static(std::forward<Args>(args)...);
    return *this;
  }
  template <class... Args>
  Class& def_ro(Args&&... args) {
    nb::class_<T>::def_ro(std::forward<Args>(args)...);
    return *this;
  }
  template <class... Args>
  Class& def_prop_ro(Args&&... args) {
    nb::class_<T>::def_prop_ro(std::forward<Args>(args)..., nb::rv_policy::automatic);
    return *this;
  }
  template <class... Args>
  Class& def_prop_rw(Args&&... args) {
    nb::class_<T>::def_prop_rw(std::forward<Args>(args)..., nb::rv_policy::automatic);
    return *this;
  }
  /// Describes an object in a few words; Python's default shows its address.
  template <class Words>
  Class& words(Words words) {
    const std::string name = nb::cast<std::string>(this->attr("__name__"));
    return def("__repr__", [name, words](const T& self) { return "<tetskin." + name + ": " + words(self) + ">"; });
  }
  /// Pickling, also by the oldest protocols: the state is one object of bytes.
  /// ofBytes  makes an object of the bytes of `facade::writeBytes`; may throw
  template <class OfBytes>
  Class& pickled(OfBytes ofBytes) {
    def("__getstate__", [](const T& self) {
      nb::object state;
      writeBytes(self, [&](std::size_t count) {
        state = nb::steal(PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(count)));
        if (!state.is_valid()) throw nb::python_error();
        return reinterpret_cast<unsigned char*>(PyBytes_AsString(state.ptr()));
      });
      return nb::borrow<nb::bytes>(state);
    });
    const auto setState = [ofBytes](T& self, const nb::object& state) {
      nb::bytes bytes;
      if (!nb::try_cast(state, bytes))
        fail(StatusCode::Malformed, "the state is not bytes: not a pickled object of this version of tetskin");
      new (&self) T(ofBytes(static_cast<const unsigned char*>(bytes.data()), bytes.size()));
    };
    def("__setstate__", setState, nb::sig("def __setstate__(self, state: bytes, /) -> None"));
    const auto reduce = [](nb::handle self) {
      const nb::object newObject = nb::module_::import_("copyreg").attr("__newobj__");
      return nb::make_tuple(newObject, nb::make_tuple(self.type()), self.attr("__getstate__")());
    };
    return def("__reduce__", reduce, nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"));
  }
};
/// "2 tets", "1 tet".
std::string counted(std::size_t count, const char* one, const char* many);
/// "(0, 1, -2.5)"
template <class V>
std::string wordsOf(const V& v) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", static_cast<double>(v[0]), static_cast<double>(v[1]),
                static_cast<double>(v[2]));
  return text;
}

/// A ready array, whose type in the stub is `Of`'s.
template <class Of>
struct Made {
  nb::object array;
};
/// A Python array that is made once; each call gets a view of it, at a fifth of the cost of a new array. Each call gets
/// its own view, as arrays can be reshaped in place. Needs the GIL, also to be destroyed once the array exists.
template <class Of>
class Kept {
 public:
  Kept() = default;
  Kept(const Kept&) {}  // a copy makes its own
  Kept& operator=(const Kept&) { return *this; }

  template <class Make>
  Made<Of> view(Make&& make) const {
    static PyObject* const name = PyUnicode_InternFromString("view");
    if (!array_.is_valid()) array_ = nb::cast(Of(make()));
    PyObject* arguments[] = {array_.ptr()};
    PyObject* made = PyObject_VectorcallMethod(name, arguments, 1, nullptr);
    if (!made) throw nb::python_error();
    return {nb::steal(made)};
  }

 private:
  mutable nb::object array_;
};

/// The type of `bounds`, for the stub.
inline const nb::sig kBoundsType{
    "def bounds(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]"};

/// Runs without the GIL.
template <class Work>
auto released(Work&& work) {
  const nb::gil_scoped_release release;
  return work();
}

/// A Python function as `progress`: called with the fraction, it cancels by returning False or raising. True prints a
/// bar; None or False: nothing. Ctrl-C always cancels.
class ProgressCall {
 public:
  /// what  the task, printed before a bar
  ProgressCall(const nb::object& call, const char* what);
  /// The function for the library, which calls it without the GIL.
  std::function<bool(double)> function();
  /// Throws the exception that was raised.
  void rethrow();

 private:
  nb::object call_;
  std::exception_ptr raised_;
};

}  // namespace tetskin::python

namespace nanobind::detail {
template <>
struct type_caster<tetskin::python::ArrayLike> {
  NB_TYPE_CASTER(tetskin::python::ArrayLike, const_name("Array"))
  bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
    value.object = borrow(source);
    return true;
  }
};
template <>
struct type_caster<tetskin::python::PathLike> {
  NB_TYPE_CASTER(tetskin::python::PathLike, const_name("str | bytes | os.PathLike[str]"))
  bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
    value.object = borrow(source);
    return PyUnicode_Check(source.ptr()) || PyBytes_Check(source.ptr()) || hasattr(source, "__fspath__");
  }
};
template <>
struct type_caster<tetskin::python::Progress> {
  NB_TYPE_CASTER(tetskin::python::Progress, const_name("collections.abc.Callable[[float], object] | bool | None"))
  bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
    value.call = borrow(source);
    return source.is_none() || PyBool_Check(source.ptr()) || PyCallable_Check(source.ptr());
  }
};
/// Vectors and quaternions: any sequence of numbers. An array is one too, but type checkers do not know that.
template <std::size_t N>
struct type_caster<std::array<double, N>> : array_caster<std::array<double, N>, double, N> {
  static constexpr auto Name = const_name("Vector");
};
template <class Of>
struct type_caster<tetskin::python::Made<Of>> {
  static constexpr auto Name = make_caster<Of>::Name;
  template <class T>
  using Cast = T;
  static handle from_cpp(const tetskin::python::Made<Of>& made, rv_policy, cleanup_list*) noexcept {
    return made.array.inc_ref();
  }
};
template <class Of>
struct type_caster<tetskin::facade::Choice<Of>> {
  NB_TYPE_CASTER(tetskin::facade::Choice<Of>, tetskin::python::kWords<Of>)
  bool from_python(handle source, std::uint8_t flags, cleanup_list* cleanup) noexcept {
    make_caster<std::string> text;
    if (!text.from_python(source, flags, cleanup)) return false;
    value.name = text.operator std::string&();
    return true;
  }
};
}  // namespace nanobind::detail
