#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/text_file.hpp"
#include "hypotrack/api/media.hpp"
#include "new_plugin/plugin_files.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack::app {
namespace {

/// Returns the file sensor.yaml of a camera without lens distortion.
std::string sensor_text(const Camera& camera) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> pose =
      camera.camera_from_world.inverse().matrix();
  return fmt::format(
      "sensor_type: camera\n"
      "T_BS: {{cols: 4, rows: 4, data: [{}]}}\n"
      "resolution: [{}, {}]\n"
      "intrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n",
      fmt::join(pose.data(), pose.data() + pose.size(), ", "), camera.width, camera.height,
      camera.fx, camera.fy, camera.cx, camera.cy);
}

}  // namespace

void write_example_recording(const std::filesystem::path& scene, PluginLoader& plugins,
                             const std::filesystem::path& folder) {
  const OpenedScene opened = open_source(scene, {}, plugins);
  const std::vector<Camera>& cameras = opened.source->cameras();
  std::vector<std::string> lists(cameras.size(), "#timestamp [ns],filename\n");
  const auto camera_folder = [&](std::size_t i) { return folder / fmt::format("cam{}", i); };
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::filesystem::create_directories(camera_folder(i) / "data");
    TextFile(camera_folder(i) / "sensor.yaml").write(sensor_text(cameras[i]));
  }
  while (const auto frame = opened.source->next()) {
    const auto time = static_cast<std::int64_t>(std::llround(1e9 * frame->time));
    for (std::size_t i = 0; i < frame->views.size(); ++i) {
      const auto png = encode_image(".png", frame->views[i].color);
      TextFile(camera_folder(i) / "data" / fmt::format("{}.png", time))
          .write({reinterpret_cast<const char*>(png.data()), png.size()});
      lists[i] += fmt::format("{0},{0}.png\n", time);
    }
  }
  for (std::size_t i = 0; i < lists.size(); ++i)
    TextFile(camera_folder(i) / "data.csv").write(lists[i]);
}

}  // namespace hypotrack::app
