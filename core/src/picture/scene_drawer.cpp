#include "picture/scene_drawer.hpp"

#include <epoxy/gl.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "gl/egl_context.hpp"
#include "gl/gl_objects.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "picture/drawable.hpp"
#include "picture/flat_drawer.hpp"
#include "picture/render_targets.hpp"
#include "picture/shaders.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the pinhole projection with pixel centres at integers: x covers [x - 0.5, x + 0.5].
Eigen::Matrix4f clip_from_camera(const TileCamera& c, double near_z, double far_z) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2 * c.fx / c.width;
  m(0, 2) = 2 * (c.cx + 0.5) / c.width - 1;
  m(1, 1) = 2 * c.fy / c.height;
  m(1, 2) = 2 * (c.cy + 0.5) / c.height - 1;
  m(2, 2) = (far_z + near_z) / (far_z - near_z);
  m(2, 3) = -2 * far_z * near_z / (far_z - near_z);
  m(3, 2) = 1;
  return m.cast<float>();
}

cv::Mat read_back(GLenum attachment, GLenum format, GLenum type, cv::Size size, int cv_type) {
  cv::Mat image(size, cv_type);
  glReadBuffer(attachment);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.width, size.height, format, type, image.data);
  return image;
}

void prepare_to_draw(const TileCamera& camera) {
  glViewport(0, 0, camera.width, camera.height);
  glScissor(0, 0, camera.width, camera.height);
  glEnable(GL_SCISSOR_TEST);  // clears only what is drawn
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_DITHER);
}

GLint uniform(const gl::Program& program, const char* name) {
  return glGetUniformLocation(program, name);
}

void set(GLint location, const Eigen::Vector3f& v) { glUniform3fv(location, 1, v.data()); }

}  // namespace

struct SceneDrawer::Impl {
  explicit Impl(const Scene& s) : scene(s) {
    const gl::CurrentContext current(context);
    for (const Scene::Item& item : scene.items()) {
      drawables.push_back(make_drawable(item.model->data().mesh));
    }
    color_program =
        gl::make_program(shaders::kSceneVertex, shaders::kColorFragment, "the colour image");
    geometry_program =
        gl::make_program(shaders::kSceneVertex, shaders::kGeometryFragment, "the depth image");
    gl::check_errors("setting up the scene");
  }

  ~Impl() {
    // OpenGL objects must be deleted while their context is current, before it ends.
    const gl::CurrentContext current(context);
    drawables.clear();
    color_target = {};
    geometry_target = {};
    color_program = {};
    geometry_program = {};
  }

  void need_color_target(const TileCamera& camera, int samples) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = std::min(samples, most);
    if (samples <= 1) samples = 0;
    if (color_target.size.holds(camera, samples)) return;
    const TargetSize size = grown(color_target.size, camera, samples);
    color_target = {};
    color_target = make_color_target(size);
  }

  void need_geometry_target(const TileCamera& camera) {
    if (geometry_target.size.holds(camera, 0)) return;
    const TargetSize size = grown(geometry_target.size, camera, 0);
    geometry_target = {};
    geometry_target = make_geometry_target(size);
  }

  void set_camera(const gl::Program& program, const TileCamera& camera) const {
    double near_z = std::numeric_limits<double>::infinity(), far_z = 0;
    const Eigen::Isometry3f pose = camera.camera_from_world.cast<float>();
    for (const Eigen::Matrix3Xf& vertices : posed) {
      if (vertices.cols() == 0) continue;
      const auto z = (pose.linear().row(2) * vertices).array() + pose.translation().z();
      near_z = std::min<double>(near_z, z.minCoeff());
      far_z = std::max<double>(far_z, z.maxCoeff());
    }
    near_z = std::max(kNearest, 0.99 * near_z);
    far_z = std::max(2 * near_z, 1.01 * far_z);
    const Eigen::Matrix4f clip = clip_from_camera(camera, near_z, far_z);
    glUniformMatrix4fv(uniform(program, "clip_from_camera"), 1, GL_FALSE, clip.data());
    glUniformMatrix4fv(uniform(program, "camera_from_world"), 1, GL_FALSE, pose.matrix().data());
  }

  void set_style(const TileCamera& camera, const RenderStyle& style) const {
    const auto number = [&](const char* name, double value) {
      glUniform1f(uniform(color_program, name), static_cast<float>(value));
    };
    number("ambient", style.ambient);
    number("diffuse", style.diffuse);
    number("specular", style.specular);
    number("shininess", style.shininess);
    set(uniform(color_program, "to_light"), (-style.light_direction.normalized()).cast<float>());
    set(uniform(color_program, "camera_center"),
        camera.camera_from_world.inverse().translation().cast<float>());
    glUniform1i(uniform(color_program, "surface"), 0);
  }

  void draw_mesh(const Drawable& drawable) const {
    glBindVertexArray(drawable.vertex_array);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(drawable.mesh.triangles().size()),
                   GL_UNSIGNED_INT, nullptr);
  }

  bool is_hidden(std::size_t model) const { return posed[model].cols() == 0; }

  cv::Mat draw_color(const TileCamera& camera, const RenderStyle& style) const {
    glBindFramebuffer(GL_FRAMEBUFFER, color_target.multisampled);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUseProgram(color_program);
    set_camera(color_program, camera);
    set_style(camera, style);
    glActiveTexture(GL_TEXTURE0);
    for (std::size_t i = 0; i < drawables.size(); ++i) {
      if (is_hidden(i)) continue;
      const Drawable& drawable = drawables[i];
      glUniform1i(uniform(color_program, "textured"), style.textured && drawable.texture != 0);
      glBindTexture(GL_TEXTURE_2D, drawable.texture);
      set(uniform(color_program, "flat_color"),
          style.textured ? drawable.color : flat_color(static_cast<int>(i)));
      draw_mesh(drawable);
    }
    const int w = camera.width, h = camera.height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, color_target.multisampled);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, color_target.resolved);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, color_target.resolved);
    return read_back(GL_COLOR_ATTACHMENT0, GL_BGRA, GL_UNSIGNED_BYTE, {w, h}, CV_8UC4);
  }

  Geometry draw_geometry(const TileCamera& camera) const {
    glBindFramebuffer(GL_FRAMEBUFFER, geometry_target.framebuffer);
    constexpr std::array<GLfloat, 4> nothing = {0, 0, 0, 0};
    constexpr std::array<GLuint, 4> no_label = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glClearBufferuiv(GL_COLOR, 1, no_label.data());
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(geometry_program);
    set_camera(geometry_program, camera);
    for (std::size_t i = 0; i < drawables.size(); ++i) {
      if (is_hidden(i)) continue;
      glUniform1ui(uniform(geometry_program, "model_label"), static_cast<GLuint>(i + 1));
      draw_mesh(drawables[i]);
    }
    const cv::Size size(camera.width, camera.height);
    Geometry geometry;
    geometry.depth = read_back(GL_COLOR_ATTACHMENT0, GL_RED, GL_FLOAT, size, CV_32FC1);
    geometry.label =
        read_back(GL_COLOR_ATTACHMENT1, GL_RED_INTEGER, GL_UNSIGNED_BYTE, size, CV_8UC1);
    return geometry;
  }

  const Scene& scene;
  gl::Context context;
  std::vector<Drawable> drawables;
  gl::Program color_program;
  gl::Program geometry_program;
  ColorTarget color_target;
  GeometryTarget geometry_target;
  Eigen::VectorXd state;                // state in the buffers
  std::vector<bool> hidden;             // models left out of the buffers
  std::vector<Eigen::Matrix3Xf> posed;  // world vertices of every model; none if hidden
};

SceneDrawer::SceneDrawer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}

SceneDrawer::~SceneDrawer() = default;

const std::string& SceneDrawer::device() const { return impl_->context.device(); }

void SceneDrawer::pose(const Eigen::VectorXd& state, const std::vector<bool>& hidden) {
  if (state.size() == impl_->state.size() && state == impl_->state && hidden == impl_->hidden)
    return;
  std::vector<Eigen::Matrix3Xf> posed;
  for (const Scene::Item& item : impl_->scene.items()) {
    const bool is_hidden = posed.size() < hidden.size() && hidden[posed.size()];
    posed.push_back(is_hidden ? Eigen::Matrix3Xf()
                              : posed_vertices(*item.model, impl_->scene.part(item, state)));
  }
  const gl::CurrentContext current(impl_->context);
  for (std::size_t i = 0; i < posed.size(); ++i) {
    if (posed[i].cols() > 0) pose_drawable(impl_->drawables[i], posed[i]);
  }
  gl::check_errors("posing the scene");
  impl_->posed = std::move(posed);
  impl_->state = state;
  impl_->hidden = hidden;
}

Eigen::AlignedBox2d SceneDrawer::extent(const Eigen::Isometry3d& camera_from_world) const {
  return extent_of(impl_->posed, camera_from_world);
}

cv::Mat SceneDrawer::draw_color(const TileCamera& camera, const RenderStyle& style) {
  const gl::CurrentContext current(impl_->context);
  impl_->need_color_target(camera, style.samples);
  prepare_to_draw(camera);
  cv::Mat color = impl_->draw_color(camera, style);
  gl::check_errors("drawing the colour image");
  return color;
}

Geometry SceneDrawer::draw_geometry(const TileCamera& camera) {
  const gl::CurrentContext current(impl_->context);
  impl_->need_geometry_target(camera);
  prepare_to_draw(camera);
  Geometry geometry = impl_->draw_geometry(camera);
  gl::check_errors("drawing the depth image");
  return geometry;
}

}  // namespace hypotrack::internal
