#pragma once

#include <epoxy/gl.h>

#include <string>
#include <utility>

#include "base/exported.hpp"

namespace hypotrack::gl {
inline namespace HYPOTRACK_EXPORTED internal {

/// Owner of an OpenGL name. The context that created the object must be current at its deletion.
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

void delete_buffer(GLuint name);
void delete_vertex_array(GLuint name);
void delete_texture(GLuint name);
void delete_renderbuffer(GLuint name);
void delete_framebuffer(GLuint name);
void delete_program(GLuint name);

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
/// Makes a renderbuffer; `samples` 0 means not multisampled.
Renderbuffer make_renderbuffer(GLenum format, int width, int height, int samples);

/// Compiles and links a program. Throws DeviceError with the driver's log, naming `what`.
Program make_program(const char* vertex_source, const char* fragment_source, const char* what);

/// Throws DeviceError unless the bound framebuffer is complete.
void check_framebuffer(const char* what);
/// Throws DeviceError if OpenGL has reported an error since the last check.
void check_errors(const char* what);

}  // namespace internal
}  // namespace hypotrack::gl
