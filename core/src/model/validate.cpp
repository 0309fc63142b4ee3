#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "config/yaml_text.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
namespace {

constexpr double kTolerance = 1e-4;  // of weight sums, unit axes and rotation matrices

/// Returns a text without control characters, for messages.
std::string without_controls(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::iscntrl(c); }, ' ');
  return text;
}

// Validates one model; every message begins with where the model came from.
class Validator {
 public:
  Validator(const ModelData& data, std::string_view where) : data_(data), where_(where) {}

  void run() const {
    check_bones();
    check_surface(data_.mesh);
    if (data_.simplified.triangles.cols() > 0) check_surface(data_.simplified);
    check_texture();
    check_parameters();
    check_motions();
    check_landmarks();
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw DataError(std::string(where_) + ": " + fmt::format(format, std::forward<Args>(args)...));
  }

  template <class Items>
  void check_names(const Items& items, std::string_view kind) const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].name.empty()) fail("{} {} has no name", kind, i);
      if (!seen.insert(items[i].name).second) {
        fail("two {}s are called '{}': names must be unique", kind, items[i].name);
      }
    }
  }

  /// Checks names that become columns in the tables of a run.
  template <class Items>
  void check_column_names(const Items& items, std::string_view kind) const {
    check_names(items, kind);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!detail::is_text(items[i].name))
        fail("the name of {} {} is no UTF-8: write the file in UTF-8", kind, i);
      const bool fits = std::ranges::none_of(
          items[i].name, [](unsigned char c) { return c == ',' || c == '"' || std::iscntrl(c); });
      if (fits) continue;
      fail(
          "the name of {} {} '{}' may not contain commas, quotes or control characters: it is "
          "written into the headers of CSV tables",
          kind, i, without_controls(items[i].name));
    }
  }

  void check_bone_index(int bone, const std::string& user) const {
    if (bone >= 0 && bone < static_cast<int>(data_.bones.size())) return;
    fail("{} refers to bone {}, expected 0 to {}", user, bone, data_.bones.size() - 1);
  }

  void check_bones() const;
  void check_surface(const Mesh& mesh) const {
    check_geometry(mesh);
    check_weights(mesh);
  }
  void check_geometry(const Mesh& mesh) const;
  void check_weights(const Mesh& mesh) const;
  void check_texture() const;
  void check_parameters() const;
  void check_bounds(const Parameter& parameter) const;
  void check_motions() const;
  void check_landmarks() const;

  const ModelData& data_;
  std::string_view where_;
};

void Validator::check_bones() const {
  if (data_.bones.empty()) fail("the model has no bones; a rigid object has one");
  check_names(data_.bones, "bone");
  for (std::size_t i = 0; i < data_.bones.size(); ++i) {
    const Bone& bone = data_.bones[i];
    if (bone.parent < -1 || bone.parent >= static_cast<int>(i)) {
      fail("bone '{}' ({}) has parent {}: parents must come before their children (-1: none)",
           bone.name, i, bone.parent);
    }
    const Eigen::Matrix4d matrix = bone.parent_from_bone.matrix();
    if (!matrix.allFinite()) fail("bone '{}' has a transform with NaN or infinity", bone.name);
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    if (!(rotation * rotation.transpose()).isIdentity(kTolerance) || rotation.determinant() < 0) {
      fail(
          "the transform of bone '{}' is no rotation and translation: scale, shear and mirrors "
          "belong into the vertices",
          bone.name);
    }
  }
}

void Validator::check_geometry(const Mesh& mesh) const {
  const Eigen::Index vertices = mesh.vertices.cols();
  if (mesh.triangles.cols() == 0) fail("the mesh has no faces");
  for (Eigen::Index v = 0; v < vertices; ++v) {
    if (!mesh.vertices.col(v).allFinite()) fail("vertex {} has NaN or infinite coordinates", v);
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (const int v : mesh.triangles.col(t)) {
      if (v < 0 || v >= vertices) {
        fail("triangle {} refers to vertex {}, but the mesh has {} vertices", t, v, vertices);
      }
    }
  }
}

void Validator::check_weights(const Mesh& mesh) const {
  const Eigen::Index vertices = mesh.vertices.cols();
  if (mesh.bone_weights.cols() != vertices || mesh.bone_indices.cols() != vertices) {
    fail("the mesh has {} vertices but bone weights for {} and bone indices for {}", vertices,
         mesh.bone_weights.cols(), mesh.bone_indices.cols());
  }
  for (Eigen::Index v = 0; v < vertices; ++v) {
    for (const int bone : mesh.bone_indices.col(v))
      check_bone_index(bone, fmt::format("vertex {}", v));
    const auto weights = mesh.bone_weights.col(v);
    if (!weights.allFinite()) fail("vertex {} has a bone weight that is NaN or infinite", v);
    if (weights.minCoeff() < 0) {
      fail("vertex {} has the negative bone weight {}", v, weights.minCoeff());
    }
    if (std::abs(weights.cast<double>().sum() - 1) > kTolerance) {
      fail("the bone weights of vertex {} sum to {}, expected 1", v, weights.cast<double>().sum());
    }
  }
}

void Validator::check_texture() const {
  const Mesh& mesh = data_.mesh;
  if (!mesh.uv.allFinite()) fail("the texture coordinates contain NaN or infinity");
  if (!mesh.color.allFinite()) fail("the colour of the mesh contains NaN or infinity");
  const Eigen::Index triples = mesh.uv_triangles.cols();
  if (triples != 0 && triples != mesh.triangles.cols()) {
    fail("the mesh has {} triangles but texture coordinates for {}", mesh.triangles.cols(),
         triples);
  }
  for (Eigen::Index t = 0; t < triples; ++t) {
    for (const int i : mesh.uv_triangles.col(t)) {
      if (i < 0 || i >= mesh.uv.cols()) {
        fail("triangle {} refers to texture coordinate {}, but there are {}", t, i, mesh.uv.cols());
      }
    }
  }
  if (mesh.texture.empty()) return;
  if (mesh.texture.type() != CV_8UC3) fail("the texture is no 8-bit BGR image");
  if (triples == 0) fail("the mesh has a texture but no texture coordinates");
}

void Validator::check_parameters() const {
  const auto& parameters = data_.parameters;
  if (parameters.size() < 7) {
    fail(
        "the model has {} parameters, but every model begins with 3 of a position and 4 of a "
        "quaternion",
        parameters.size());
  }
  check_column_names(parameters, "parameter");
  for (const auto& parameter : parameters)
    if (parameter.name == "status" || parameter.name == "probability")
      fail("a parameter is called '{}', as a column of track.csv is: give it another name",
           parameter.name);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterKind kind = parameters[i].kind;
    const bool expected = i < 3   ? kind == ParameterKind::position
                          : i < 7 ? kind == ParameterKind::quaternion
                                  : is_joint(kind);
    if (!expected) {
      fail(
          "parameter {} ('{}') is of the wrong kind: a model's parameters are 3 of a position, 4 "
          "of a quaternion, then angles and lengths",
          i, parameters[i].name);
    }
    check_bounds(parameters[i]);
  }
}

void Validator::check_bounds(const Parameter& parameter) const {
  const auto& [name, kind, lower, upper, rest] = parameter;
  if (!(lower <= upper)) {
    fail("parameter '{}' has the lower bound {} and the upper bound {}: the wrong way round or NaN",
         name, lower, upper);
  }
  const bool bounded = std::isfinite(lower) && std::isfinite(upper);
  if (kind == ParameterKind::length && !bounded) {
    fail("parameter '{}' is a length with an infinite bound", name);
  }
  if (kind == ParameterKind::angle && !bounded && !(std::isinf(lower) && std::isinf(upper))) {
    fail("parameter '{}' is an angle with one infinite bound: give both, or none", name);
  }
  if (!std::isfinite(rest) || rest < lower || rest > upper) {
    fail("parameter '{}' has the rest value {}, expected a number from {} to {}", name, rest, lower,
         upper);
  }
}

void Validator::check_motions() const {
  for (std::size_t i = 0; i < data_.motions.size(); ++i) {
    const BoneMotion& motion = data_.motions[i];
    check_bone_index(motion.bone, fmt::format("motion {}", i));
    const int count = static_cast<int>(data_.parameters.size());
    if (motion.parameter < 7 || motion.parameter >= count) {
      fail("motion {} refers to parameter {}, expected a joint (7 to {})", i, motion.parameter,
           count - 1);
    }
    // Negated, so that NaN fails.
    if (!(std::abs(motion.axis.norm() - 1) <= kTolerance)) {
      fail("motion {} has an axis of length {}, expected 1", i, motion.axis.norm());
    }
    if (!std::isfinite(motion.zero) || !std::isfinite(motion.scale)) {
      fail("motion {} has a zero or a scale that is NaN or infinite", i);
    }
  }
}

void Validator::check_landmarks() const {
  check_column_names(data_.landmarks, "landmark");
  for (const Landmark& landmark : data_.landmarks) {
    check_bone_index(landmark.bone, fmt::format("landmark '{}'", landmark.name));
    if (!landmark.position.allFinite()) {
      fail("landmark '{}' has NaN or infinite coordinates", landmark.name);
    }
  }
}

}  // namespace

void validate(const ModelData& data, std::string_view where) { Validator(data, where).run(); }

}  // namespace hypotrack
