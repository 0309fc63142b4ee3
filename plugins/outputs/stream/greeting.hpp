#pragma once

#include <string>

#include "hypotrack/plugin/output.hpp"

namespace hypotrack::stream {

/// Returns the first line of a stream as JSON: models with the names and units of their parameters
/// and landmarks, cameras, frames per second. `online`: solutions come before smoothing.
std::string greeting(const OutputContext& run, bool online);

}  // namespace hypotrack::stream
