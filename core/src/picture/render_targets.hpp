#pragma once

#include "base/exported.hpp"
#include "gl/gl_objects.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Size of framebuffers; they grow to the largest picture drawn so far.
struct TargetSize {
  int width = 0;
  int height = 0;
  int samples = 0;
  bool holds(const TileCamera& camera, int wanted_samples) const {
    return width >= camera.width && height >= camera.height && samples == wanted_samples;
  }
};

struct ColorTarget {
  TargetSize size;
  gl::Framebuffer multisampled;
  gl::Renderbuffer multisampled_color;
  gl::Renderbuffer multisampled_depth;
  gl::Framebuffer resolved;
  gl::Renderbuffer resolved_color;
};

struct GeometryTarget {
  TargetSize size;
  gl::Framebuffer framebuffer;
  gl::Renderbuffer depth;
  gl::Renderbuffer label;
  gl::Renderbuffer z_buffer;
};

/// Returns the size that also holds the camera's picture. Throws DeviceError if OpenGL cannot draw
/// pictures that large.
TargetSize grown(const TargetSize& former, const TileCamera& camera, int samples);

ColorTarget make_color_target(const TargetSize& size);
GeometryTarget make_geometry_target(const TargetSize& size);

}  // namespace internal
}  // namespace hypotrack
