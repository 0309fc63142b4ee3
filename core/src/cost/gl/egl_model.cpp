#include "cost/gl/egl_model.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "scene/mesh_topology.hpp"

namespace hypotrack::internal {
namespace {

using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

template <class Matrix>
void upload(GLenum target, GLuint buffer, const Matrix& data, GLenum usage) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(typename Matrix::Scalar)),
               data.data(), usage);
}

}  // namespace

EglModel::EglModel(const Scene::Item& item)
    : item_(&item),
      poser_(item.model->data()),
      two_sided_(!is_closed_outwards(simplified_mesh(*item.model))),
      vertex_array_(gl::make_vertex_array()),
      positions_(gl::make_buffer()),
      bones_(gl::make_buffer()),
      weights_(gl::make_buffer()),
      triangles_(gl::make_buffer()) {
  const Mesh& mesh = simplified_mesh(*item.model);
  glBindVertexArray(vertex_array_);
  upload(GL_ARRAY_BUFFER, positions_, mesh.vertices, GL_DYNAMIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  upload(GL_ARRAY_BUFFER, bones_, mesh.bone_indices, GL_STATIC_DRAW);
  glVertexAttribIPointer(1, 4, GL_INT, 0, nullptr);
  upload(GL_ARRAY_BUFFER, weights_, mesh.bone_weights, GL_STATIC_DRAW);
  glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
  upload(GL_ELEMENT_ARRAY_BUFFER, triangles_, mesh.triangles, GL_STATIC_DRAW);
}

std::span<const double> EglModel::drawable_part(std::span<const double> state) const {
  constexpr double kLargest = 1e6;  // as on the CPU: larger parameters are meaningless
  const auto part = state.subspan(static_cast<std::size_t>(item_->offset),
                                  static_cast<std::size_t>(item_->model->dimension()));
  const bool drawable = std::all_of(part.begin(), part.end(), [](double p) {
    return std::abs(p) <= kLargest;  // false for NaN
  });
  return drawable ? part : std::span<const double>{};
}

void EglModel::pose(std::span<const double> parameters, const Eigen::Isometry3d& first_from_world,
                    BonePoser::Workspace& workspace, float* matrices) const {
  if (poses_itself()) {  // its vertices are in world coordinates
    for (int b = 0; b < this->matrices(); ++b) {
      Eigen::Map<Rows>(matrices + 12 * b) = first_from_world.matrix().topRows<3>().cast<float>();
    }
    return;
  }
  poser_.pose(parameters, first_from_world, workspace, matrices);
}

void EglModel::upload_vertices(std::span<const double> parameters) const {
  const Eigen::Matrix3Xf vertices = posed_vertices(*item_->model, parameters);
  const Eigen::Index expected = item_->model->data().mesh.vertices.cols();
  if (vertices.cols() != expected) {
    throw PluginError(
        fmt::format("model '{}' poses itself and returned {} vertices, expected the {} of its mesh",
                    item_->name, vertices.cols(), expected));
  }
  upload(GL_ARRAY_BUFFER, positions_, vertices, GL_DYNAMIC_DRAW);
}

void EglModel::bind() const {
  glBindVertexArray(vertex_array_);
  if (two_sided_) {
    glDisable(GL_CULL_FACE);
  } else {
    glEnable(GL_CULL_FACE);
  }
}

void EglModel::draw(int instances) const {
  glDrawElementsInstanced(GL_TRIANGLES,
                          static_cast<GLsizei>(simplified_mesh(*item_->model).triangles.size()),
                          GL_UNSIGNED_INT, nullptr, instances);
}

}  // namespace hypotrack::internal
