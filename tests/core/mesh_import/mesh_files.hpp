#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/model.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A node of a GLB's skeleton: its parent (-1: none) and where it stands in it.
struct GlbBone {
  std::string name;
  int parent = -1;
  std::array<float, 3> translation{};
  std::array<float, 3> scale{1, 1, 1};
};

/// What glb() writes: by default a tetrahedron held by two bones, `root` at the origin and `tip` at
/// (0, 1, 0).
struct GlbContent {
  std::vector<std::array<float, 3>> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<std::uint16_t> indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::vector<std::array<std::uint8_t, 4>> joints = {{0}, {0}, {1}, {0, 1}};
  std::vector<std::array<float, 4>> weights = {
      {1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0.25f, 0.75f, 0, 0}};
  std::vector<GlbBone> bones = {{"root", -1, {0, 0, 0}}, {"tip", 0, {0, 1, 0}}};
  std::vector<std::array<float, 2>> uvs;  ///< glTF's: v downwards
  std::vector<std::array<float, 3>> colors;
  std::array<float, 4> base_color{1, 1, 1, 1};  ///< of the material, without an image
  std::string image;                            ///< PNG or JPEG to embed
  std::string image_uri;                        ///< or an image beside the file
};

std::string glb(const GlbContent& content);

/// A tetrahedron.
std::string obj();
std::string binary_stl();
std::string ply();
/// The same with the colours 150 100 100, 100 150 100, 100 100 150 and 120 120 120.
std::string colored_ply();
std::string binary_ply();

std::filesystem::path write_file(const std::filesystem::path& path, std::string_view bytes);

/// Looks a texture up between its texels, as OpenGL does. Returns RGB in [0, 1].
Eigen::Vector3f look_up(const Mesh& mesh, const Eigen::Vector2f& uv);

/// Returns the colour that a mesh has at a point of its surface, RGB from 0 to 255.
Eigen::Vector3f surface_color(const Mesh& mesh, const Eigen::Vector3f& point);

/// The message of the DataError that importing a file ends in; fails the test if there is none.
std::string import_error(const std::filesystem::path& path);

}  // namespace hypotrack::test
