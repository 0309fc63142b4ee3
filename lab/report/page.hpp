#pragma once

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
}  // namespace hypotrack
