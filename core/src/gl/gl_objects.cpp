#include "gl/gl_objects.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"

namespace hypotrack::gl::internal {
namespace {

std::string shader_log(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  return log;
}

std::string program_log(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  return log;
}

using Shader = Owned<+[](GLuint name) { glDeleteShader(name); }>;

Shader compile(GLenum stage, const char* source, const char* what) {
  Shader shader(glCreateShader(stage));
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    throw DeviceError(fmt::format("OpenGL does not compile the {} shader of {}:\n{}",
                                  stage == GL_VERTEX_SHADER ? "vertex" : "fragment", what,
                                  shader_log(shader)));
  }
  return shader;
}

}  // namespace

void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
void delete_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void delete_program(GLuint name) { glDeleteProgram(name); }

Buffer make_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return Buffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return VertexArray(name);
}

Texture make_texture() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return Texture(name);
}

Framebuffer make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return Framebuffer(name);
}

Renderbuffer make_renderbuffer(GLenum format, int width, int height, int samples) {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  Renderbuffer buffer(name);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return buffer;
}

Program make_program(const char* vertex_source, const char* fragment_source, const char* what) {
  const Shader vertex = compile(GL_VERTEX_SHADER, vertex_source, what);
  const Shader fragment = compile(GL_FRAGMENT_SHADER, fragment_source, what);
  Program program(glCreateProgram());
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (!ok) {
    throw DeviceError(
        fmt::format("OpenGL does not link the program of {}:\n{}", what, program_log(program)));
  }
  glDetachShader(program, vertex);
  glDetachShader(program, fragment);
  return program;
}

void check_framebuffer(const char* what) {
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw DeviceError(
        fmt::format("OpenGL cannot draw to the framebuffer of {} (status 0x{:04x})", what, status));
  }
}

void check_errors(const char* what) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  const char* name = error == GL_OUT_OF_MEMORY       ? "out of memory"
                     : error == GL_INVALID_ENUM      ? "invalid enum"
                     : error == GL_INVALID_VALUE     ? "invalid value"
                     : error == GL_INVALID_OPERATION ? "invalid operation"
                                                     : "unknown error";
  throw DeviceError(fmt::format("OpenGL failed at {}: {} (0x{:04x})", what, name, error));
}

}  // namespace hypotrack::gl::internal
