#include "program.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
}

/// In the child: becomes the program or ends with 126.
[[noreturn]] void become(const Start& start, const std::filesystem::path& folder) {
  redirect(STDOUT_FILENO, start.out.empty() ? folder / "out" : start.out);
  redirect(STDERR_FILENO, start.err.empty() ? folder / "err" : start.err);
  if (!start.directory.empty() && chdir(start.directory.c_str()) != 0) _exit(126);
  for (const std::string& variable : start.environment) {
    const auto equals = variable.find('=');
    setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
  }
  if (start.largest_file > 0) {
    const auto bytes = static_cast<rlim_t>(start.largest_file);
    const rlimit limit{bytes, bytes};
    std::signal(SIGXFSZ, SIG_IGN);  // writing fails instead
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
  }
  const std::string program = (build_dir() / "bin" / "hypotrack").string();
  std::vector<std::string> words{program};
  words.insert(words.end(), start.arguments.begin(), start.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(126);
}

}  // namespace

Program::Program(const Start& start) {
  std::string name = (std::filesystem::temp_directory_path() / "hypotrack_said_XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
  folder_ = name;
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot start a process");
  if (pid_ == 0) become(start, folder_);
}

Program::~Program() {
  if (running()) {
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
  }
  std::filesystem::remove_all(folder_);
}

void Program::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

bool Program::running() {
  if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ > 0;
}

Outcome Program::wait() {
  if (pid_ > 0) waitpid(pid_, &status_, 0);
  pid_ = -1;
  const int code = WIFSIGNALED(status_) ? 128 + WTERMSIG(status_) : WEXITSTATUS(status_);
  return {code, read_text(folder_ / "out"), read_text(folder_ / "err")};
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
