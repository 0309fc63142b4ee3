#include "lab/live/page_files.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::internal {
namespace {

std::string content_of(const std::string& name) {
  const std::filesystem::path file = data_file(name);
  std::string text = read_whole(file).value_or("");
  if (text.empty())
    throw DataError(fmt::format("{}: cannot be read; install hypotrack again", file.string()));
  return text;
}

std::string type_of(const std::filesystem::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".js") return "text/javascript; charset=utf-8";
  if (suffix == ".css") return "text/css; charset=utf-8";
  return suffix == ".html" ? "text/html; charset=utf-8" : "text/plain; charset=utf-8";
}

}  // namespace

std::map<std::string, PageFile> live_page_files() {
  std::map<std::string, PageFile> files;
  // The 3D view is the report's.
  for (const char* name : {"live/live.css", "live/live.js", "live/running_plot.js",
                           "report/decode.js", "report/elements.js", "report/licences.txt",
                           "report/orbit_controls.js", "report/replay.js", "report/three.js"}) {
    const std::filesystem::path file(name);
    files["/" + file.filename().string()] = {type_of(file), content_of(name)};
  }
  files["/"] = {type_of("live.html"), content_of("live/live.html")};
  return files;
}

}  // namespace hypotrack::internal
