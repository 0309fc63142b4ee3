#include "lab/report/page.hpp"

#include <fmt/format.h>

#include <array>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/json_file.hpp"

namespace hypotrack::internal {
namespace {

std::string asset(const std::string& name) {
  const std::filesystem::path file = data_file("report/" + name);
  std::string text = read_whole(file).value_or("");
  if (text.empty())
    throw DataError(fmt::format("{}: cannot be read; install hypotrack again", file.string()));
  return text;
}

std::string replaced_all(std::string text, std::string_view piece, std::string_view by) {
  for (std::size_t at = text.find(piece); at != std::string::npos;
       at = text.find(piece, at + by.size()))
    text.replace(at, piece.size(), by);
  return text;
}

std::string scripts() {
  constexpr std::array kScripts{"three.js",    "orbit_controls.js", "vega.js",     "decode.js",
                                "elements.js", "plot_parts.js",     "plots.js",    "run_plots.js",
                                "charts.js",   "tables.js",         "changes.js",  "replay.js",
                                "player.js",   "run_page.js",       "overview.js", "report.js"};
  std::string all;
  for (const char* name : kScripts)
    all += "<script>\n" + replaced_all(asset(name), "</script", "<\\/script") + "\n</script>\n";
  return all;
}

std::string dumped(const Json& data) {
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns the content for one of the template's markers.
std::string content(std::string_view marker, const Json& data) {
  if (marker == "title") return escape_html(Json::parse(dumped(data["title"])).get<std::string>());
  if (marker == "style") return asset("report.css");
  if (marker == "licences") return escape_html(asset("licences.txt"));
  if (marker == "data") return script_json(data);
  if (marker == "scripts") return scripts();
  throw DataError(fmt::format("report.html: '{}' is no marker that is known", marker));
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_json(const Json& data) { return replaced_all(dumped(data), "<", "\\u003c"); }

std::string report_page(const Json& data) {
  const std::string page = asset("report.html");
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = page.find("{{"); open != std::string::npos; open = page.find("{{", at)) {
    const std::size_t close = page.find("}}", open);
    if (close == std::string::npos) break;
    out += page.substr(at, open - at);
    out += content(std::string_view(page).substr(open + 2, close - open - 2), data);
    at = close + 2;
  }
  return out + page.substr(at);
}

}  // namespace hypotrack::internal
