#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes DIRECTORY/<id>.svg and .png for every plot of a report (ReportData::page). It runs the
/// page's scripts under Node.js, and librsvg's rsvg-convert. Returns why pictures were left out,
/// with what to install; empty if all were written. Throws OutputError if one of the programs
/// fails.
std::string write_plot_files(const nlohmann::ordered_json& page,
                             const std::filesystem::path& directory);

}  // namespace internal
}  // namespace hypotrack
