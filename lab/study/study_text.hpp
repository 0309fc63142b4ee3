#pragma once

#include <string>
#include <string_view>

#include "hypotrack/config.hpp"

namespace hypotrack::study {

/// A node as YAML on one line: `{type: pso, particles: 32}`. Reading it gives the same node again.
std::string to_flow(const ConfigNode& node);

/// A text as a YAML scalar on one line, in quotes where it needs them to stay a text.
std::string yaml_scalar(std::string_view text);

/// Whether a name of a scene, a case or a variant is a word of letters, digits, '_' and '-', as it
/// must be to become a part of file names.
bool is_word(std::string_view text);

}  // namespace hypotrack::study
