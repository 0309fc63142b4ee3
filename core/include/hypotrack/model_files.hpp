#pragma once

#include <string>
#include <string_view>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/solution.hpp"

namespace hypotrack {

/// Returns the name of an output's file for one model: `box.bvh` for the model `box` and the
/// extension `bvh`. Throws ConfigError, naming the model, if its name cannot be part of a file's:
/// it holds a slash, a # or a control character.
HYPOTRACK_API std::string model_file_name(const std::string& model, std::string_view extension);

/// Returns true if a model's pose is known: `tracked` or `uncertain`.
HYPOTRACK_API bool pose_known(Status status);

}  // namespace hypotrack
