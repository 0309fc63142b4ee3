#pragma once

#include <string>
#include <vector>

namespace hypotrack {

/// "; did you mean 'index_tip'?" where one of the known names is close to the given one, otherwise
/// the list of what there is.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace hypotrack
