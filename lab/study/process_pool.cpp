#include "lab/study/process_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "hypotrack/error.hpp"

extern char** environ;

namespace hypotrack::study {
namespace {

constexpr const char* kMesaThreads = "LP_NUM_THREADS";

/// What the child needs, put together before fork: after it, nothing may be allocated.
struct Prepared {
  std::vector<std::string> words, variables;
  std::vector<char*> argv, envp;
  int log = -1;
  int null = -1;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

Prepared prepare(const Command& command) {
  Prepared prepared;
  prepared.words = {command.program.string()};
  prepared.words.insert(prepared.words.end(), command.arguments.begin(), command.arguments.end());
  for (char** variable = environ; *variable; ++variable) prepared.variables.emplace_back(*variable);
  // Mesa's software rasteriser starts a thread per core otherwise, in every run.
  if (!std::getenv(kMesaThreads))
    prepared.variables.push_back(fmt::format("{}={}", kMesaThreads, command.threads));
  prepared.argv = pointers(prepared.words);
  prepared.envp = pointers(prepared.variables);
  prepared.null = open("/dev/null", O_RDONLY | O_CLOEXEC);
  prepared.log = open(command.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (prepared.log < 0)
    throw OutputError(fmt::format("{}: cannot be written: {}", command.log.string(),
                                  std::generic_category().message(errno)));
  return prepared;
}

/// In the child: becomes the program.
[[noreturn]] void become(const Command& command, const Prepared& prepared, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(126);  // it died before it could be watched
  setpgid(0, 0);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  if (command.inherit >= 0) fcntl(command.inherit, F_SETFD, 0);
  const bool ready =
      dup2(prepared.null, STDIN_FILENO) >= 0 && dup2(prepared.log, STDOUT_FILENO) >= 0 &&
      dup2(prepared.log, STDERR_FILENO) >= 0 && chdir(command.directory.c_str()) == 0;
  if (ready) execve(prepared.argv[0], prepared.argv.data(), prepared.envp.data());
  _exit(126);
}

}  // namespace

ProcessPool::~ProcessPool() { kill_all(); }

void ProcessPool::start(std::size_t key, const Command& command) {
  const Prepared prepared = prepare(command);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(command, prepared, parent);
  const int error = errno;
  close(prepared.log);
  if (prepared.null >= 0) close(prepared.null);
  if (pid < 0)
    throw OutputError(fmt::format("cannot start a process: {}; use fewer --jobs",
                                  std::generic_category().message(error)));
  running_.push_back({key, pid, Clock::now()});
}

std::optional<Ended> ProcessPool::take_ended() {
  for (auto it = running_.begin(); it != running_.end(); ++it) {
    int status = 0;
    if (waitpid(it->pid, &status, WNOHANG) != it->pid) continue;
    Ended ended;
    ended.key = it->key;
    ended.seconds = std::chrono::duration<double>(Clock::now() - it->begin).count();
    if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
    ended.exit_code = WIFSIGNALED(status) ? 128 + ended.signal : WEXITSTATUS(status);
    running_.erase(it);
    return ended;
  }
  return std::nullopt;
}

void ProcessPool::kill_all() {
  for (const Running& running : running_) kill(-running.pid, SIGKILL);
  for (const Running& running : running_) {
    kill(running.pid, SIGKILL);  // it may not have had the time to lead a group
    while (waitpid(running.pid, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  running_.clear();
}

}  // namespace hypotrack::study
