#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

#include "base/subprocess.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/json_file.hpp"
#include "lab/report/page.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

/// Returns the first of some programs that is on the PATH; empty if none is.
fs::path find_program(const std::vector<std::string>& names) {
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const std::string& name : names)
      if (const fs::path file = fs::path(folder) / name;
          !folder.empty() && access(file.c_str(), X_OK) == 0)
        return file;
  return {};
}

/// Runs a program to its end. Throws OutputError, with its output, if it fails.
void run_tool(const fs::path& program, const std::vector<std::string>& arguments) {
  std::string said;
  try {
    const Captured captured = capture_output({program, arguments}, {STDOUT_FILENO, STDERR_FILENO});
    if (captured.end.code == 0) return;
    said = captured.output;
  } catch (const std::system_error& error) {
    said = error.what();
  }
  throw OutputError(fmt::format(
      "{}: failed while drawing the report's plots; leave the pictures out with --no-images. It "
      "said: {}",
      program.string(), said.empty() ? "nothing" : said.substr(0, 2000)));
}

}  // namespace

std::string write_plot_files(const Json& page, const fs::path& directory) {
  const fs::path node = find_program({"nodejs", "node"});
  if (node.empty())
    return "no SVG and PNG files of the plots were made: install nodejs (SVG) and librsvg2-bin "
           "(PNG)";
  // Keep what plots need; drop the replays and pictures of the runs.
  Json small{{"kind", page["kind"]}, {"plots", page["plots"]}, {"runs", Json::array()}};
  if (page["kind"] == "run") {
    small["runs"].push_back(page["runs"][0]);
    small["runs"][0].erase("replay");
    small["runs"][0].erase("worst");
  }
  const fs::path data = directory / ".data.json";
  std::ofstream(data, std::ios::binary)
      << small.dump(-1, ' ', false, Json::error_handler_t::replace);
  run_tool(node, {data_file("report/render_plots.js").string(), data.string(), directory.string()});
  fs::remove(data);

  const fs::path rsvg = find_program({"rsvg-convert"});
  if (rsvg.empty()) return "no PNG files of the plots were made: install librsvg2-bin";
  std::set<fs::path> drawings;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".svg") drawings.insert(entry.path());
  for (const fs::path& svg : drawings) {
    fs::path png = svg;
    png.replace_extension(".png");
    run_tool(rsvg, {"--zoom", "2", "--output", png.string(), svg.string()});
  }
  return "";
}

}  // namespace hypotrack::internal
