#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// What the data of plots is made of.

using Runs = std::vector<const StudyRun*>;

/// Returns a value on an axis: numeric ones as numbers, so that an axis can be to scale.
nlohmann::ordered_json value_json(const StudyData& study, std::string_view key,
                                  const std::string& value);

/// Returns an axis as {label, numeric, values}, with `label` if it is not empty; null without a
/// key.
nlohmann::ordered_json dimension(const StudyData& study, const std::string& key,
                                 const std::string& label);

/// Calls `use(value, runs)` for each value on an axis that has runs, in the study's order. If `key`
/// is empty, calls it once with all runs.
void for_each_value(const StudyData& study, const Runs& runs, const std::string& key,
                    const std::function<void(const std::string&, const Runs&)>& use);

/// Returns the heading of the panel of a value on the axis of panels; empty without such an axis.
std::string facet_label(const StudyData& study, const std::string& key, const std::string& value);

}  // namespace internal
}  // namespace hypotrack
