#pragma once

#include <epoxy/gl.h>

#include <string>
#include <utility>

namespace hypotrack::gl {

/// Owner of an OpenGL name. Deleting it needs the context that made it to be current.
template <void (*kDelete)(GLuint)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(GLuint name) : name_(name) {}
  ~Owned() { reset(); }
  Owned(Owned&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Owned& operator=(Owned&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }

  operator GLuint() const { return name_; }  // NOLINT(google-explicit-constructor)

 private:
  void reset() {
    if (name_) kDelete(std::exchange(name_, 0));
  }
  GLuint name_ = 0;
};

inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void delete_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void delete_program(GLuint name) { glDeleteProgram(name); }

using Buffer = Owned<delete_buffer>;
using VertexArray = Owned<delete_vertex_array>;
using Texture = Owned<delete_texture>;
using Renderbuffer = Owned<delete_renderbuffer>;
using Framebuffer = Owned<delete_framebuffer>;
using Program = Owned<delete_program>;

Buffer make_buffer();
VertexArray make_vertex_array();
Texture make_texture();
Framebuffer make_framebuffer();
/// `samples` 0: not multisampled.
Renderbuffer make_renderbuffer(GLenum format, int width, int height, int samples);

/// Compiles and links; throws DeviceError with the driver's log, naming `what`.
Program make_program(const char* vertex_source, const char* fragment_source, const char* what);

/// Throws DeviceError unless the bound framebuffer is complete.
void check_framebuffer(const char* what);
/// Throws DeviceError if OpenGL has reported an error since the last check.
void check_errors(const char* what);

}  // namespace hypotrack::gl
