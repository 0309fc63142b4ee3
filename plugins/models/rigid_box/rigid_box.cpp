// A box of given dimensions about its centre.

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "box.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

struct RigidBoxParams {
  Eigen::Vector3d size = Eigen::Vector3d(0.060, 0.120, 0.030);
  std::vector<double> color;
  std::filesystem::path texture;
  int pattern = 1;

  void visit(ParamVisitor& v) {
    v("size_mm", size,
      {.help = "edge lengths along x, y, z",
       .min = 5,
       .max = 5000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("color", color,
      {.help = "one colour (red, green, blue) instead of a pattern; bodies of one colour are hard "
               "to track",
       .min = 0,
       .max = 1});
    v("texture", texture, {.help = "picture for every face instead of the pattern"});
    v("pattern", pattern,
      {.help =
           "which printed pattern: a different one per number. Starters look for its colours: give "
           "`color` or `texture` for a real box",
       .min = 0});
  }
};

cv::Mat read_picture(const RigidBoxParams& params, const ConfigNode& config) {
  cv::Mat picture;
  if (std::filesystem::is_regular_file(params.texture)) {
    picture = read_image(params.texture.string(), cv::IMREAD_COLOR);
  }
  if (picture.empty()) {
    throw DataError(fmt::format("{}: the texture {} is missing or no image that OpenCV reads",
                                config.where(), params.texture.string()));
  }
  return picture;
}

Mesh plain_box(const RigidBoxParams& params, const ConfigNode& config) {
  if (params.color.size() != 3 || !params.texture.empty()) {
    throw ConfigError(
        fmt::format("{}: `color` must be three numbers, red, green and blue, and "
                    "excludes `texture`",
                    config.where()));
  }
  Mesh mesh = box_mesh(params.size, layout_in_proportion(params.size));
  mesh.color = Eigen::Map<const Eigen::Vector3d>(params.color.data()).cast<float>();
  const Eigen::Vector3f bgr = 255 * mesh.color.reverse();
  mesh.texture =
      cv::Mat3b(1, 1,
                cv::Vec3b(cv::saturate_cast<uchar>(bgr[0]), cv::saturate_cast<uchar>(bgr[1]),
                          cv::saturate_cast<uchar>(bgr[2])));
  return mesh;
}

Mesh make_mesh(const RigidBoxParams& params, const ConfigNode& config) {
  if (!params.color.empty()) return plain_box(params, config);
  if (!params.texture.empty()) {
    const cv::Mat picture = read_picture(params, config);
    Mesh mesh = box_mesh(params.size, layout_of_pictures(picture.size()));
    mesh.texture = repeat_on_faces(picture);
    return mesh;
  }
  const BoxLayout layout = layout_in_proportion(params.size);
  Mesh mesh = box_mesh(params.size, layout);
  mesh.texture = box_pattern(layout, params.pattern);
  return mesh;
}

class RigidBox : public Model {
 public:
  using Params = RigidBoxParams;
  RigidBox(const Params& params, PluginContext& context)
      : Model(rigid_model(make_mesh(params, context.config()))) {}
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::RigidBox, "a box of given dimensions, printed all over", "")
