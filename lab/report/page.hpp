#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// The one HTML file: the template, styles, scripts, libraries and data in one, needing nothing
/// else. Throws DataError if a part of the installation is missing.
HYPOTRACK_API std::string report_page(const nlohmann::ordered_json& data);

/// Text between tags or in a quoted attribute.
HYPOTRACK_API std::string escape_html(std::string_view text);
/// JSON that may stand within <script>: no tag can begin or end in it. Bytes that are no UTF-8
/// become U+FFFD.
HYPOTRACK_API std::string script_json(const nlohmann::ordered_json& data);

}  // namespace hypotrack
