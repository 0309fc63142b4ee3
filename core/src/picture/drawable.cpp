#include "picture/drawable.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

template <class Matrix>
void upload(GLenum target, const gl::Buffer& buffer, const Matrix& data, GLenum usage) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(typename Matrix::Scalar)),
               data.data(), usage);
}

void attribute(GLuint location, const gl::Buffer& buffer, GLint components) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
}

gl::Texture make_texture(const cv::Mat& image) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  cv::Mat fitted = image;
  if (const int size = std::max(image.cols, image.rows); size > largest) {
    const double scale = static_cast<double>(largest) / size;
    cv::resize(image, fitted, {}, scale, scale, cv::INTER_AREA);
  }
  if (!fitted.isContinuous()) fitted = fitted.clone();
  gl::Texture texture = gl::make_texture();
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, fitted.cols, fitted.rows, 0, GL_BGR, GL_UNSIGNED_BYTE,
               fitted.data);
  glGenerateMipmap(GL_TEXTURE_2D);
  // No anisotropic filter: with multisampling, Mesa's llvmpipe (22.3) hangs in it if a face is seen
  // almost edge on.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

Drawable make_drawable(const Mesh& mesh) {
  Drawable drawable{ShadingMesh(mesh),
                    gl::make_vertex_array(),
                    gl::make_buffer(),
                    gl::make_buffer(),
                    gl::make_buffer(),
                    gl::make_buffer(),
                    {},
                    mesh.color};
  glBindVertexArray(drawable.vertex_array);
  Eigen::Matrix2Xf uv = drawable.mesh.uv();
  uv.row(1) = (1.0F - uv.row(1).array()).matrix();
  upload(GL_ARRAY_BUFFER, drawable.uv, uv, GL_STATIC_DRAW);
  attribute(0, drawable.positions, 3);
  attribute(1, drawable.normals, 3);
  attribute(2, drawable.uv, 2);
  upload(GL_ELEMENT_ARRAY_BUFFER, drawable.triangles, drawable.mesh.triangles(), GL_STATIC_DRAW);
  const bool has_uv = mesh.uv_triangles.cols() == mesh.triangles.cols();
  if (has_uv && !mesh.texture.empty()) drawable.texture = make_texture(mesh.texture);
  return drawable;
}

void pose_drawable(const Drawable& drawable, const Eigen::Matrix3Xf& vertices) {
  upload(GL_ARRAY_BUFFER, drawable.positions, drawable.mesh.positions(vertices), GL_STREAM_DRAW);
  upload(GL_ARRAY_BUFFER, drawable.normals, drawable.mesh.normals(vertices), GL_STREAM_DRAW);
}

}  // namespace hypotrack::internal
