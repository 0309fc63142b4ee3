#include "camera_options.hpp"

namespace hypotrack::app {

void add_camera_options(const Command& command, CameraOptions& options) {
  command.add("--device", &options.device,
              "Live camera with both views side by side: a number, /dev/..., a URL or a GStreamer "
              "pipeline",
              {.check = file_name(), .value_name = "DEVICE"});
  command.add("--size", &options.size,
              "Picture size to set live cameras to (--device: of both views together)",
              {.value_name = "1280x720"});
  command.add("--fps", &options.fps, "Pictures per second of live cameras",
              {.check = positive_number()});
  command.add("--pixel-format", &options.pixel_format,
              "Pixel format to set live cameras to, such as MJPG", {.value_name = "MJPG"});
}

}  // namespace hypotrack::app
