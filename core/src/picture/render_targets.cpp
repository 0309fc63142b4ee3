#include "picture/render_targets.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

void attach(GLenum attachment, const gl::Renderbuffer& buffer) {
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

}  // namespace

TargetSize grown(const TargetSize& former, const TileCamera& camera, int samples) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (camera.width > largest || camera.height > largest) {
    throw DeviceError(fmt::format(
        "cannot draw a picture of {}x{} pixels: this OpenGL goes up to {}x{}; use a smaller camera",
        camera.width, camera.height, largest, largest));
  }
  const auto grow = [&](int have, int need) {
    return std::max(have, std::min(largest, (need + 63) / 64 * 64));
  };
  return {grow(former.width, camera.width), grow(former.height, camera.height), samples};
}

ColorTarget make_color_target(const TargetSize& size) {
  const auto [width, height, samples] = size;
  ColorTarget t;
  t.size = size;
  t.multisampled = gl::make_framebuffer();
  t.multisampled_color = gl::make_renderbuffer(GL_RGBA8, width, height, samples);
  t.multisampled_depth = gl::make_renderbuffer(GL_DEPTH_COMPONENT24, width, height, samples);
  glBindFramebuffer(GL_FRAMEBUFFER, t.multisampled);
  attach(GL_COLOR_ATTACHMENT0, t.multisampled_color);
  attach(GL_DEPTH_ATTACHMENT, t.multisampled_depth);
  gl::check_framebuffer("the colour image");
  t.resolved = gl::make_framebuffer();
  t.resolved_color = gl::make_renderbuffer(GL_RGBA8, width, height, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, t.resolved);
  attach(GL_COLOR_ATTACHMENT0, t.resolved_color);
  gl::check_framebuffer("the resolved colour image");
  return t;
}

GeometryTarget make_geometry_target(const TargetSize& size) {
  GeometryTarget t;
  t.size = size;
  t.framebuffer = gl::make_framebuffer();
  t.depth = gl::make_renderbuffer(GL_R32F, size.width, size.height, 0);
  t.label = gl::make_renderbuffer(GL_R8UI, size.width, size.height, 0);
  t.z_buffer = gl::make_renderbuffer(GL_DEPTH_COMPONENT24, size.width, size.height, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, t.framebuffer);
  attach(GL_COLOR_ATTACHMENT0, t.depth);
  attach(GL_COLOR_ATTACHMENT1, t.label);
  attach(GL_DEPTH_ATTACHMENT, t.z_buffer);
  constexpr std::array<GLenum, 2> outputs = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, outputs.data());
  gl::check_framebuffer("the depth and label images");
  return t;
}

}  // namespace hypotrack::internal
