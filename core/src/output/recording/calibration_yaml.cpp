#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "output/recording/recording_writer.hpp"

namespace hypotrack::internal {

std::string calibration_yaml(const std::vector<Camera>& cameras) {
  static constexpr std::array<std::string_view, 3> kModels{"none", "brown", "fisheye"};
  std::string text = "%YAML:1.0\n---\nunits: m\ncameras:\n";
  for (const Camera& c : cameras) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> r = c.camera_from_world.linear();
    const Eigen::Vector3d t = c.camera_from_world.translation();
    text += fmt::format("  - image_width: {}\n    image_height: {}\n    model: {}\n", c.width,
                        c.height, kModels[static_cast<std::size_t>(c.distortion_model)]);
    text += fmt::format("    K: [{}, 0, {}, 0, {}, {}, 0, 0, 1]\n", c.fx, c.cx, c.fy, c.cy);
    text += fmt::format("    D: [{}]\n", fmt::join(c.distortion, ", "));
    text += fmt::format("    R: [{}]\n", fmt::join(r.data(), r.data() + 9, ", "));
    text += fmt::format("    T: [{}]\n", fmt::join(t.data(), t.data() + 3, ", "));
  }
  return text;
}

}  // namespace hypotrack::internal
