#include "names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hypotrack/api/text.hpp"

namespace hypotrack {

std::string hint_about(const std::string& name, const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  return hint.empty() ? fmt::format("; there are: {}", fmt::join(known, ", ")) : hint;
}

}  // namespace hypotrack
