#include "cost/gl/egl_program.hpp"

#include <epoxy/gl.h>

namespace hypotrack::internal {
namespace {

/// Vertex shader for linear blend skinning with 3x4 matrices from a buffer; one instance per
/// hypothesis.
constexpr const char* kVertexShader = R"(#version 330 core
#extension GL_ARB_shader_viewport_layer_array : enable
#extension GL_AMD_vertex_shader_layer : enable
layout(location = 0) in vec3 position;  // model frame at the bind pose, metres
layout(location = 1) in ivec4 bones;
layout(location = 2) in vec4 weights;
uniform samplerBuffer matrices;  // first_from_model of every bone, three rows each
uniform int first_matrix;        // of the model
uniform int matrix_stride;       // matrices per hypothesis
uniform int first_hypothesis;    // that the instance 0 is
uniform int view;
uniform int view_count;
uniform mat4 clip_from_first;
void main() {
  int hypothesis = first_hypothesis + gl_InstanceID;
  int matrix = hypothesis * matrix_stride + first_matrix;
  vec4 bind = vec4(position, 1.0);
  vec3 in_first = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    int row = 3 * (matrix + bones[i]);
    in_first += weights[i] * vec3(dot(texelFetch(matrices, row), bind),
                                  dot(texelFetch(matrices, row + 1), bind),
                                  dot(texelFetch(matrices, row + 2), bind));
  }
  gl_Layer = hypothesis * view_count + view;
  gl_Position = clip_from_first * vec4(in_first, 1.0);
}
)";

/// Fragment shader. It writes the reciprocal of clip w (the depth), which OpenGL interpolates
/// anyway.
constexpr const char* kFragmentShader = R"(#version 330 core
out float inverse_depth;
void main() { inverse_depth = gl_FragCoord.w; }
)";

}  // namespace

EglProgram::EglProgram(int matrix_stride)
    : program_(gl::make_program(kVertexShader, kFragmentShader, "the hypotheses")),
      first_matrix_(glGetUniformLocation(program_, "first_matrix")),
      first_hypothesis_(glGetUniformLocation(program_, "first_hypothesis")),
      view_(glGetUniformLocation(program_, "view")),
      view_count_(glGetUniformLocation(program_, "view_count")),
      clip_from_first_(glGetUniformLocation(program_, "clip_from_first")) {
  glUseProgram(program_);
  glUniform1i(glGetUniformLocation(program_, "matrices"), 0);
  glUniform1i(glGetUniformLocation(program_, "matrix_stride"), matrix_stride);
}

void EglProgram::set_view_count(int count) const { glUniform1i(view_count_, count); }

void EglProgram::set_model(int first_matrix) const { glUniform1i(first_matrix_, first_matrix); }

void EglProgram::set_first_hypothesis(int hypothesis) const {
  glUniform1i(first_hypothesis_, hypothesis);
}

void EglProgram::set_view(int view, const Eigen::Matrix4f& clip_from_first) const {
  glUniform1i(view_, view);
  glUniformMatrix4fv(clip_from_first_, 1, GL_FALSE, clip_from_first.data());
}

}  // namespace hypotrack::internal
