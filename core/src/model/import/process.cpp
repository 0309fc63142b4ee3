#include "model/import/process.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "hypotrack/error.hpp"

extern char** environ;

namespace hypotrack {
namespace {

constexpr std::size_t kLargestAnswer = std::size_t{2} << 30;

DataError unreadable(const std::filesystem::path& mesh, const std::string& why) {
  return DataError(fmt::format("{}: the mesh could not be read: {}", mesh.string(), why));
}

/// A file descriptor that is closed with the object.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }
  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

/// A child process that does not outlive the object.
class Child {
 public:
  Child(const MeshReader& reader, const std::filesystem::path& mesh, int output) {
    const std::string program = reader.program.string();
    // An absolute path can never be taken for an option.
    const std::string file = std::filesystem::absolute(mesh).string();
    const std::string seconds = std::to_string(std::max<long>(1, reader.time_limit.count()));
    std::array<char*, 4> arguments = {const_cast<char*>(program.c_str()),
                                      const_cast<char*>(file.c_str()),
                                      const_cast<char*>(seconds.c_str()), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int failed =
        posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
      pid_ = -1;
      throw unreadable(mesh, fmt::format("{} does not start: {}", program, std::strerror(failed)));
    }
  }
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Status as waitpid gives it; nothing where somebody else has taken it (SIGCHLD is ignored).
  std::optional<int> wait() {
    int status = 0;
    pid_t ended;
    do {
      ended = waitpid(pid_, &status, 0);
    } while (ended < 0 && errno == EINTR);
    pid_ = -1;
    return ended < 0 ? std::nullopt : std::optional(status);
  }

 private:
  pid_t pid_ = -1;
};

std::string read_until_end(int input, const MeshReader& reader, const std::filesystem::path& mesh) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + reader.time_limit;
  std::string answer;
  std::array<char, 1 << 16> chunk;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd ready{input, POLLIN, 0};
    const int count = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
    if (count == 0) {
      throw unreadable(mesh, fmt::format("the importer took longer than {} s; the file is damaged, "
                                         "or too large to be a model to track",
                                         reader.time_limit.count()));
    }
    if (count < 0) {
      if (errno == EINTR) continue;
      throw unreadable(mesh, std::strerror(errno));
    }
    const ssize_t size = read(input, chunk.data(), chunk.size());
    if (size == 0) return answer;
    if (size < 0) {
      if (errno == EINTR) continue;
      throw unreadable(mesh, std::strerror(errno));
    }
    answer.append(chunk.data(), static_cast<std::size_t>(size));
    if (answer.size() > kLargestAnswer) throw unreadable(mesh, "it holds more than 2 GiB of data");
  }
}

void check_status(int status, const MeshReader& reader, const std::filesystem::path& mesh) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    throw unreadable(mesh, fmt::format("the importer took longer than {} s of processor time; the "
                                       "file is damaged, or too large to be a model to track",
                                       reader.time_limit.count()));
  }
  if (WIFSIGNALED(status)) {
    throw unreadable(mesh, fmt::format("the importer crashed (SIG{}); the file is damaged: export "
                                       "it again",
                                       sigabbrev_np(WTERMSIG(status))));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw unreadable(mesh, fmt::format("{} ended with exit code {}", reader.program.string(),
                                       WEXITSTATUS(status)));
  }
}

}  // namespace

MeshReader default_mesh_reader(const std::filesystem::path& mesh) {
  // Beside libhypotrack.so, in the build tree as in an installation.
  Dl_info library{};
  std::filesystem::path folder;
  if (dladdr(reinterpret_cast<const void*>(&default_mesh_reader), &library) && library.dli_fname) {
    folder = std::filesystem::weakly_canonical(library.dli_fname).parent_path();
  }
  MeshReader reader{folder / "hypotrack" / "hypotrack_mesh_reader"};
  if (access(reader.program.c_str(), X_OK) != 0) {
    throw unreadable(mesh, fmt::format("the program that reads meshes, {}, is missing: build or "
                                       "install hypotrack again",
                                       reader.program.string()));
  }
  return reader;
}

std::string run_mesh_reader(const MeshReader& reader, const std::filesystem::path& mesh) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw unreadable(mesh, std::strerror(errno));
  const Descriptor input(ends[0]);
  Descriptor output(ends[1]);
  Child child(reader, mesh, output.get());
  output.reset();  // so that the end of the child is the end of the pipe
  std::string answer = read_until_end(input.get(), reader, mesh);
  if (const std::optional<int> status = child.wait()) check_status(*status, reader, mesh);
  return answer;
}

}  // namespace hypotrack
