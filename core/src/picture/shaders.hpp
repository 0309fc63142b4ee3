#pragma once

#include "base/exported.hpp"

namespace hypotrack::shaders {
inline namespace HYPOTRACK_EXPORTED internal {

/// Vertex shader, world to clip space; row 0 of the framebuffer is the image's top row.
inline constexpr const char* kSceneVertex = R"(#version 330 core
layout(location = 0) in vec3 position;  // world, metres
layout(location = 1) in vec3 normal;    // world
layout(location = 2) in vec2 uv;        // v downwards, as images are stored
uniform mat4 clip_from_camera;
uniform mat4 camera_from_world;
out vec3 world_position;
out vec3 world_normal;
centroid out vec2 texture_uv;
out float camera_z;
void main() {
  vec4 in_camera = camera_from_world * vec4(position, 1.0);
  world_position = position;
  world_normal = normal;
  texture_uv = uv;
  camera_z = in_camera.z;
  gl_Position = clip_from_camera * in_camera;
}
)";

/// Fragment shader with ambient, Lambert and Blinn-Phong terms of one distant light. Colours are
/// used as stored, so that ambient 1 alone gives the texture's own values.
inline constexpr const char* kColorFragment = R"(#version 330 core
in vec3 world_position;
in vec3 world_normal;
centroid in vec2 texture_uv;
uniform sampler2D surface;
uniform bool textured;
uniform vec3 flat_color;
uniform vec3 camera_center;
uniform vec3 to_light;
uniform float ambient;
uniform float diffuse;
uniform float specular;
uniform float shininess;
out vec4 color;
void main() {
  vec3 base = textured ? texture(surface, texture_uv).rgb : flat_color;
  vec3 to_camera = normalize(camera_center - world_position);
  vec3 n = normalize(world_normal);
  if (dot(n, to_camera) < 0.0) n = -n;  // the inside of an open surface
  float lambert = max(dot(n, to_light), 0.0);
  float highlight = 0.0;
  if (specular > 0.0 && lambert > 0.0) {
    highlight = specular * pow(max(dot(n, normalize(to_light + to_camera)), 0.0), shininess);
  }
  color = vec4(clamp(base * (ambient + diffuse * lambert) + highlight, 0.0, 1.0), 1.0);
}
)";

inline constexpr const char* kGeometryFragment = R"(#version 330 core
in float camera_z;
uniform uint model_label;
layout(location = 0) out float depth;
layout(location = 1) out uint label;
void main() {
  depth = camera_z;
  label = model_label;
}
)";

}  // namespace internal
}  // namespace hypotrack::shaders
