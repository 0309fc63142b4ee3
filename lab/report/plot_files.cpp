#include "lab/report/plot_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "hypotrack/error.hpp"
#include "hypotrack/plugin.hpp"
#include "lab/report/json_file.hpp"

namespace hypotrack {
namespace {

namespace fs = std::filesystem;

/// The first of some programs that is on the PATH; empty if none is.
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

/// Runs a program to its end. Throws OutputError, with what it said, if it fails.
void run_tool(const fs::path& program, const std::vector<std::string>& arguments,
              const fs::path& log) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = -1;
  if (error == 0) waitpid(pid, &status, 0);
  std::ifstream in(log, std::ios::binary);
  const std::string said((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  fs::remove(log);
  if (error == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
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
  // What plots are made of; the replays and pictures of the runs are not.
  Json small{{"kind", page["kind"]}, {"plots", page["plots"]}, {"runs", Json::array()}};
  if (page["kind"] == "run") {
    small["runs"].push_back(page["runs"][0]);
    small["runs"][0].erase("replay");
    small["runs"][0].erase("worst");
  }
  const fs::path data = directory / ".data.json";
  std::ofstream(data, std::ios::binary)
      << small.dump(-1, ' ', false, Json::error_handler_t::replace);
  run_tool(node, {data_file("report/render_plots.js").string(), data.string(), directory.string()},
           directory / ".log");
  fs::remove(data);

  const fs::path rsvg = find_program({"rsvg-convert"});
  if (rsvg.empty()) return "no PNG files of the plots were made: install librsvg2-bin";
  std::set<fs::path> drawings;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".svg") drawings.insert(entry.path());
  for (const fs::path& svg : drawings) {
    fs::path png = svg;
    png.replace_extension(".png");
    run_tool(rsvg, {"--zoom", "2", "--output", png.string(), svg.string()}, directory / ".log");
  }
  return "";
}

}  // namespace hypotrack
