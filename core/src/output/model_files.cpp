#include <fmt/format.h>

#include <algorithm>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/output.hpp"

namespace hypotrack {

std::string model_file_name(const std::string& model, std::string_view extension) {
  const auto unusable = [](char c) {
    return c == '/' || c == '#' || (c >= 0 && c < ' ') || c == '\x7f';
  };
  if (model.empty() || model.front() == '.' || std::ranges::any_of(model, unusable))
    throw ConfigError(
        fmt::format("models: the name '{}' cannot be that of a .{} file; expected a name without "
                    "slashes, # and control characters. Give the model another `name`, or leave "
                    "out the output that writes .{} files",
                    model, extension, extension));
  return fmt::format("{}.{}", model, extension);
}

bool pose_known(Status status) { return status == Status::tracked || status == Status::uncertain; }

}  // namespace hypotrack
