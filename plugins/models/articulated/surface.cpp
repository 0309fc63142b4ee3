#include "surface.hpp"

#include <optional>

#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::articulated {
namespace {

bool has_texture(const Mesh& mesh) { return !mesh.texture.empty(); }

/// Returns the colour of all parts, if none has a texture and they have the same.
std::optional<Eigen::Vector3f> one_color(const std::vector<Part>& parts) {
  for (const Part& part : parts)
    if (has_texture(part.mesh) || part.mesh.color != parts.front().mesh.color) return {};
  return parts.front().mesh.color;
}

/// Appends the columns of one matrix to those of another.
template <class Matrix>
void append(Matrix& to, const Matrix& more) {
  const Eigen::Index first = to.cols();
  to.conservativeResize(Eigen::NoChange, first + more.cols());
  to.rightCols(more.cols()) = more;
}

void append_surface(const Part& part, const LinkPlace& place,
                    const Eigen::Isometry3d& model_from_bone, Mesh& mesh) {
  const auto first = static_cast<int>(mesh.vertices.cols());
  const Eigen::Isometry3f model_from_link = (model_from_bone * place.bone_from_link).cast<float>();
  append(mesh.vertices, Eigen::Matrix3Xf(model_from_link * part.mesh.vertices));
  append(mesh.triangles, Eigen::Matrix3Xi(part.mesh.triangles.array() + first));
  const Eigen::Index count = part.mesh.vertices.cols();
  Eigen::Matrix4Xi bones = Eigen::Matrix4Xi::Zero(4, count);
  bones.row(0).setConstant(place.bone);
  append(mesh.bone_indices, bones);
  Eigen::Matrix4Xf weights = Eigen::Matrix4Xf::Zero(4, count);
  weights.row(0).setOnes();
  append(mesh.bone_weights, weights);
}

/// Appends a part's texture coordinates, moved to its place; without a texture all corners are in
/// the middle of its colour.
void append_uvs(const Mesh& part, const TextureAtlas& atlas, std::size_t place, Mesh& mesh) {
  const auto first = static_cast<int>(mesh.uv.cols());
  const Eigen::Matrix2Xf own = has_texture(part) ? part.uv : Eigen::Matrix2Xf::Constant(2, 1, 0.5f);
  append(mesh.uv, atlas.moved(place, own));
  append(mesh.uv_triangles,
         Eigen::Matrix3Xi(has_texture(part)
                              ? Eigen::Matrix3Xi(part.uv_triangles.array() + first)
                              : Eigen::Matrix3Xi::Constant(3, part.triangles.cols(), first)));
}

}  // namespace

Mesh join(const std::vector<Part>& parts, const Assembly& assembly, const std::string& where) {
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(assembly.data);
  Mesh mesh;
  for (const Part& part : parts) {
    const LinkPlace& place = assembly.links[part.link];
    append_surface(part, place, bind[static_cast<std::size_t>(place.bone)], mesh);
  }
  if (const auto color = one_color(parts)) {
    mesh.color = *color;
    return mesh;
  }
  TextureAtlas atlas;
  std::vector<std::size_t> places;
  for (const Part& part : parts)
    places.push_back(has_texture(part.mesh) ? atlas.add(part.mesh.texture)
                                            : atlas.add(part.mesh.color));
  mesh.texture = atlas.texture(where);
  for (std::size_t i = 0; i < parts.size(); ++i) append_uvs(parts[i].mesh, atlas, places[i], mesh);
  return mesh;
}

}  // namespace hypotrack::articulated
