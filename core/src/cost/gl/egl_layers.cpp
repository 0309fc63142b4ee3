#include "cost/gl/egl_layers.hpp"

#include <epoxy/gl.h>

#include <cstddef>
#include <utility>

#include "gl/egl_context.hpp"
#include "gl/gl_objects.hpp"

namespace hypotrack::internal {

struct EglLayers::Impl {
  const gl::Context& context;
  LayerSize size;
  gl::Texture texture;
  gl::Framebuffer all_layers, one_layer;
};

EglLayers::EglLayers(const gl::Context& context, const LayerSize& size) {
  const gl::CurrentContext current(context);
  // On failure, OpenGL objects are deleted while their context is current.
  std::unique_ptr<Impl> made(
      new Impl{context, size, gl::make_texture(), gl::make_framebuffer(), gl::make_framebuffer()});
  glBindTexture(GL_TEXTURE_2D_ARRAY, made->texture);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, size.width, size.height, size.layers, 0, GL_RED,
               GL_FLOAT, nullptr);
  gl::check_errors("making room for hypotheses");
  glBindFramebuffer(GL_FRAMEBUFFER, made->all_layers);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, made->texture, 0);
  gl::check_framebuffer("the hypotheses");
  impl_ = std::move(made);
}

EglLayers::~EglLayers() {
  const gl::CurrentContext current(impl_->context);
  impl_.reset();  // deletes OpenGL objects while their context is current
}

bool EglLayers::holds(const LayerSize& size) const {
  return size.width == impl_->size.width && size.height == impl_->size.height &&
         size.layers <= impl_->size.layers;
}

unsigned EglLayers::texture() const { return impl_->texture; }

void EglLayers::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, impl_->all_layers);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
}

void EglLayers::read(int layers, float* pixels) const {
  const gl::CurrentContext current(impl_->context);
  const LayerSize& size = impl_->size;
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, impl_->one_layer);
  for (int i = 0; i < layers; ++i, pixels += std::ptrdiff_t{size.width} * size.height) {
    glFramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, impl_->texture, 0, i);
    glReadPixels(0, 0, size.width, size.height, GL_RED, GL_FLOAT, pixels);
  }
  gl::check_errors("reading hypotheses back");
}

}  // namespace hypotrack::internal
