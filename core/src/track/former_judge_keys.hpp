#pragma once

#include <optional>

#include "base/exported.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Keys of `tracker:` that belong to `judge:` since version 0.3. Scenes with them still open.
struct FormerJudgeKeys {
  std::optional<bool> evidence;
  std::optional<double> tracked_above, surely_above, first_above, confirmed_above, uncertain_above;
  void visit(ParamVisitor& v) {
    v("evidence", evidence, {.help = "false: called `judge: none` now"});
    const auto threshold = [&](std::string_view key, std::optional<double>& value) {
      v(key, value, {.help = "a key of `judge` now", .min = 0, .max = 1});
    };
    threshold("tracked_above", tracked_above);
    threshold("surely_above", surely_above);
    threshold("first_above", first_above);
    threshold("confirmed_above", confirmed_above);
    threshold("uncertain_above", uncertain_above);
  }
};

}  // namespace internal
}  // namespace hypotrack
