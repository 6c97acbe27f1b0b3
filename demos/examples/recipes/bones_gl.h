// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// OpenGL 3.3 or OpenGL ES 3.0 draws a mesh by the bones of a BonePalette, with the shader bones.vert. Include what
// declares OpenGL before this file.
#pragma once

#include <tetskin/core/bone_palette.h>

#include <vector>

/// The bones of one body, in a texture of 3 x count texels: a row of a bone each. GL_MAX_TEXTURE_SIZE limits their
/// number, to 16,384 nearly everywhere.
struct BoneTexture {
  explicit BoneTexture(std::size_t count) : bones(12 * count) {
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 3, static_cast<GLsizei>(count), 0, GL_RGBA, GL_FLOAT, nullptr);
  }
  BoneTexture(const BoneTexture&) = delete;
  BoneTexture& operator=(const BoneTexture&) = delete;
  ~BoneTexture() { glDeleteTextures(1, &texture); }

  /// Once per frame.
  template <class Scalar>
  tetskin::StatusCode update(tetskin::BonePalette<Scalar>& palette, tetskin::PointView<const Scalar> nodes) {
    const std::size_t count = bones.size() / 12;
    const tetskin::StatusCode code = palette.update(nodes, {bones.data(), count});
    if (code != tetskin::StatusCode::Ok) return code;
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 3, static_cast<GLsizei>(count), GL_RGBA, GL_FLOAT, bones.data());
    return code;
  }

  GLuint texture = 0;
  std::vector<float> bones;
};

/// Makes a buffer of one attribute of the bound vertex array, and returns it.
/// integers  the shader's attribute is of integers
template <class Value>
GLuint addAttribute(GLuint program, const char* name, const std::vector<Value>& values, GLint components, GLenum type,
                    bool integers = false) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data(), GL_STATIC_DRAW);
  const auto place = static_cast<GLuint>(glGetAttribLocation(program, name));
  glEnableVertexAttribArray(place);
  if (integers) {
    glVertexAttribIPointer(place, components, type, 0, nullptr);
  } else {
    glVertexAttribPointer(place, components, type, GL_TRUE, 0, nullptr);  // floats are taken as they are
  }
  return buffer;
}

/// Once per mesh: bones and weights, in addition to the attributes restPosition and restNormal. Returns their buffers.
inline std::vector<GLuint> addBones(GLuint program, const tetskin::SkinnedMesh& mesh, bool halfSize) {
  return {addAttribute(program, "bones", mesh.bones, 4, GL_UNSIGNED_SHORT, true),
          halfSize ? addAttribute(program, "weights", mesh.normalisedWeights(), 4, GL_UNSIGNED_SHORT)
                   : addAttribute(program, "weights", mesh.weights, 4, GL_FLOAT)};
}
