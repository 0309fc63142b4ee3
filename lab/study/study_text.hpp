#pragma once

#include <string>
#include <string_view>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Formats a node as YAML on one line: `{type: pso, particles: 32}`. It parses to the same node.
std::string to_flow(const ConfigNode& node);

/// Formats a text as a YAML scalar on one line, quoted if it would not stay a text otherwise.
std::string yaml_scalar(std::string_view text);

/// Returns whether a name of a scene, case or variant consists of letters, digits, '_' and '-', as
/// file names require.
bool is_word(std::string_view text);

}  // namespace internal
}  // namespace hypotrack::study
