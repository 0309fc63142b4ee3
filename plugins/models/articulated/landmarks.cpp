#include "landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::articulated {

void Anchor::visit(ParamVisitor& v) {
  v("name", name, {.help = "name of the landmark", .required = true});
  v("link", link, {.help = "link, or bone of the mesh file, that carries it", .required = true});
  v("position_mm", position,
    {.help = "in the link's frame", .unit = "mm", .to_si = kMillimetre, .required = true});
}

std::vector<Landmark> bounding_box_landmarks_of_bones(const ModelData& data) {
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  std::vector<Landmark> all;
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    std::vector<Eigen::Index> own;  // vertices that it moves most
    for (Eigen::Index v = 0; v < data.mesh.vertices.cols(); ++v) {
      Eigen::Index most = 0;
      data.mesh.bone_weights.col(v).maxCoeff(&most);
      if (data.mesh.bone_indices(most, v) == static_cast<int>(b)) own.push_back(v);
    }
    const Eigen::Matrix3Xf vertices = data.mesh.vertices(Eigen::all, own);
    for (Landmark& landmark : bounding_box_landmarks(bind[b].inverse().cast<float>() * vertices)) {
      landmark.name = data.bones[b].name + "_" + landmark.name;
      landmark.bone = static_cast<int>(b);
      all.push_back(std::move(landmark));
    }
  }
  return all;
}

std::vector<Landmark> landmarks_of(const std::vector<Anchor>& anchors,
                                   const std::vector<std::string>& links, const Assembly& assembly,
                                   const std::string& where) {
  std::vector<Landmark> all;
  for (const Anchor& anchor : anchors) {
    const auto found = std::ranges::find(links, anchor.link);
    if (found == links.end())
      throw DataError(
          fmt::format("{}: the anchor '{}' is on the link '{}', which there is not; the "
                      "links are: {}",
                      where, anchor.name, anchor.link, fmt::join(links, ", ")));
    const LinkPlace& place = assembly.links[static_cast<std::size_t>(found - links.begin())];
    all.push_back({anchor.name, place.bone, place.bone_from_link * anchor.position});
  }
  return all;
}

}  // namespace hypotrack::articulated
