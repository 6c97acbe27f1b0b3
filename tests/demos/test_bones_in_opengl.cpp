// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The recipe for OpenGL, compiled and run by a software renderer without a display: transform feedback returns what the
// shader computes.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <fstream>
#include <sstream>

#include "moved_model.h"
#include "recipes/bones_gl.h"

namespace tetskin::test {
namespace {

/// A kind of OpenGL.
struct Api {
  const char* name;
  EGLenum api;
  EGLint minor;  ///< of version 3
  const char* header;
};
constexpr Api kApis[] = {{"OpenGL 3.3", EGL_OPENGL_API, 3, "#version 330 core\n"},
                         {"OpenGL ES 3.0", EGL_OPENGL_ES_API, 0, "#version 300 es\n"}};

/// A context of OpenGL, current as long as it lives.
class Context {
 public:
  explicit Context(const Api& api) {
    const auto displayOf =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    display_ = displayOf(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EXPECT_TRUE(eglInitialize(display_, nullptr, nullptr));
    EXPECT_TRUE(eglBindAPI(api.api));
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, api.minor, EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    EXPECT_TRUE(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) << eglGetError();
    // Nothing is drawn without something to draw to.
    GLuint frame = 0, colours = 0;
    glGenRenderbuffers(1, &colours);
    glBindRenderbuffer(GL_RENDERBUFFER, colours);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 1, 1);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colours);
    EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
  }
  ~Context() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

std::string recipe(const char* name) {
  std::ifstream file(std::string(TETSKIN_RECIPES "/") + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

GLuint compiled(GLenum kind, const std::string& text) {
  const char* const source = text.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  char log[2000] = "";
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  EXPECT_TRUE(done) << log;
  return shader;
}

/// The recipe's shader, before one that nothing reaches.
GLuint programFor(const std::string& header) {
  const GLuint shaders[] = {
      compiled(GL_VERTEX_SHADER, header + recipe("bones.vert")),
      compiled(GL_FRAGMENT_SHADER,
               header + "precision highp float; out vec4 colour; void main() { colour = vec4(1); }")};
  const GLuint program = glCreateProgram();
  for (const GLuint shader : shaders) glAttachShader(program, shader);
  const char* const results[] = {"position", "normal"};
  glTransformFeedbackVaryings(program, 2, results, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  for (const GLuint shader : shaders) glDeleteShader(shader);
  GLint done = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  char log[2000] = "";
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  EXPECT_TRUE(done) << log;
  return program;
}

struct Results {
  std::vector<Eigen::Vector3f> positions, normals;
};

/// Draws vertices as points, and reads what the shader wrote.
Results drawnPoints(std::size_t count) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
  const auto bytes = static_cast<GLsizeiptr>(6 * sizeof(float) * count);
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
  glEndTransformFeedback();
  const auto* numbers =
      static_cast<const float*>(glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, GL_MAP_READ_BIT));
  Results results;
  for (std::size_t v = 0; v < count; ++v) {
    results.positions.emplace_back(&numbers[6 * v]);
    results.normals.emplace_back(&numbers[6 * v + 3]);
  }
  glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
  glDeleteBuffers(1, &buffer);
  return results;
}

Results drawn(MovedModel& moved, const std::string& header, bool halfSize) {
  const GLuint program = programFor(header);
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glUseProgram(program);
  std::vector<GLuint> buffers = addBones(program, moved.skinned, halfSize);
  buffers.push_back(addAttribute(program, "restPosition", moved.restPositions, 3, GL_FLOAT));
  buffers.push_back(addAttribute(program, "restNormal", moved.normals, 3, GL_FLOAT));
  BoneTexture texture(moved.palette.boneCount());
  EXPECT_EQ(texture.update(moved.palette, viewOf(std::as_const(moved.nodes))), StatusCode::Ok);
  Results results = drawnPoints(moved.model.mesh.vertexCount());
  glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  glDeleteVertexArrays(1, &array);
  glDeleteProgram(program);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  return results;
}

TEST(BonesInOpenGl, AreDrawnWhereTheSkinHasThem) {
  for (const BoneKind& kind : test::kBoneKinds) {
    MovedModel moved(kind, BoneLayout::Rows);
    EXPECT_GT(moved.farthest(moved.restPositions), 0.1) << "the model has moved";
    for (const Api& api : kApis) {
      const Context context(api);
      for (const bool halfSize : {false, true}) {
        const std::string header = std::string(api.header) + (kind.gradients ? "#define GRADIENTS\n" : "");
        const Results results = drawn(moved, header, halfSize);
        SCOPED_TRACE(testing::Message() << kind.name << ", " << api.name << ", weights of 16 bits: " << halfSize);
        EXPECT_LT(moved.farthest(results.positions), 1e-5);
        if (kind.turnsNormals()) {
          EXPECT_LT(moved.meanDegrees(results.normals), kind.meanDegrees);
        } else {
          EXPECT_GT(moved.meanDegrees(results.normals), 30.0) << "there is something to turn";
        }
      }
    }
  }
}

}  // namespace
}  // namespace tetskin::test
