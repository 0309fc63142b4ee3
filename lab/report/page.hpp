#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the text of a self-contained HTML file: template, styles, scripts, libraries and data.
/// Throws DataError if a part of the installation is missing.
std::string report_page(const nlohmann::ordered_json& data);

/// Escapes text for use between tags or in a quoted attribute.
std::string escape_html(std::string_view text);
/// Formats JSON for use within <script>: no tag can begin or end in it. Bytes that are no UTF-8
/// become U+FFFD.
std::string script_json(const nlohmann::ordered_json& data);

}  // namespace internal
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes DIRECTORY/<id>.svg and .png for every plot of a report (ReportData::page). It runs the
/// page's scripts under Node.js, and librsvg's rsvg-convert. Returns why pictures were left out,
/// with what to install; empty if all were written. Throws OutputError if one of the programs
/// fails.
std::string write_plot_files(const nlohmann::ordered_json& page,
                             const std::filesystem::path& directory);

}  // namespace internal
}  // namespace hypotrack
