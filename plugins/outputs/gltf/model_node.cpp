#include "model_node.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "hypotrack/api/media.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::gltf {
namespace {

/// A mesh as glTF has it: a vertex has one normal and one texture coordinate.
struct DrawnMesh {
  std::vector<int> vertices;             ///< of the model, by vertex of this mesh
  Eigen::Matrix3Xf normals;              ///< unit length, at the bind pose
  Eigen::Matrix2Xf uv;                   ///< v downwards; 2x0 without texture coordinates
  std::vector<std::uint32_t> triangles;  ///< three vertices of this mesh each
};

/// Returns the normal of every face, its length twice the area.
Eigen::Matrix3Xf face_normals(const Mesh& mesh) {
  Eigen::Matrix3Xf normals(3, mesh.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Vector3f a = mesh.vertices.col(mesh.triangles(0, t));
    const Eigen::Vector3f b = mesh.vertices.col(mesh.triangles(1, t));
    const Eigen::Vector3f c = mesh.vertices.col(mesh.triangles(2, t));
    normals.col(t) = (b - a).cross(c - a);
  }
  return normals;
}

/// Normals of face corners.
class CornerNormals {
 public:
  explicit CornerNormals(const Mesh& mesh)
      : faces_(face_normals(mesh)), around_(static_cast<std::size_t>(mesh.vertices.cols())) {
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
      for (const int v : mesh.triangles.col(t)) around_[static_cast<std::size_t>(v)].push_back(t);
  }

  /// Returns the mean of the faces around a vertex that lie about as the given one, by area.
  Eigen::Vector3f at(Eigen::Index face, int vertex) const {
    constexpr double kCrease = std::numbers::pi / 4;
    const auto smooth = static_cast<float>(std::cos(kCrease));
    const Eigen::Vector3f own = faces_.col(face);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Index other : around_[static_cast<std::size_t>(vertex)]) {
      const Eigen::Vector3f normal = faces_.col(other);
      if (normal.dot(own) >= smooth * normal.norm() * own.norm()) sum += normal;
    }
    // A face without area has no normal, but glTF wants one.
    return sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f::UnitZ();
  }

 private:
  Eigen::Matrix3Xf faces_;
  std::vector<std::vector<Eigen::Index>> around_;  ///< faces by vertex
};

/// Splits the vertices of a mesh at texture seams and at edges sharper than 45 degrees.
DrawnMesh drawn_mesh(const Mesh& mesh) {
  const bool has_uv = mesh.uv_triangles.cols() > 0;
  const CornerNormals corner_normals(mesh);
  // Vertex, texture coordinate and normal; corners that have all in common are one vertex.
  std::map<std::pair<std::array<int, 2>, std::array<float, 3>>, std::uint32_t> known;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uv;
  DrawnMesh drawn;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles(k, t), at = has_uv ? mesh.uv_triangles(k, t) : 0;
      const Eigen::Vector3f n = corner_normals.at(t, vertex);
      const auto next = static_cast<std::uint32_t>(drawn.vertices.size());
      const auto [place, added] = known.try_emplace({{vertex, at}, {n.x(), n.y(), n.z()}}, next);
      drawn.triangles.push_back(place->second);
      if (!added) continue;
      drawn.vertices.push_back(vertex);
      normals.push_back(n);
      if (has_uv) uv.emplace_back(mesh.uv(0, at), 1 - mesh.uv(1, at));
    }
  }
  drawn.normals.resize(3, static_cast<Eigen::Index>(normals.size()));
  for (std::size_t i = 0; i < normals.size(); ++i)
    drawn.normals.col(static_cast<Eigen::Index>(i)) = normals[i];
  drawn.uv.resize(2, static_cast<Eigen::Index>(uv.size()));
  for (std::size_t i = 0; i < uv.size(); ++i) drawn.uv.col(static_cast<Eigen::Index>(i)) = uv[i];
  return drawn;
}

Eigen::Vector4f quaternion(const Eigen::Matrix3d& rotation) {
  return Eigen::Quaterniond(rotation).normalized().coeffs().cast<float>();
}

Json list(const Eigen::Ref<const Eigen::VectorXf>& values) {
  return std::vector<float>(values.begin(), values.end());
}

Eigen::MatrixXf columns(const auto& vectors, Eigen::Index rows) {
  Eigen::MatrixXf out(rows, static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = vectors[i];
  return out;
}

/// Decodes a share of sRGB's range (IEC 61966-2-1): glTF wants factors that are linear in light.
float linear(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

std::size_t add_material(GlbFile& file, const Mesh& mesh) {
  constexpr double kSkinRoughness = 0.8;
  Json surface = {{"metallicFactor", 0}, {"roughnessFactor", kSkinRoughness}};
  if (!mesh.texture.empty() && mesh.uv_triangles.cols() > 0) {
    const std::vector<unsigned char> png = encode_image(".png", mesh.texture);
    const std::size_t image =
        file.add("images", {{"mimeType", "image/png"},
                            {"bufferView", file.add_bytes(png.data(), png.size(), Use::other)}});
    surface["baseColorTexture"]["index"] = file.add("textures", {{"source", image}});
  } else {
    surface["baseColorFactor"] = {linear(mesh.color.x()), linear(mesh.color.y()),
                                  linear(mesh.color.z()), 1};
  }
  return file.add("materials", {{"pbrMetallicRoughness", surface}, {"doubleSided", true}});
}

/// Appends a channel and its sampler.
void add_channel(GlbFile& file, Json& animation, std::size_t times, std::size_t node,
                 const char* path, const Eigen::MatrixXf& values) {
  const std::size_t sampler = animation["samplers"].size();
  animation["channels"].push_back(
      {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back({{"input", times},
                                   {"output", file.add_floats(values, Use::other)},
                                   {"interpolation", "LINEAR"}});
}

}  // namespace

/// Takes the one of a rotation's two quaternions that is nearer to the last.
void ModelNode::Moving::add(const Eigen::Isometry3d& pose) {
  Eigen::Vector4f q = quaternion(pose.linear());
  if (!rotations.empty() && q.dot(rotations.back()) < 0) q = -q;
  rotations.push_back(q);
  positions.emplace_back(pose.translation().cast<float>());
}

ModelNode::ModelNode(GlbFile& file, const Scene::Item& item)
    : item_(&item), root_(file.add("nodes", {{"name", item.name}})), pose_{root_} {
  const bool jointed = !item.model->data().motions.empty();
  if (jointed) add_bones(file);
  add_mesh(file, jointed);
}

void ModelNode::add_bones(GlbFile& file) {
  const ModelData& data = item_->model->data();
  for (const Bone& bone : data.bones) {
    const Eigen::Isometry3d& at = bone.parent_from_bone;
    bones_.push_back(file.add("nodes", {{"name", item_->name + "." + bone.name},
                                        {"translation", list(at.translation().cast<float>())},
                                        {"rotation", list(quaternion(at.linear()))}}));
    const std::size_t above =
        bone.parent < 0 ? root_ : bones_[static_cast<std::size_t>(bone.parent)];
    file.at("nodes", above)["children"].push_back(bones_.back());
  }
  std::map<int, bool> slides;  // by jointed bone
  for (const BoneMotion& motion : data.motions)
    slides[motion.bone] |= motion.kind == MotionKind::translation;
  for (const auto& [bone, its] : slides)
    jointed_.push_back({bone, its, {bones_[static_cast<std::size_t>(bone)]}});
}

void ModelNode::add_mesh(GlbFile& file, bool skinned) {
  const Mesh& mesh = item_->model->data().mesh;
  const DrawnMesh drawn = drawn_mesh(mesh);
  const auto of_model = [&](const auto& by_vertex) {
    return by_vertex(Eigen::all, drawn.vertices).eval();
  };
  Json attributes = {{"POSITION", file.add_floats(of_model(mesh.vertices), Use::vertices, true)},
                     {"NORMAL", file.add_floats(drawn.normals, Use::vertices)}};
  if (drawn.uv.cols() > 0) attributes["TEXCOORD_0"] = file.add_floats(drawn.uv, Use::vertices);
  if (skinned) {
    attributes["JOINTS_0"] =
        file.add_joints(of_model(mesh.bone_indices).template cast<std::uint16_t>());
    attributes["WEIGHTS_0"] = file.add_floats(of_model(mesh.bone_weights), Use::vertices);
  }
  const std::size_t index = file.add("meshes", {{"name", item_->name},
                                                {"primitives",
                                                 {{{"attributes", attributes},
                                                   {"indices", file.add_indices(drawn.triangles)},
                                                   {"material", add_material(file, mesh)}}}}});
  if (!skinned) {
    file.at("nodes", root_)["mesh"] = index;
    return;
  }
  // A skin places its mesh, whatever is above the mesh's node: it belongs to the scene itself.
  const std::size_t surface = file.add(
      "nodes", {{"name", item_->name + ".surface"}, {"mesh", index}, {"skin", add_skin(file)}});
  file.at("scenes", 0)["nodes"].push_back(surface);
}

std::size_t ModelNode::add_skin(GlbFile& file) const {
  std::vector<Eigen::Matrix<float, 16, 1>> bone_from_bind;
  for (const Eigen::Isometry3d& bind : bind_transforms(item_->model->data()))
    bone_from_bind.emplace_back(bind.inverse().matrix().cast<float>().reshaped());
  return file.add(
      "skins", {{"joints", bones_},
                {"skeleton", root_},
                {"inverseBindMatrices", file.add_floats(columns(bone_from_bind, 16), Use::other)}});
}

void ModelNode::add(std::span<const double> parameters) {
  const ModelData& data = item_->model->data();
  const Eigen::Isometry3d pose = world_from_model(parameters);
  pose_.add(pose);
  const std::vector<Eigen::Isometry3d> world = world_from_bones(data, parameters);
  for (Jointed& jointed : jointed_) {
    const auto bone = static_cast<std::size_t>(jointed.bone);
    const int parent = data.bones[bone].parent;
    const Eigen::Isometry3d& above = parent < 0 ? pose : world[static_cast<std::size_t>(parent)];
    jointed.moving.add(above.inverse() * world[bone]);
  }
}

void ModelNode::animate(GlbFile& file, Json& animation, std::size_t times) const {
  add_channel(file, animation, times, root_, "translation", columns(pose_.positions, 3));
  add_channel(file, animation, times, root_, "rotation", columns(pose_.rotations, 4));
  for (const Jointed& jointed : jointed_) {
    const Moving& moving = jointed.moving;
    add_channel(file, animation, times, moving.node, "rotation", columns(moving.rotations, 4));
    if (jointed.slides)
      add_channel(file, animation, times, moving.node, "translation", columns(moving.positions, 3));
  }
}

}  // namespace hypotrack::gltf
