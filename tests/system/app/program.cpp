#include "program.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace hypotrack::test {
namespace {

/// While it lives, started programs fail to write files beyond a size, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(long bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    if (bytes <= 0) return;
    const rlimit limit{static_cast<rlim_t>(bytes), before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

Subprocess::Command command_of(const Start& start, const std::filesystem::path& folder) {
  return {build_dir() / "bin" / "hypotrack",
          start.arguments,
          start.environment,
          start.directory,
          start.out.empty() ? folder / "out" : start.out,
          start.err.empty() ? folder / "err" : start.err};
}

}  // namespace

Program::Program(const Start& start) {
  const FileSizeLimit limit(start.largest_file);
  process_.emplace(command_of(start, folder_.path()));
}

void Program::signal(int number) const { process_->signal(number); }

bool Program::running() { return process_->running(); }

Outcome Program::wait() {
  const int code = process_->wait().code;
  return {code, read_text(folder_.path() / "out"), read_text(folder_.path() / "err")};
}

Outcome run_program(const Start& start) { return Program(start).wait(); }

Outcome run_program(const std::vector<std::string>& arguments) {
  Start start;
  start.arguments = arguments;
  return run_program(start);
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string track_without_times(const std::filesystem::path& folder) {
  constexpr int kMilliseconds = 5;
  std::string text;
  for (const std::string& line : lines_of(read_text(folder / "track.csv"))) {
    std::istringstream in(line);
    int column = 0;
    for (std::string cell; std::getline(in, cell, ','); ++column)
      if (column != kMilliseconds) text += cell + ",";
    text += "\n";
  }
  return text;
}

std::string box_scene() {
  return R"(models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
source:
  type: synthetic
  cameras: {width: 160, height: 120, focal_px: 160, baseline_mm: 80}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400], rotation_deg: [20, 30, 0]}}}
    - {frame: 4, pose: {box: {position_mm: [20, 10, 420], rotation_deg: [20, 40, 10]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 8, generations: 4}
tile: {size: 32}
init: {from: truth}
output: {overlay: false}
)";
}

std::string replaced(std::string text, const std::string& piece, const std::string& by) {
  const auto at = text.find(piece);
  if (at == std::string::npos) throw std::invalid_argument("no '" + piece + "' in the text");
  return text.replace(at, piece.size(), by);
}

}  // namespace hypotrack::test
