// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/tets/vtk_cage_data.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <type_traits>

namespace tetskin::io {

namespace {

/// A kind of data other than SCALARS: a keyword, a name, possibly the number of components, possibly a type.
struct Attribute {
  const char* keyword;
  std::uint64_t components;  ///< 0: stated in the file
  bool typed;                ///< states a type; otherwise the values are bytes in binary files, numbers in text
};
/// The format's kinds of data: the keyword, the numbers per element, and whether a type is stated.
constexpr std::array<Attribute, 10> kAttributes = {{{"vectors", 3, true},
                                                    {"normals", 3, true},
                                                    {"tensors", 9, true},
                                                    {"tensors6", 6, true},
                                                    {"global_ids", 1, true},
                                                    {"pedigree_ids", 1, true},
                                                    {"edge_flags", 1, true},
                                                    {"texture_coordinates", 0, true},
                                                    {"color_scalars", 0, false},
                                                    {"lookup_table", 4, false}}};

/// Null if there is no such kind.
const Attribute* attributeNamed(const std::string& keyword) {
  for (const Attribute& attribute : kAttributes) {
    if (keyword == attribute.keyword) return &attribute;
  }
  return nullptr;
}

/// Removes the values of cells that are not tets.
template <class Value>
void keepValues(std::vector<Value>& values, const std::vector<bool>& isTet) {
  if (values.empty()) return;
  assert(!isTet.empty() && values.size() % isTet.size() == 0);
  const std::size_t components = values.size() / isTet.size();  // an array of cells has values for all cells
  auto kept = values.begin();
  for (std::size_t cell = 0; cell < isTet.size(); ++cell) {
    if (!isTet[cell]) continue;
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(cell * components);
    kept = std::copy_n(from, components, kept);
  }
  values.erase(kept, values.end());
}

template <class Value>
void appendValues(std::string& text, const std::vector<Value>& values, std::size_t components) {
  assert(components > 0 && values.size() % components == 0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    appendNumber(text, values[k]);
    text += (k + 1) % components == 0 ? '\n' : ' ';
  }
}

void appendHeader(std::string& text, const char* section, std::size_t count) {
  text += section;
  text += ' ' + std::to_string(count) + '\n';
}

template <class Value>
void appendScalars(std::string& text, const char* name, const char* type, const std::vector<Value>& values) {
  if (values.empty()) return;
  text += std::string("SCALARS ") + name + ' ' + type + " 1\nLOOKUP_TABLE default\n";
  appendValues(text, values, 1);
}

template <class Value>
void appendFieldArray(std::string& text, const char* name, const char* type, const std::vector<Value>& values,
                      std::size_t components) {
  if (values.empty()) return;
  text += std::string(name) + ' ' + std::to_string(components) + ' ' + std::to_string(values.size() / components) +
          ' ' + type + '\n';
  appendValues(text, values, components);
}

}  // namespace

Status VtkCageData::readField() {
  return file_.readField([&](const VtkArray& array) { return readArray(array); });
}

Status VtkCageData::readSections(std::string keyword, std::size_t cells, std::size_t nodes) {
  Status status;
  for (; status.ok() && !keyword.empty(); keyword = file_.word()) {
    const bool section = keyword == "cell_data" || keyword == "point_data";
    status = section ? beginSection(keyword, cells, nodes) : readAttribute(keyword);
  }
  return status;
}

Status VtkCageData::beginSection(const std::string& keyword, std::size_t cells, std::size_t nodes) {
  owner_ = keyword == "cell_data" ? Owner::Cells : Owner::Nodes;
  const std::string name = owner_ == Owner::Cells ? "cells" : "points";
  const std::size_t wanted = owner_ == Owner::Cells ? cells : nodes;
  Status status = file_.readCount(name.c_str(), tuples_);
  if (!status.ok() || tuples_ == wanted) return status;
  return file_.error(StatusCode::SizeMismatch, "has data of " + std::to_string(tuples_) + " " + name +
                                                   ", but there are " + std::to_string(wanted) +
                                                   "; correct the data, or remove them");
}

Status VtkCageData::readAttribute(const std::string& keyword) {
  if (keyword == "field") return readField();
  if (keyword == "scalars") return readScalars();
  if (keyword == "metadata") {
    file_.skipMetadata();
    return {};
  }
  const Attribute* known = attributeNamed(keyword);
  if (!known) {
    return file_.error(StatusCode::Malformed,
                       "has " + excerpt(keyword) +
                           " where data of cells or points are expected; do the data before them "
                           "have the right number of entries? Correct or remove them");
  }
  VtkArray array{std::string(file_.name()), known->components, tuples_, file_.binary() ? "unsigned_char" : "float"};
  Status status;
  if (keyword == "lookup_table") {
    array.name.clear();  // an array of colours, which belongs to neither cells nor points
    status = file_.readCount("colours", array.tuples);
  } else if (known->components == 0) {
    status = file_.readCount("components", array.components);
  }
  if (known->typed) array.type = file_.word();
  file_.endHeader();
  if (status.ok()) status = file_.checkSize(array);
  return status.ok() ? readArray(array) : status;
}

Status VtkCageData::readScalars() {
  VtkArray array{std::string(file_.name()), 1, tuples_, file_.word()};
  TextScanner rest(file_.restOfLine());
  const std::string_view components = rest.word();
  if (!components.empty() && !parseInteger(components, array.components)) {
    return file_.error(StatusCode::Malformed,
                       "has " + excerpt(components) + " for the number of components; correct the file");
  }
  if (file_.wordAhead() == "lookup_table") {
    file_.word();
    file_.word();  // its name
    file_.endHeader();
  }
  const Status status = file_.checkSize(array);
  return status.ok() ? readArray(array) : status;
}

Status VtkCageData::readArray(const VtkArray& array) {
  const auto is = [&](Owner wanted, const char* name) { return owner_ == wanted && array.name == name; };
  if (is(Owner::File, "mesh_hash")) return readHash(array);
  if (is(Owner::File, "vertex_tets")) return readInto(array, 1, cage_.vertexTets);
  if (is(Owner::Cells, "fill")) return readInto(array, 1, cage_.volumeFraction);
  if (is(Owner::Cells, "factor")) return readInto(array, 1, cage_.stiffnessFactor);
  if (is(Owner::Cells, "painted_stiffness")) return readInto(array, 1, cage_.paintedStiffness);
  if (is(Owner::Cells, "painted_density")) return readInto(array, 1, cage_.paintedDensity);
  if (is(Owner::Cells, "painted_damping")) return readInto(array, 1, cage_.paintedDamping);
  if (is(Owner::Cells, "part")) return readInto(array, 1, cage_.component);
  if (is(Owner::Cells, "lattice_tet")) return readInto(array, 1, cage_.sourceTet);
  if (is(Owner::Cells, "quadratic_tet")) return readInto(array, 1, cage_.quadraticTet);
  if (is(Owner::Cells, "fine_fill")) return readInto(array, kFineTets, cage_.fineVolumeFraction);
  if (is(Owner::Nodes, "mass")) return readInto(array, 1, cage_.masses);
  return file_.skip(array);
}

Status VtkCageData::readHash(const VtkArray& array) {
  std::vector<std::uint32_t> words;
  if (Status status = readInto(array, 2, words); !status.ok()) return status;
  if (words.size() != 2) return fault("has " + std::to_string(array.tuples) + " hashes in 'mesh_hash' in place of one");
  cage_.meshHash = std::uint64_t{words[0]} << 32 | words[1];
  return {};
}

/// Reads the numbers of a known array: a fixed number of values per owner, each a Number.
template <class Number>
Status VtkCageData::readInto(const VtkArray& array, std::uint64_t components, std::vector<Number>& values) {
  constexpr bool kReal = std::is_floating_point_v<Number>;
  using Wide = std::conditional_t<kReal, double, std::int64_t>;
  const std::string name = excerpt(array.name);
  if (array.components != components) {
    return fault("has " + std::to_string(array.components) + " components in " + name + " in place of " +
                 std::to_string(components));
  }
  if (owner_ != Owner::File && array.tuples != tuples_) {
    return fault("has " + std::to_string(array.tuples) + " tuples in " + name + " in place of " +
                 std::to_string(tuples_));
  }
  const NumberType type = vtkNumberType(array.type);
  if (type.bytes == 0 || (type.real && !kReal)) {
    return fault("has " + name + " of type " + excerpt(array.type) + " in place of " +
                 (kReal ? "numbers" : "integers"));
  }
  values.clear();
  values.reserve(static_cast<std::size_t>(array.count()));
  return file_.readNumbers<Wide>(array.count(), array.type, [&](Wide value) -> Status {
    values.push_back(static_cast<Number>(value));
    if (kReal || static_cast<Wide>(values.back()) == value) return {};
    return fault("has " + std::to_string(value) + " in " + name + ", whose largest value is " +
                 std::to_string(std::numeric_limits<Number>::max()));
  });
}

Status VtkCageData::fault(const std::string& what) const {
  return file_.error(StatusCode::Malformed, what + "; correct the array, or give it another name");
}

void VtkCageData::keepTets(const std::vector<bool>& isTet) {
  keepValues(cage_.volumeFraction, isTet);
  keepValues(cage_.stiffnessFactor, isTet);
  keepValues(cage_.paintedStiffness, isTet);
  keepValues(cage_.paintedDensity, isTet);
  keepValues(cage_.paintedDamping, isTet);
  keepValues(cage_.component, isTet);
  keepValues(cage_.sourceTet, isTet);
  keepValues(cage_.quadraticTet, isTet);
  keepValues(cage_.fineVolumeFraction, isTet);
}

void appendCageData(std::string& text, const Cage& cage) {
  std::vector<std::uint32_t> hash;
  if (cage.meshHash) {
    hash = {static_cast<std::uint32_t>(*cage.meshHash >> 32), static_cast<std::uint32_t>(*cage.meshHash)};
  }
  const std::size_t fields = (hash.empty() ? 0u : 1u) + (cage.vertexTets.empty() ? 0u : 1u);
  if (fields > 0) appendHeader(text, "FIELD FieldData", fields);
  appendFieldArray(text, "mesh_hash", "unsigned_int", hash, 2);
  appendFieldArray(text, "vertex_tets", "int", cage.vertexTets, 1);

  const bool ofCells = !(cage.volumeFraction.empty() && cage.stiffnessFactor.empty() && cage.component.empty() &&
                         cage.paintedStiffness.empty() && cage.paintedDensity.empty() && cage.paintedDamping.empty() &&
                         cage.sourceTet.empty() && cage.quadraticTet.empty() && cage.fineVolumeFraction.empty());
  if (ofCells) appendHeader(text, "CELL_DATA", cage.mesh.tetCount());
  appendScalars(text, "fill", "double", cage.volumeFraction);
  appendScalars(text, "factor", "double", cage.stiffnessFactor);
  appendScalars(text, "painted_stiffness", "double", cage.paintedStiffness);
  appendScalars(text, "painted_density", "double", cage.paintedDensity);
  appendScalars(text, "painted_damping", "double", cage.paintedDamping);
  appendScalars(text, "part", "int", cage.component);
  appendScalars(text, "lattice_tet", "int", cage.sourceTet);
  appendScalars(text, "quadratic_tet", "int", cage.quadraticTet);
  if (!cage.fineVolumeFraction.empty()) appendHeader(text, "FIELD FieldData", 1);
  appendFieldArray(text, "fine_fill", "unsigned_char", cage.fineVolumeFraction, kFineTets);

  if (!cage.masses.empty()) appendHeader(text, "POINT_DATA", cage.mesh.nodeCount());
  appendScalars(text, "mass", "double", cage.masses);
}

}  // namespace tetskin::io
