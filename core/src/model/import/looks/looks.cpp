#include "model/import/looks/looks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/import/srgb.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

using mesh_wire::Material;
using mesh_wire::MeshPart;

/// Multiplies the light of a picture.
void multiply(cv::Mat3b& image, const Eigen::Vector3f& factor) {
  if (factor == Eigen::Vector3f::Ones()) return;
  std::array<std::array<uchar, 256>, 3> table{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 256; ++i)
      table[c][i] = srgb::byte(
          srgb::encoded(factor[static_cast<Eigen::Index>(2 - c)] * srgb::light_of_bytes()[i]));
  for (cv::Vec3b& bgr : image)
    for (int c = 0; c < 3; ++c) bgr[c] = table[static_cast<std::size_t>(c)][bgr[c]];
}

}  // namespace

Eigen::Vector3f light_factor(const Material& material) {
  const Eigen::Vector3f factor(material.factor.data());
  return factor.unaryExpr([](float c) { return c >= 0 && c <= 1 ? c : 1; });
}

Eigen::Vector3f material_color(const MeshFile& file, const MeshPart& part) {
  if (part.material >= file.scene.materials.size()) return Eigen::Vector3f::Constant(NAN);
  const Eigen::Vector3f color(file.scene.materials[part.material].color.data());
  if (!color.allFinite()) return Eigen::Vector3f::Constant(NAN);
  return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

Looks::Looks(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
             std::vector<std::string>& notes)
    : file_(file), soup_(soup), looks_(file.scene.meshes.size()) {
  std::vector<std::optional<Rgb>> first(looks_.size());
  for (const int triangle : kept) {
    const std::size_t part = part_of(triangle);
    if (!first[part]) first[part] = color_of(triangle, 0);
    for (int k = 0; k < 3; ++k) looks_[part].painted |= color_of(triangle, k) != *first[part];
    ++triangles_[part];
  }
  for (const auto& [part, count] : triangles_) set_look(part, *first[part], notes);
}

const Material* Looks::material_of(const MeshPart& part) const {
  const auto& all = file_.scene.materials;
  return part.material < all.size() ? &all[part.material] : nullptr;
}

void Looks::set_look(std::size_t index, const Rgb& first, std::vector<std::string>& notes) {
  const MeshPart& part = file_.scene.meshes[index];
  Look& look = looks_[index];
  const Material* material = material_of(part);
  const Eigen::Vector3f own(first[0], first[1], first[2]);
  const bool replaced = !file_.options.texture.empty();
  if (replaced || (material && !material->texture.empty())) {
    if (part.uvs.empty())
      file_.fail(fmt::format(
          "there is a texture, but not every part of the mesh has texture coordinates: mesh '{}'{} "
          "has none; unwrap it, or take the picture off its material",
          part.name, material ? fmt::format(" of material '{}'", material->name) : ""));
    if (replaced) look.painted = false;
    const Eigen::Vector3f of_points =
        look.painted ? Eigen::Vector3f::Ones()
                     : (own / 255).unaryExpr([](float c) { return srgb::linear(c); }).eval();
    look.picture = picture_of(material, of_points, notes);
    return;
  }
  if (!part.colors.empty()) {
    look.color = own / 255;
  } else if (const Eigen::Vector3f color = material_color(file_, part); color.allFinite()) {
    look.color = color;
  }
}

/// Returns the index of a material's picture, with its factor and that of the points' colour.
std::size_t Looks::picture_of(const Material* material, const Eigen::Vector3f& of_points,
                              std::vector<std::string>& notes) {
  const bool replaced = !file_.options.texture.empty();
  const Material plain = material ? *material : Material();
  Eigen::Vector3f factor = Eigen::Vector3f::Ones();
  if (!replaced) factor = light_factor(plain).cwiseProduct(of_points);
  const auto [known, is_new] =
      known_.emplace(std::tuple(replaced ? "" : plain.texture, plain.wrap,
                                std::array{factor[0], factor[1], factor[2]}),
                     pictures_.size());
  if (!is_new) return known->second;
  cv::Mat3b image = replaced ? read_texture(file_.options.texture, file_.path.string(), notes)
                             : load_texture(file_.scene, plain.texture, file_.path, notes);
  multiply(image, factor);
  pictures_.emplace_back(image, plain.wrap);
  return pictures_.size() - 1;
}

Eigen::Vector3f Looks::color_of_most() const {
  const auto most = std::ranges::max_element(
      triangles_, {}, [](const auto& part_and_count) { return part_and_count.second; });
  const Look& look = looks_[most->first];
  if (look.picture == Look::kNone && !look.painted) return look.color;
  if (look.picture == Look::kNone) {
    const auto first = std::ranges::find(soup_.parts, most->first) - soup_.parts.begin();
    const Rgb rgb = color_of(static_cast<int>(first), 0);
    return Eigen::Vector3f(rgb[0], rgb[1], rgb[2]) / 255;
  }
  const Eigen::Vector3f color = material_color(file_, file_.scene.meshes[most->first]);
  return color.allFinite() ? color : Mesh().color;
}

bool Looks::are_one_color() const {
  const Eigen::Vector3f color = looks_[triangles_.begin()->first].color;
  return std::ranges::all_of(triangles_, [&](const auto& part_and_count) {
    const Look& look = looks_[part_and_count.first];
    return look.picture == Look::kNone && !look.painted && look.color == color;
  });
}

UvCorners Looks::corners_of(int triangle) const {
  UvCorners uv;
  for (int k = 0; k < 3; ++k)
    uv.col(k) = soup_.uvs[static_cast<std::size_t>(soup_.triangles(k, triangle))];
  const Material* material = material_of(file_.scene.meshes[part_of(triangle)]);
  constexpr float kFarthest = 1e6f;  // pictures away
  const auto check = [&](const UvCorners& corners) {
    if (!(corners.cwiseAbs().maxCoeff() <= kFarthest))
      file_.fail(fmt::format("mesh '{}' has a texture coordinate beyond {:.0e}",
                             file_.scene.meshes[part_of(triangle)].name, kFarthest));
    return corners;
  };
  if (!material || material->uv == Material().uv) return check(uv);
  const Eigen::Map<const Eigen::Matrix<float, 2, 3, Eigen::RowMajor>> map(material->uv.data());
  return check((map.leftCols<2>() * uv).colwise() + map.col(2));
}

}  // namespace hypotrack::internal
