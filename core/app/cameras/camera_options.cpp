#include "cameras/camera_options.hpp"

namespace hypotrack::app {

void add_layout_option(const Command& command, std::optional<std::string>& layout) {
  const auto names = enum_names(StereoLayout());
  command.add("--layout", &layout,
              "How one picture holds both views: the first camera in its left half (side_by_side) "
              "or its upper half (top_bottom)",
              {.check = one_of({names.begin(), names.end()})});
}

void add_color_options(const Command& command, ColorOptions& options) {
  const auto matrices = enum_names(ColorMatrix());
  const auto ranges = enum_names(ColorRange());
  command.add("--color-matrix", &options.matrix,
              "Matrix of the colours of videos (default: their own, or that of players)",
              {.check = one_of({matrices.begin(), matrices.end()})});
  command.add("--color-range", &options.range,
              "Range of the samples of videos (default: their own, or limited)",
              {.check = one_of({ranges.begin(), ranges.end()})});
}

void add_camera_options(const Command& command, CameraOptions& options) {
  command.add("--device", &options.device,
              "Live camera with both views in its picture: a number, /dev/..., a URL or a "
              "GStreamer pipeline",
              {.check = file_name(), .value_name = "DEVICE"});
  add_layout_option(command, options.layout);
  command.add("--size", &options.size,
              "Picture size to set live cameras to (--device: of both views together)",
              {.value_name = "1280x720"});
  command.add("--fps", &options.fps, "Pictures per second of live cameras",
              {.check = positive_number()});
  command.add("--pixel-format", &options.pixel_format,
              "Pixel format of live cameras, for example MJPG", {.value_name = "MJPG"});
}

}  // namespace hypotrack::app
