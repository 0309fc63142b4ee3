#include "cameras/camera_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include "hypotrack/api/error.hpp"

namespace hypotrack::app {
namespace {

bool is_device(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return text.starts_with("/dev/") || text.find("://") != std::string_view::npos ||
         text.find('!') != std::string_view::npos ||
         (!text.empty() && std::ranges::all_of(text, is_digit));
}

/// Sets width and height from `1280x720`.
void set_size(detail::YamlDocument& source, const std::string& text) {
  int width = 0, height = 0;
  const char* const end = text.data() + text.size();
  const auto [by, first] = std::from_chars(text.data(), end, width);
  const bool has_height = first == std::errc() && by != end && *by == 'x';
  const auto [stop, second] = std::from_chars(has_height ? by + 1 : end, end, height);
  if (!has_height || second != std::errc() || stop != end || std::min(width, height) < 2)
    throw ConfigError(fmt::format(
        "--size is '{}'; expected width and height of a camera's picture, as 1280x720", text));
  source.set_plain("width", std::to_string(width));
  source.set_plain("height", std::to_string(height));
}

}  // namespace

bool names_cameras(const CameraOptions& options) {
  if (!options.device.empty() && !(options.left.empty() && options.right.empty()))
    throw ConfigError(
        "--device has both views in its picture; expected it alone, or --left and --right");
  if (options.layout && !options.left.empty() && !options.right.empty())
    throw ConfigError(
        "--layout says how one picture holds both views; expected --device, or --left alone");
  const bool left = is_device(options.left), right = is_device(options.right);
  if (!options.device.empty() || (left && right)) return true;
  if (left != right)
    throw ConfigError(
        fmt::format("--left is {}, --right {}: one is a live camera; expected both or none",
                    options.left.empty() ? "not given" : options.left,
                    options.right.empty() ? "not given" : options.right));
  if (options.size || options.fps || !options.pixel_format.empty())
    throw ConfigError(
        "--size, --fps and --pixel-format set live cameras; expected --device, or cameras as "
        "--left "
        "and --right");
  return false;
}

detail::YamlDocument camera_source(const CameraOptions& options) {
  detail::YamlDocument out;
  out.set_string("type", "camera");
  if (!options.device.empty()) out.set_string("device", options.device);
  if (options.device.empty()) out.set_string("left", options.left);
  if (options.device.empty()) out.set_string("right", options.right);
  if (options.layout) out.set_string("layout", *options.layout);
  if (options.size) set_size(out, *options.size);
  if (options.fps) out.set_plain("fps", *options.fps);
  if (!options.pixel_format.empty()) out.set_string("pixel_format", options.pixel_format);
  return out;
}

}  // namespace hypotrack::app
