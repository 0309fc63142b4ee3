#include <cmath>
#include <map>
#include <string>

#include "hypotrack/texture_atlas.hpp"
#include "model/import/steps.hpp"
#include "model/import/texture.hpp"

namespace hypotrack::internal {
namespace {

using mesh_wire::MeshPart;

/// The pictures and colours of a file's materials in one texture.
class Materials {
 public:
  explicit Materials(const MeshFile& file) : file_(file) {
    for (const MeshPart& part : file.scene.meshes) {
      if (!part.triangles.empty() && !places_.contains(part.material)) add(part);
    }
  }

  cv::Mat texture() { return atlas_.texture(file_.path.string()); }

  /// Returns the texture coordinates of a part's triangle; `own` are those within its picture.
  Eigen::Matrix2Xf corners(const MeshPart& part, const Eigen::Matrix<float, 2, 3>& own) const {
    const Place& place = places_.at(part.material);
    if (!place.has_picture)
      return atlas_.moved(place.index, Eigen::Matrix2Xf::Constant(2, 3, 0.5f));
    if (part.uvs.empty()) file_.fail("a part with a texture has no texture coordinates");
    return atlas_.moved(place.index, own);
  }

 private:
  struct Place {
    std::size_t index;
    bool has_picture;
  };

  void add(const MeshPart& part) {
    const auto& all = file_.scene.materials;
    const std::string picture = part.material < all.size() ? all[part.material].texture : "";
    if (!picture.empty()) {
      places_[part.material] = {atlas_.add(load_texture(file_.scene, picture, file_.path)), true};
      return;
    }
    const Eigen::Vector3f color = material_color(file_, part);
    places_[part.material] = {atlas_.add(color.allFinite() ? color : Mesh().color), false};
  }

  const MeshFile& file_;
  TextureAtlas atlas_;
  std::map<std::uint32_t, Place> places_;  // by the number of the material
};

}  // namespace

Eigen::Vector3f material_color(const MeshFile& file, const MeshPart& part) {
  if (part.material >= file.scene.materials.size()) return Eigen::Vector3f::Constant(NAN);
  const Eigen::Vector3f color(file.scene.materials[part.material].color.data());
  if (!color.allFinite()) return Eigen::Vector3f::Constant(NAN);
  return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

void fill_materials(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
                    Mesh& mesh) {
  Materials materials(file);
  mesh.texture = materials.texture();
  const auto count = static_cast<Eigen::Index>(kept.size());
  mesh.uv.resize(2, 3 * count);
  mesh.uv_triangles.resize(3, count);
  for (Eigen::Index t = 0; t < count; ++t) {
    const int triangle = kept[static_cast<std::size_t>(t)];
    const MeshPart& part = file.scene.meshes[soup.parts[static_cast<std::size_t>(triangle)]];
    mesh.uv.middleCols<3>(3 * t) = materials.corners(part, corners_in_image(soup, triangle));
    mesh.uv_triangles.col(t) << static_cast<int>(3 * t), static_cast<int>(3 * t + 1),
        static_cast<int>(3 * t + 2);
  }
}

}  // namespace hypotrack::internal
