#include "cost/gl/egl_scene.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

using States = Eigen::Ref<const Eigen::MatrixXd>;

std::span<const double> column(const States& states, Eigen::Index i) {
  return {states.col(i).data(), static_cast<std::size_t>(states.rows())};
}

void check_extensions() {
  if (epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array") ||
      epoxy_has_gl_extension("GL_AMD_vertex_shader_layer")) {
    return;
  }
  throw DeviceError(
      fmt::format("evaluate: this OpenGL ({}) has neither GL_ARB_shader_viewport_layer_array nor "
                  "GL_AMD_vertex_shader_layer, which drawing hypotheses needs; use backend: cpu",
                  reinterpret_cast<const char*>(glGetString(GL_RENDERER))));
}

/// Sets the OpenGL state that never changes in this context.
void set_state() {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  glFrontFace(GL_CW);  // image rows run downwards, OpenGL's upwards
}

}  // namespace

EglScene::EglScene(const Scene& scene) {
  check_extensions();
  for (const Scene::Item& item : scene.items()) {
    models_.emplace_back(item);
    first_matrix_.push_back(matrix_stride_);
    matrix_stride_ += models_.back().matrices();
  }
  program_ = EglProgram(matrix_stride_);
  matrix_buffer_ = gl::make_buffer();
  matrix_texture_ = gl::make_texture();
  set_state();
  gl::check_errors("setting up the hypotheses");
}

int EglScene::most_hypotheses() const {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return texels / (3 * matrix_stride_);
}

void EglScene::pose(const States& states, const Eigen::Isometry3d& first_from_world) {
  // A model that is not drawn keeps zero matrices, which collapse it to a single point.
  matrices_.assign(static_cast<std::size_t>(12 * matrix_stride_ * states.cols()), 0.0F);
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    for (std::size_t m = 0; m < models_.size(); ++m) {
      const auto parameters = models_[m].drawable_part(column(states, i));
      if (parameters.empty()) continue;
      models_[m].pose(parameters, first_from_world, workspace_,
                      matrices_.data() + 12 * (i * matrix_stride_ + first_matrix_[m]));
    }
  }
  glBindBuffer(GL_TEXTURE_BUFFER, matrix_buffer_);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(matrices_.size() * sizeof(float)),
               matrices_.data(), GL_STREAM_DRAW);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, matrix_texture_);
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, matrix_buffer_);
}

void EglScene::draw(const States& states, std::span<const EglView> views) const {
  program_.set_view_count(static_cast<int>(views.size()));
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const EglModel& model = models_[m];
    program_.set_model(first_matrix_[m]);
    if (!model.poses_itself()) {
      draw_instances(model, 0, states.cols(), views);
      continue;
    }
    for (Eigen::Index i = 0; i < states.cols(); ++i) {  // each hypothesis has its own vertices
      const auto parameters = model.drawable_part(column(states, i));
      if (parameters.empty()) continue;
      model.upload_vertices(parameters);
      draw_instances(model, i, 1, views);
    }
  }
}

void EglScene::draw_instances(const EglModel& model, Eigen::Index first, Eigen::Index count,
                              std::span<const EglView> views) const {
  model.bind();
  program_.set_first_hypothesis(static_cast<int>(first));
  for (std::size_t v = 0; v < views.size(); ++v) {
    glViewport(0, 0, views[v].width, views[v].height);
    glScissor(0, 0, views[v].width, views[v].height);
    program_.set_view(static_cast<int>(v), views[v].clip_from_first);
    model.draw(static_cast<int>(count));
  }
}

}  // namespace hypotrack::internal
