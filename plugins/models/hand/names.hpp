#pragma once

#include <string>
#include <vector>

namespace hypotrack {

/// Returns a hint for a message about an unknown name: "; did you mean 'index_tip'?" if a known
/// name is near, otherwise the list of known names.
std::string hint_about(const std::string& name, const std::vector<std::string>& known);

}  // namespace hypotrack
