#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "model/import/looks/wrapped_picture.hpp"
#include "model/import/steps.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How a part of a file is coloured.
struct Look {
  static constexpr std::size_t kNone = ~std::size_t{0};

  Eigen::Vector3f color = Mesh().color;  ///< of a part without picture that is not painted
  std::size_t picture = kNone;           ///< index into the pictures
  bool painted = false;                  ///< the colours of its points differ
};

/// The looks of a file's parts that have triangles, and their pictures.
class Looks {
 public:
  /// Loads the pictures. Throws DataError if one is missing, damaged or without texture
  /// coordinates. `notes` receives what of them is not honoured.
  Looks(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
        std::vector<std::string>& notes);

  const Look& of(int triangle) const { return looks_[part_of(triangle)]; }
  const Look& of_part(std::size_t part) const { return looks_[part]; }
  std::size_t part_of(int triangle) const {
    return soup_.parts[static_cast<std::size_t>(triangle)];
  }
  /// Returns the parts with triangles, and how many they have.
  const std::map<std::size_t, std::size_t>& parts() const { return triangles_; }
  /// Returns the pictures, with the factors of materials and points.
  const std::vector<WrappedPicture>& pictures() const { return pictures_; }

  Rgb color_of(int triangle, int corner) const {
    return soup_.colors[static_cast<std::size_t>(soup_.triangles(corner, triangle))];
  }
  /// Returns the corners of a triangle of a part with a picture, in the plane of the picture.
  UvCorners corners_of(int triangle) const;
  /// Returns the colour of the part with most triangles.
  Eigen::Vector3f color_of_most() const;
  /// Returns true if no part has a picture or differs in colour.
  bool are_one_color() const;

 private:
  const mesh_wire::Material* material_of(const mesh_wire::MeshPart& part) const;
  void set_look(std::size_t index, const Rgb& first, std::vector<std::string>& notes);
  std::size_t picture_of(const mesh_wire::Material* material, const Eigen::Vector3f& of_points,
                         std::vector<std::string>& notes);

  const MeshFile& file_;
  const Soup& soup_;
  std::vector<Look> looks_;                       // by part
  std::map<std::size_t, std::size_t> triangles_;  // parts with triangles, and how many
  std::map<std::tuple<std::string, std::array<mesh_wire::Wrap, 2>, std::array<float, 3>>,
           std::size_t>
      known_;  // pictures by file, wrap and factor
  std::vector<WrappedPicture> pictures_;
};

}  // namespace internal
}  // namespace hypotrack
