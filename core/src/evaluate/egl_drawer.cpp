#include "evaluate/egl_drawer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "evaluate/simd_kernels.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/kinematics.hpp"
#include "render/egl_context.hpp"
#include "render/gl_objects.hpp"

namespace hypotrack {
namespace {

constexpr int kTallest = 8192;  // rows of the framebuffer that a batch is drawn to

/// Linear blend skinning with the rows of 3x4 matrices from a buffer.
constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;  // model frame at the bind pose, metres
layout(location = 1) in ivec4 bones;
layout(location = 2) in vec4 weights;
uniform samplerBuffer matrices;   // camera_from_model of every bone, three rows each
uniform int first_matrix;
uniform mat4 clip_from_camera;
void main() {
  vec4 bind = vec4(position, 1.0);
  vec3 in_camera = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    int row = 3 * (first_matrix + bones[i]);
    in_camera += weights[i] * vec3(dot(texelFetch(matrices, row), bind),
                                   dot(texelFetch(matrices, row + 1), bind),
                                   dot(texelFetch(matrices, row + 2), bind));
  }
  gl_Position = clip_from_camera * vec4(in_camera, 1.0);
}
)";

/// The reciprocal of the clip coordinate w, which is the depth, is what OpenGL interpolates anyway.
constexpr const char* kFragmentShader = R"(#version 330 core
out float inverse_depth;
void main() { inverse_depth = gl_FragCoord.w; }
)";

struct ModelBuffers {
  const Scene::Item* item = nullptr;
  std::vector<Eigen::Isometry3d> bone_from_model;  // at the bind pose
  gl::VertexArray vertex_array;
  gl::Buffer positions, bones, weights, triangles;
  GLsizei corner_count = 0;
  int first_matrix = 0;  // of the hypothesis' matrices
  int matrix_count = 0;
};

template <class Matrix>
void upload(GLenum target, GLuint buffer, const Matrix& data, GLenum usage) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(typename Matrix::Scalar)),
               data.data(), usage);
}

ModelBuffers make_buffers(const Scene::Item& item) {
  const ModelData& data = item.model->data();
  ModelBuffers model;
  model.item = &item;
  for (const Eigen::Isometry3d& bind : bind_transforms(data)) {
    model.bone_from_model.push_back(bind.inverse());
  }
  model.matrix_count = static_cast<int>(data.bones.size());
  model.corner_count = static_cast<GLsizei>(data.mesh.triangles.size());
  model.vertex_array = gl::make_vertex_array();
  model.positions = gl::make_buffer();
  model.bones = gl::make_buffer();
  model.weights = gl::make_buffer();
  model.triangles = gl::make_buffer();
  glBindVertexArray(model.vertex_array);
  upload(GL_ARRAY_BUFFER, model.positions, data.mesh.vertices, GL_DYNAMIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  upload(GL_ARRAY_BUFFER, model.bones, data.mesh.bone_indices, GL_STATIC_DRAW);
  glVertexAttribIPointer(1, 4, GL_INT, 0, nullptr);
  upload(GL_ARRAY_BUFFER, model.weights, data.mesh.bone_weights, GL_STATIC_DRAW);
  glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
  upload(GL_ELEMENT_ARRAY_BUFFER, model.triangles, data.mesh.triangles, GL_STATIC_DRAW);
  return model;
}

/// One view of the frame that is drawn.
struct View {
  Eigen::Matrix4f clip_from_first;  // from the frame of the first view's camera
  int width = 0;
  int height = 0;
};

View make_view(const TileCamera& c, const Eigen::Isometry3d& first_from_world) {
  constexpr double kNearZ = kNear, kFarZ = kFar;
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2 * c.fx / c.width;
  clip(0, 2) = 2 * (c.cx + 0.5) / c.width - 1;
  clip(1, 1) = 2 * c.fy / c.height;
  clip(1, 2) = 2 * (c.cy + 0.5) / c.height - 1;
  clip(2, 2) = (kFarZ + kNearZ) / (kFarZ - kNearZ);
  clip(2, 3) = -2 * kFarZ * kNearZ / (kFarZ - kNearZ);
  clip(3, 2) = 1;
  const Eigen::Isometry3d camera_from_first = c.camera_from_world * first_from_world.inverse();
  return {(clip * camera_from_first.matrix()).cast<float>(), c.width, c.height};
}

/// Such a model is not drawn: as on the CPU, larger parameters make no sense.
bool drawable(std::span<const double> parameters) {
  constexpr double kLargest = 1e6;
  return std::all_of(parameters.begin(), parameters.end(),
                     [](double p) { return std::abs(p) <= kLargest; });  // NaN: false
}

}  // namespace

struct EglDrawer::Impl {
  explicit Impl(const Scene& s) : scene(s) {
    const gl::CurrentContext current(context);
    for (const Scene::Item& item : scene.items()) {
      models.push_back(make_buffers(item));
      models.back().first_matrix = matrices_per_hypothesis;
      matrices_per_hypothesis += models.back().matrix_count;
    }
    program = gl::make_program(kVertexShader, kFragmentShader, "the hypotheses");
    matrix_buffer = gl::make_buffer();
    matrix_texture = gl::make_texture();
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    most_hypotheses = texels / (3 * matrices_per_hypothesis);
    gl::check_errors("setting up the hypotheses");
  }

  ~Impl() {
    const gl::CurrentContext current(context);  // OpenGL objects go while their context is current
    models.clear();
    program = {};
    matrix_buffer = {};
    matrix_texture = {};
    framebuffer = {};
    color = {};
  }

  void make_target() {
    target_views = 0;
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    const int view_count = static_cast<int>(views.size());
    const int rows = std::min<int>(largest, std::max(kTallest, view_count * cell_height));
    batch = std::min(rows / (view_count * cell_height), most_hypotheses);
    if (batch == 0 || stride > largest) {
      throw DeviceError(fmt::format(
          "evaluate: {} tiles of {}x{} pixels exceed what this OpenGL can draw to, {}x{}; use a "
          "smaller tile.size or backend: cpu",
          view_count, stride, cell_height, largest, largest));
    }
    const int height = batch * view_count * cell_height;
    framebuffer = gl::make_framebuffer();
    color = gl::make_renderbuffer(GL_R32F, stride, height, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    gl::check_framebuffer("the hypotheses");
    pixels = hwy::AllocateAligned<float>(static_cast<std::size_t>(stride) *
                                         static_cast<std::size_t>(height));
    target_views = view_count;
  }

  /// Matrices of one hypothesis, three rows of four per bone.
  void pose(std::span<const double> state, float* matrices) const {
    using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
    for (const ModelBuffers& model : models) {
      float* to = matrices + 12 * static_cast<std::ptrdiff_t>(model.first_matrix);
      const auto parameters = part(model, state);
      if (!drawable(parameters)) continue;
      const bool poses_itself =
          model.item->model->poses_itself();  // then vertices are in the world
      std::vector<Eigen::Isometry3d> bones;
      if (!poses_itself) bones = world_from_bones(model.item->model->data(), parameters);
      for (std::size_t b = 0; b < model.bone_from_model.size(); ++b, to += 12) {
        const Eigen::Isometry3d first_from_model =
            poses_itself ? first_from_world
                         : first_from_world * bones[b] * model.bone_from_model[b];
        Eigen::Map<Rows> rows(to);
        rows = first_from_model.matrix().topRows<3>().cast<float>();
      }
    }
  }

  static std::span<const double> part(const ModelBuffers& model, std::span<const double> state) {
    return state.subspan(static_cast<std::size_t>(model.item->offset),
                         static_cast<std::size_t>(model.item->model->dimension()));
  }

  void upload_matrices(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count) {
    const std::size_t floats = 12 * static_cast<std::size_t>(matrices_per_hypothesis);
    std::vector<float> matrices(floats * static_cast<std::size_t>(count), 0.0F);
    for (Eigen::Index i = 0; i < count; ++i) {
      pose({states.col(first + i).data(), static_cast<std::size_t>(states.rows())},
           matrices.data() + static_cast<std::size_t>(i) * floats);
    }
    glBindBuffer(GL_TEXTURE_BUFFER, matrix_buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(matrices.size() * sizeof(float)),
                 matrices.data(), GL_STREAM_DRAW);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_BUFFER, matrix_texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, matrix_buffer);
  }

  /// The vertices of a model that a skeleton cannot express.
  static void upload_vertices(const ModelBuffers& model, std::span<const double> parameters) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*model.item->model, parameters);
    if (vertices.cols() != model.item->model->data().mesh.vertices.cols()) {
      throw PluginError(fmt::format(
          "model '{}' poses itself and returned {} vertices, expected the {} of its mesh",
          model.item->name, vertices.cols(), model.item->model->data().mesh.vertices.cols()));
    }
    upload(GL_ARRAY_BUFFER, model.positions, vertices, GL_DYNAMIC_DRAW);
  }

  void begin_batch(int rows) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, stride, rows);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendEquation(GL_MAX);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "matrices"), 0);
  }

  void draw_hypothesis(std::span<const double> state, Eigen::Index i) const {
    const GLint first_matrix = glGetUniformLocation(program, "first_matrix");
    const GLint clip = glGetUniformLocation(program, "clip_from_camera");
    for (const ModelBuffers& model : models) {
      const auto parameters = part(model, state);
      if (!drawable(parameters)) continue;
      if (model.item->model->poses_itself()) upload_vertices(model, parameters);
      glBindVertexArray(model.vertex_array);
      glUniform1i(first_matrix,
                  static_cast<GLint>(i) * matrices_per_hypothesis + model.first_matrix);
      for (std::size_t v = 0; v < views.size(); ++v) {
        const View& view = views[v];
        const int row = first_row(i, static_cast<int>(v));
        glViewport(0, row, view.width, view.height);
        glScissor(0, row, view.width, view.height);
        glUniformMatrix4fv(clip, 1, GL_FALSE, view.clip_from_first.data());
        glDrawElements(GL_TRIANGLES, model.corner_count, GL_UNSIGNED_INT, nullptr);
      }
    }
  }

  int first_row(Eigen::Index i, int view) const {
    return (static_cast<int>(i) * static_cast<int>(views.size()) + view) * cell_height;
  }

  const Scene& scene;
  gl::Context context;
  std::vector<ModelBuffers> models;
  int matrices_per_hypothesis = 0;
  int most_hypotheses = 0;  // whose matrices fit into a buffer
  gl::Program program;
  gl::Buffer matrix_buffer;
  gl::Texture matrix_texture;

  Eigen::Isometry3d first_from_world = Eigen::Isometry3d::Identity();
  std::vector<View> views;
  int stride = 0;  // width of the framebuffer
  int cell_height = 0;
  int target_views = 0;  // that the framebuffer was made for
  int batch = 0;
  gl::Framebuffer framebuffer;
  gl::Renderbuffer color;
  hwy::AlignedFreeUniquePtr<float[]> pixels;
};

EglDrawer::EglDrawer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}

EglDrawer::~EglDrawer() = default;

int EglDrawer::views() const { return static_cast<int>(impl_->views.size()); }

Eigen::Index EglDrawer::batch_size() const { return impl_->batch; }

const std::string& EglDrawer::device() const { return impl_->context.device(); }

void EglDrawer::prepare(const Observation& observation) {
  impl_->views.clear();
  if (observation.views.empty()) return;
  impl_->first_from_world = observation.views.front().camera.camera_from_world;
  int width = 0, height = 0;
  for (const TileView& view : observation.views) {
    impl_->views.push_back(make_view(view.camera, impl_->first_from_world));
    width = std::max(width, view.camera.width);
    height = std::max(height, view.camera.height);
  }
  const int stride = (width + kBlock - 1) / kBlock * kBlock;
  const int view_count = static_cast<int>(impl_->views.size());
  if (stride == impl_->stride && height == impl_->cell_height && view_count == impl_->target_views)
    return;
  impl_->stride = stride;
  impl_->cell_height = height;
  const gl::CurrentContext current(impl_->context);
  impl_->make_target();
}

void EglDrawer::draw(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count) {
  const gl::CurrentContext current(impl_->context);
  const int rows = impl_->first_row(count, 0);
  impl_->upload_matrices(states, first, count);
  impl_->begin_batch(rows);
  for (Eigen::Index i = 0; i < count; ++i) {
    impl_->draw_hypothesis({states.col(first + i).data(), static_cast<std::size_t>(states.rows())},
                           i);
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, impl_->stride, rows, GL_RED, GL_FLOAT, impl_->pixels.get());
  gl::check_errors("drawing hypotheses");
}

DepthTile EglDrawer::tile(Eigen::Index i, int view) const {
  const View& v = impl_->views[static_cast<std::size_t>(view)];
  const float* pixels =
      impl_->pixels.get() + static_cast<std::ptrdiff_t>(impl_->stride) * impl_->first_row(i, view);
  return {v.width, v.height, impl_->stride, pixels, 0, 0, v.width, v.height};
}

}  // namespace hypotrack
