#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <system_error>

#include "hypotrack/api/error.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::app {

Eigen::Vector3d box_size_mm(const std::string& text) {
  constexpr double kSmallest = 5, kLargest = 5000;  // of the model rigid_box
  std::string_view rest = text;
  double unit = 1;
  if (rest.ends_with("mm")) {
    rest.remove_suffix(2);
  } else if (rest.ends_with("cm")) {
    rest.remove_suffix(2);
    unit = 10;
  }
  Eigen::Vector3d size;
  bool good = true;
  for (int i = 0; i < 3 && good; ++i) {
    if (i > 0) good = rest.starts_with('x');
    if (i > 0 && good) rest.remove_prefix(1);
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), size[i]);
    good = good && error == std::errc();
    if (good) rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
  }
  size *= unit;
  if (good && rest.empty() && size.minCoeff() >= kSmallest && size.maxCoeff() <= kLargest)
    return size;
  throw ConfigError(fmt::format(
      "--box: found '{}', expected three edges from {:g} to {:g} mm such as 60x120x30mm", text,
      kSmallest, kLargest));
}

}  // namespace hypotrack::app
