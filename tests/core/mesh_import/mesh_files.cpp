#include "mesh_files.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <fstream>
#include <opencv2/core.hpp>

#include "glb_writer.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"

namespace hypotrack::test {
namespace {

/// Nodes 0 .. n-1 are the bones, node n carries the mesh.
void add_skeleton(GlbWriter& writer, const GlbContent& content) {
  Json& json = writer.json();
  std::vector<std::array<float, 16>> inverse_binds;
  std::vector<int> joints;
  Json roots = Json::array();
  for (std::size_t i = 0; i < content.bones.size(); ++i) {
    const GlbBone& bone = content.bones[i];
    Json node = {{"name", bone.name}, {"translation", bone.translation}, {"scale", bone.scale}};
    for (std::size_t k = 0; k < content.bones.size(); ++k) {
      if (content.bones[k].parent == static_cast<int>(i)) node["children"].push_back(k);
    }
    if (bone.parent < 0) roots.push_back(i);
    json["nodes"].push_back(node);
    joints.push_back(static_cast<int>(i));
    std::array<float, 3> at{};
    std::array<float, 3> scale{1, 1, 1};
    for (int b = static_cast<int>(i); b >= 0;
         b = content.bones[static_cast<std::size_t>(b)].parent) {
      const GlbBone& above = content.bones[static_cast<std::size_t>(b)];
      for (std::size_t c = 0; c < 3; ++c) {
        at[c] = above.translation[c] + above.scale[c] * at[c];
        scale[c] *= above.scale[c];
      }
    }
    std::array<float, 16> inverse{};
    for (std::size_t c = 0; c < 3; ++c) {
      inverse[5 * c] = 1 / scale[c];
      inverse[12 + c] = -at[c] / scale[c];
    }
    inverse[15] = 1;
    inverse_binds.push_back(inverse);
  }
  const int accessor = writer.add(inverse_binds, "MAT4", kFloat);
  json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", accessor}}};
  json["nodes"].push_back({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
  roots.push_back(content.bones.size());
  json["scenes"] = {{{"nodes", roots}}};
}

void add_texture(GlbWriter& writer, const GlbContent& content) {
  Json& json = writer.json();
  Json image;
  if (content.image.empty()) {
    image["uri"] = content.image_uri;
  } else {
    image["bufferView"] = writer.add_view(content.image.data(), content.image.size());
    image["mimeType"] = "image/png";
  }
  json["images"] = {image};
  json["textures"] = {{{"source", 0}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
}

}  // namespace

std::string glb(const GlbContent& content) {
  GlbWriter writer;
  Json& json = writer.json();
  Json attributes;
  attributes["POSITION"] = writer.add(content.positions, "VEC3", kFloat);
  if (!content.joints.empty()) {
    attributes["JOINTS_0"] = writer.add(content.joints, "VEC4", kUnsignedByte);
    attributes["WEIGHTS_0"] = writer.add(content.weights, "VEC4", kFloat);
  }
  if (!content.uvs.empty()) attributes["TEXCOORD_0"] = writer.add(content.uvs, "VEC2", kFloat);
  if (!content.colors.empty()) attributes["COLOR_0"] = writer.add(content.colors, "VEC3", kFloat);
  Json primitive = {{"attributes", attributes},
                    {"indices", writer.add(content.indices, "SCALAR", kUnsignedShort)}};
  if (!content.image.empty() || !content.image_uri.empty()) {
    add_texture(writer, content);
    primitive["material"] = 0;
  } else if (!content.colors.empty()) {
    json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", content.base_color}}}}};
    primitive["material"] = 0;
  }
  json["meshes"] = {{{"name", "body"}, {"primitives", {primitive}}}};
  if (content.bones.empty()) {
    json["nodes"] = {{{"name", "body"}, {"mesh", 0}}};
    json["scenes"] = {{{"nodes", {0}}}};
  } else {
    add_skeleton(writer, content);
  }
  json["scene"] = 0;
  return writer.finish();
}

std::string obj() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

std::string binary_stl() {
  const std::vector<std::array<std::array<float, 3>, 3>> faces = {
      {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
      {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
      {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
      {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  std::string file(80, ' ');
  const auto count = static_cast<std::uint32_t>(faces.size());
  file.append(reinterpret_cast<const char*>(&count), sizeof(count));
  for (const auto& face : faces) {
    file.append(12, '\0');  // normal
    file.append(reinterpret_cast<const char*>(&face), sizeof(face));
    file.append(2, '\0');
  }
  return file;
}

std::string ply() {
  return "ply\nformat ascii 1.0\ncomment made up\nelement vertex 4\nproperty float x\n"
         "property float y\nproperty float z\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

std::string colored_ply() {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 150 100 100\n1 0 0 100 150 100\n0 1 0 100 100 150\n0 0 1 120 120 120\n"
         "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

std::string binary_ply() {
  std::string file =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::array<std::array<float, 3>, 4> vertices = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<std::array<std::int32_t, 3>, 4> faces = {
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  for (const auto& vertex : vertices) {
    file.append(reinterpret_cast<const char*>(&vertex), sizeof(vertex));
    file.append(1, '\x80');
  }
  for (const auto& face : faces) {
    file.append(1, '\3');
    file.append(reinterpret_cast<const char*>(&face), sizeof(face));
  }
  return file;
}

std::filesystem::path write_file(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
  return path;
}

Eigen::Vector3f look_up(const Mesh& mesh, const Eigen::Vector2f& uv) {
  const float x = uv.x() * static_cast<float>(mesh.texture.cols) - 0.5f;
  const float y = (1 - uv.y()) * static_cast<float>(mesh.texture.rows) - 0.5f;
  const int x0 =
      std::min(static_cast<int>(std::lround(std::floor(x + 1e-4f))), mesh.texture.cols - 2);
  const int y0 =
      std::min(static_cast<int>(std::lround(std::floor(y + 1e-4f))), mesh.texture.rows - 2);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto texel = [&](int column, int row) {
    const auto& bgr = mesh.texture.at<cv::Vec3b>(row, column);
    return Eigen::Vector3f(Eigen::Vector3f(bgr[2], bgr[1], bgr[0]) / 255.0f);
  };
  return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
         fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

Eigen::Vector3f surface_color(const Mesh& mesh, const Eigen::Vector3f& point) {
  if (mesh.texture.empty()) return 255 * mesh.color;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3f corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
    // Least squares, because a plane through the origin has corners of rank 2.
    Eigen::Matrix<float, 4, 3> equations;
    equations << corners, Eigen::RowVector3f::Ones();
    const Eigen::Vector3f share =
        equations.colPivHouseholderQr().solve(Eigen::Vector4f(point[0], point[1], point[2], 1));
    const bool inside = share.minCoeff() > -1e-4f && (corners * share - point).norm() < 1e-4f;
    if (inside) return 255 * look_up(mesh, mesh.uv(Eigen::all, mesh.uv_triangles.col(t)) * share);
  }
  ADD_FAILURE() << "no triangle has the point " << point.transpose();
  return Eigen::Vector3f::Constant(NAN);
}

std::string import_error(const std::filesystem::path& path) {
  try {
    import_mesh(path);
  } catch (const DataError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was read without an error";
  return {};
}

}  // namespace hypotrack::test
