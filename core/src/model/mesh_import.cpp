#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "hypotrack/error.hpp"
#include "hypotrack/mesh_io.hpp"
#include "model/mesh_import_format.hpp"
#include "model/mesh_import_process.hpp"
#include "model/mesh_import_texture.hpp"
#include "model/mesh_import_weld.hpp"
#include "model/mesh_import_wire.hpp"

namespace hypotrack {
namespace {

using mesh_wire::MeshPart;

constexpr std::size_t kMostVertices = 10'000'000;
constexpr double kWeightSumTolerance = 0.02;  // weights stored as bytes are off by up to 4 / 255

/// All parts of a file one after the other, as they came.
struct Soup {
  Eigen::Matrix3Xf points;
  Eigen::Matrix3Xi triangles;
  std::vector<Eigen::Vector2f> uvs;                 // empty or one per point
  std::vector<std::vector<BoneWeight>> influences;  // one list per point; empty for a rigid mesh
};

class Importer {
 public:
  Importer(const std::filesystem::path& file, const MeshImportOptions& options)
      : file_(file), options_(options) {}

  ImportedMesh run() {
    check_mesh_format(file_);
    try {
      scene_ = mesh_wire::decode(run_mesh_reader(default_mesh_reader(file_), file_));
    } catch (const std::runtime_error& error) {
      if (dynamic_cast<const Error*>(&error)) throw;
      fail(fmt::format("the mesh could not be read: {}", error.what()));
    }
    if (!scene_.error.empty()) fail("the mesh could not be read: " + scene_.error);
    ImportedMesh imported;
    imported.bones = convert_bones();
    join_parts();
    fill_mesh(imported.mesh);
    fill_appearance(imported.mesh);
    return imported;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(file_.string() + ": " + what);
  }

  std::vector<ImportedBone> convert_bones() const {
    std::vector<ImportedBone> bones;
    std::set<std::string> names;
    for (const mesh_wire::BoneNode& node : scene_.bones) {
      if (!names.insert(node.name).second) fail(fmt::format("two bones are named '{}'", node.name));
      bones.push_back({node.name, node.parent, bone_transform(node)});
    }
    return bones;
  }

  /// The bone's bind transform without its scale, which rigs of glTF exporters carry.
  Eigen::Isometry3d bone_transform(const mesh_wire::BoneNode& node) const {
    using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    const Rows matrix = Eigen::Map<const Rows>(node.file_from_bone.data());
    const Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
    const double scale = std::cbrt(axes.determinant());
    if (!matrix.allFinite() || !(scale > 1e-9)) {
      fail(fmt::format("the bind transform of bone '{}' is no rigid motion: NaN, flat or mirrored",
                       node.name));
    }
    const Eigen::Matrix3d rotation = axes / scale;
    if ((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() >
        5e-3) {
      fail(
          fmt::format("bone '{}' is scaled unevenly or sheared at the bind pose; apply the scale "
                      "in the program that made the file and export it again",
                      node.name));
    }
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    transform.translation() = options_.scale * matrix.topRightCorner<3, 1>();
    return transform;
  }

  void check_part(const MeshPart& part) const {
    const std::size_t count = part.positions.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto& p = part.positions[i];
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
        fail(fmt::format("vertex {} of mesh '{}' is ({}, {}, {}): every coordinate must be finite",
                         i, part.name, p[0], p[1], p[2]));
      }
    }
    for (std::size_t i = 0; i < part.triangles.size(); ++i) {
      for (const std::uint32_t corner : part.triangles[i]) {
        if (corner >= count) {
          fail(fmt::format("triangle {} of mesh '{}' names vertex {}, but there are {}", i,
                           part.name, corner, count));
        }
      }
    }
    for (const auto& uv : part.uvs) {
      if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
        fail(fmt::format("mesh '{}' has a texture coordinate ({}, {}): it must be finite",
                         part.name, uv[0], uv[1]));
      }
    }
    if (!part.uvs.empty() && part.uvs.size() != count) {
      fail(fmt::format("mesh '{}' has {} texture coordinates for {} vertices", part.name,
                       part.uvs.size(), count));
    }
    for (const mesh_wire::Weight& weight : part.weights) {
      if (weight.vertex >= count || weight.bone >= scene_.bones.size()) {
        fail(fmt::format("a weight of mesh '{}' names vertex {} of {} and bone {} of {}", part.name,
                         weight.vertex, count, weight.bone, scene_.bones.size()));
      }
      if (!(weight.value >= 0) || !std::isfinite(weight.value)) {
        fail(
            fmt::format("vertex {} of mesh '{}' has the weight {} on bone '{}': weights must be "
                        "finite and not negative",
                        weight.vertex, part.name, weight.value, scene_.bones[weight.bone].name));
      }
    }
  }

  void join_parts() {
    std::size_t points = 0;
    std::size_t triangles = 0;
    bool has_uvs = true;
    for (const MeshPart& part : scene_.meshes) {
      check_part(part);
      points += part.positions.size();
      triangles += part.triangles.size();
      has_uvs = has_uvs && (!part.uvs.empty() || part.triangles.empty());
    }
    if (triangles == 0) fail("the mesh has no faces");
    if (points > kMostVertices || triangles > kMostVertices) {
      fail(
          fmt::format("the mesh has {} vertices and {} triangles: decimate it", points, triangles));
    }
    soup_.points.resize(3, static_cast<Eigen::Index>(points));
    soup_.triangles.resize(3, static_cast<Eigen::Index>(triangles));
    if (has_uvs) soup_.uvs.resize(points);
    if (!scene_.bones.empty()) soup_.influences.resize(points);
    Eigen::Index point = 0;
    Eigen::Index triangle = 0;
    for (const MeshPart& part : scene_.meshes) {
      join_part(part, has_uvs, point, triangle);
      point += static_cast<Eigen::Index>(part.positions.size());
      triangle += static_cast<Eigen::Index>(part.triangles.size());
    }
  }

  void join_part(const MeshPart& part, bool has_uvs, Eigen::Index point, Eigen::Index triangle) {
    const auto first = static_cast<std::size_t>(point);
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
      soup_.points.col(point + static_cast<Eigen::Index>(i)) =
          static_cast<float>(options_.scale) *
          Eigen::Map<const Eigen::Vector3f>(part.positions[i].data());
      if (has_uvs && !part.uvs.empty()) {
        soup_.uvs[first + i] = Eigen::Map<const Eigen::Vector2f>(part.uvs[i].data());
      }
    }
    for (const auto& corners : part.triangles) {
      for (int k = 0; k < 3; ++k) {
        soup_.triangles(k, triangle) =
            static_cast<int>(point) + static_cast<int>(corners[static_cast<std::size_t>(k)]);
      }
      ++triangle;
    }
    if (scene_.bones.empty()) return;
    for (const mesh_wire::Weight& weight : part.weights) {
      soup_.influences[first + weight.vertex].push_back(
          {static_cast<int>(weight.bone), weight.value});
    }
    check_weight_sums(part, first);
  }

  /// The importer passes over negative, NaN and misdirected weights: their vertices lack something.
  void check_weight_sums(const MeshPart& part, std::size_t first) {
    std::vector<bool> used(part.positions.size());
    for (const auto& corners : part.triangles) {
      for (const std::uint32_t corner : corners) used[corner] = true;
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      double sum = 0;
      for (const BoneWeight& influence : soup_.influences[first + i]) {
        sum += static_cast<double>(influence.weight);
      }
      if (sum <= 0) {
        fail(
            fmt::format("no bone holds vertex {} of mesh '{}' (weights that are NaN, zero, "
                        "negative or of unknown bones count as none)",
                        i, part.name));
      }
      if (std::abs(sum - 1) > kWeightSumTolerance) {
        fail(
            fmt::format("the weights of vertex {} of mesh '{}' sum to {:.3g} instead of 1 (those "
                        "that are NaN, negative or of unknown bones count as none)",
                        i, part.name, sum));
      }
    }
  }

  void fill_mesh(Mesh& mesh) {
    const std::vector<int> same = weld_points(soup_.points);
    std::vector<int> kept;  // triangles with three different corners and an area
    std::vector<int> index(same.size(), -1);
    std::vector<int> vertices;
    for (int t = 0; t < soup_.triangles.cols(); ++t) {
      const Eigen::Vector3i corners = soup_.triangles.col(t).unaryExpr(
          [&](int corner) { return same[static_cast<std::size_t>(corner)]; });
      if (is_degenerate(corners)) continue;
      kept.push_back(t);
      for (const int corner : corners) {
        int& entry = index[static_cast<std::size_t>(corner)];
        if (entry >= 0) continue;
        entry = static_cast<int>(vertices.size());
        vertices.push_back(corner);
      }
    }
    if (kept.empty()) fail("the mesh has no faces: all its triangles are degenerate");
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      mesh.vertices.col(static_cast<Eigen::Index>(i)) = soup_.points.col(vertices[i]);
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t t = 0; t < kept.size(); ++t) {
      mesh.triangles.col(static_cast<Eigen::Index>(t)) =
          soup_.triangles.col(kept[t]).unaryExpr([&](int corner) {
            return index[static_cast<std::size_t>(same[static_cast<std::size_t>(corner)])];
          });
    }
    fill_weights(mesh, same, index);
    if (!soup_.uvs.empty()) fill_uvs(mesh, kept);
  }

  bool is_degenerate(const Eigen::Vector3i& corners) const {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) {
      return true;
    }
    const Eigen::Vector3d a = soup_.points.col(corners[0]).cast<double>();
    const Eigen::Vector3d b = soup_.points.col(corners[1]).cast<double>();
    const Eigen::Vector3d c = soup_.points.col(corners[2]).cast<double>();
    return (b - a).cross(c - a).norm() == 0;
  }

  /// A welded vertex has the mean influences of its copies.
  void fill_weights(Mesh& mesh, const std::vector<int>& same, const std::vector<int>& index) {
    const Eigen::Index count = mesh.vertices.cols();
    if (scene_.bones.empty()) {
      mesh.bone_indices.resize(4, 0);
      mesh.bone_weights.resize(4, 0);
      return;
    }
    std::vector<std::vector<BoneWeight>> merged(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < same.size(); ++i) {
      const int vertex = index[static_cast<std::size_t>(same[i])];
      if (vertex < 0) continue;
      auto& all = merged[static_cast<std::size_t>(vertex)];
      all.insert(all.end(), soup_.influences[i].begin(), soup_.influences[i].end());
    }
    mesh.bone_indices.setZero(4, count);
    mesh.bone_weights.setZero(4, count);
    for (Eigen::Index v = 0; v < count; ++v) {
      const auto strongest = strongest_influences(merged[static_cast<std::size_t>(v)]);
      for (std::size_t k = 0; k < strongest.size(); ++k) {
        mesh.bone_indices(static_cast<Eigen::Index>(k), v) = strongest[k].bone;
        mesh.bone_weights(static_cast<Eigen::Index>(k), v) = strongest[k].weight;
      }
    }
  }

  /// Texture coordinates outside [0, 1] mean a repeated image. A triangle within one repetition
  /// moves to the first; one that spans several is clamped.
  void fill_uvs(Mesh& mesh, const std::vector<int>& kept) const {
    std::map<std::pair<float, float>, int> known;
    std::vector<Eigen::Vector2f> uvs;
    mesh.uv_triangles.resize(3, mesh.triangles.cols());
    for (std::size_t t = 0; t < kept.size(); ++t) {
      Eigen::Matrix<float, 2, 3> corners;
      for (int k = 0; k < 3; ++k) {
        corners.col(k) = soup_.uvs[static_cast<std::size_t>(soup_.triangles(k, kept[t]))];
      }
      const Eigen::Vector2f low = corners.rowwise().minCoeff();
      const Eigen::Vector2f high = corners.rowwise().maxCoeff();
      for (int axis = 0; axis < 2; ++axis) {
        if (low[axis] < -1e-4f || high[axis] > 1 + 1e-4f) {
          corners.row(axis).array() -= std::floor(low[axis]);
        }
      }
      corners = corners.cwiseMax(0.0f).cwiseMin(1.0f);
      for (int k = 0; k < 3; ++k) {
        const auto [entry, is_new] =
            known.emplace(std::pair(corners(0, k), corners(1, k)), static_cast<int>(uvs.size()));
        if (is_new) uvs.push_back(corners.col(k));
        mesh.uv_triangles(k, static_cast<Eigen::Index>(t)) = entry->second;
      }
    }
    mesh.uv.resize(2, static_cast<Eigen::Index>(uvs.size()));
    for (std::size_t i = 0; i < uvs.size(); ++i) {
      mesh.uv.col(static_cast<Eigen::Index>(i)) = uvs[i];
    }
  }

  void fill_appearance(Mesh& mesh) const {
    std::set<std::string> textures;
    std::size_t most = 0;
    for (const MeshPart& part : scene_.meshes) {
      if (part.triangles.empty() || part.material >= scene_.materials.size()) continue;
      const mesh_wire::Material& material = scene_.materials[part.material];
      textures.insert(material.texture);
      if (part.triangles.size() <= most) continue;
      most = part.triangles.size();
      const Eigen::Map<const Eigen::Vector3f> color(material.color.data());
      if (color.allFinite()) mesh.color = color.cwiseMax(0.0f).cwiseMin(1.0f);
    }
    const bool own = options_.texture.empty();
    if (own && (textures.empty() || *textures.rbegin() == "")) {
      mesh.uv.resize(2, 0);
      mesh.uv_triangles.resize(3, 0);
      return;
    }
    if (own && textures.size() > 1) {
      fail(
          fmt::format("the mesh has {} different textures or textures on some faces only; "
                      "hypotrack draws one: bake them into one image, or name one with `texture`",
                      textures.size()));
    }
    if (mesh.uv.cols() == 0) {
      fail("there is a texture, but not every part of the mesh has texture coordinates");
    }
    mesh.texture = own ? load_texture(scene_, *textures.begin(), file_)
                       : read_texture(options_.texture, file_.string());
  }

  std::filesystem::path file_;
  MeshImportOptions options_;
  mesh_wire::Scene scene_;
  Soup soup_;
};

}  // namespace

ImportedMesh import_mesh(const std::filesystem::path& file, const MeshImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw DataError(fmt::format("{}: the scale of a mesh must be positive, not {}", file.string(),
                                options.scale));
  }
  return Importer(file, options).run();
}

}  // namespace hypotrack
