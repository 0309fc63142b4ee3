#pragma once

#include <string>
#include <vector>

namespace hypotrack {

/// Returns a hint for a message: "; did you mean 'index_tip'?" if a known name is close to the
/// given one, otherwise the list of known names.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace hypotrack
