#include "base/subprocess.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <thread>

#include "base/descriptor.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kNotStarted = 126;  // exit code of a child that did not become the program

/// Opens a file for a program's output; an empty name drops it.
Descriptor open_output(const std::filesystem::path& file) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  const int opened = open(file.empty() ? "/dev/null" : file.c_str(), kFlags, 0644);
  if (opened < 0) throw_system_error(errno, file.string() + ": cannot be written");
  return Descriptor(opened);
}

/// Reason why a child did not become the program.
struct StartFailure {
  int error = 0;
  bool in_directory = false;  ///< it could not enter its working directory
};

/// All that a child needs, made before fork(): nothing may be allocated after it.
class Preparation {
 public:
  explicit Preparation(const Subprocess::Command& command)
      : program_(command.program.string()), directory_(command.directory.string()) {
    words_ = {program_};
    words_.insert(words_.end(), command.arguments.begin(), command.arguments.end());
    set_variables(command.variables);
    argv_ = pointers(words_);
    envp_ = pointers(variables_);
    const int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (null < 0) throw_system_error(errno, "/dev/null: cannot be read");
    redirect(Descriptor(null), {STDIN_FILENO});
    if (command.output == command.errors) {
      redirect(open_output(command.output), {STDOUT_FILENO, STDERR_FILENO});
    } else {
      redirect(open_output(command.output), {STDOUT_FILENO});
      redirect(open_output(command.errors), {STDERR_FILENO});
    }
    for (const auto& [own, number] : command.descriptors) redirect(Descriptor(dup(own)), {number});
  }

  /// Turns the child into the program; tells its parent if it cannot.
  [[noreturn]] void become(pid_t parent, int report) const {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kNotStarted);  // the parent died before the line above
    setpgid(0, 0);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const int number : {SIGINT, SIGTERM}) ::signal(number, SIG_DFL);
    StartFailure failure;
    failure.in_directory = !directory_.empty() && chdir(directory_.c_str()) != 0;
    bool ready = !failure.in_directory;
    for (const auto& [own, number] : redirections_) ready = ready && dup2(own, number) >= 0;
    if (ready) execve(program_.c_str(), argv_.data(), envp_.data());
    failure.error = errno;
    [[maybe_unused]] const ssize_t written = write(report, &failure, sizeof(failure));
    _exit(kNotStarted);
  }

  [[noreturn]] void fail_start(const StartFailure& failure) const {
    if (failure.in_directory) throw_system_error(failure.error, directory_ + ": cannot be entered");
    throw_system_error(failure.error, program_ + ": cannot be started");
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> out;
    for (std::string& text : texts) out.push_back(text.data());
    out.push_back(nullptr);
    return out;
  }

  /// Copies the environment; some variables replace those of the same name.
  void set_variables(const std::vector<std::string>& own) {
    variables_ = own;
    for (char** variable = environ; *variable; ++variable) {
      const std::string_view text = *variable;
      const std::string_view name = text.substr(0, text.find('=') + 1);
      if (std::ranges::none_of(own, [&](const auto& other) { return other.starts_with(name); }))
        variables_.emplace_back(text);
    }
  }

  void redirect(Descriptor own, const std::vector<int>& numbers) {
    for (const int number : numbers) redirections_.emplace_back(own.get(), number);
    held_.push_back(std::move(own));
  }

  std::string program_, directory_;
  std::vector<std::string> words_, variables_;
  std::vector<char*> argv_, envp_;
  std::vector<Descriptor> held_;
  std::vector<std::pair<int, int>> redirections_;  // this program's descriptor, the child's number
};

/// Starts a program; returns when it runs.
pid_t start(const Preparation& preparation) {
  Pipe report = make_pipe();  // closed by a successful start
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) preparation.become(parent, report.write_end.get());
  if (pid < 0) throw_system_error(errno, "cannot start a process");
  report.write_end.close();
  StartFailure failure;
  ssize_t size = 0;
  do {
    size = read(report.read_end.get(), &failure, sizeof(failure));
  } while (size < 0 && errno == EINTR);
  if (size <= 0) return pid;
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
  preparation.fail_start(failure);
}

}  // namespace

Subprocess::Subprocess(const Command& command) : pid_(start(Preparation(command))) {}

Subprocess::~Subprocess() { kill(); }

Subprocess::Subprocess(Subprocess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), end_(other.end_) {}

Subprocess& Subprocess::operator=(Subprocess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(end_, other.end_);
  return *this;
}

bool Subprocess::ended(int options) {
  if (pid_ <= 0) return true;
  siginfo_t info{};
  int failed = 0;
  do {
    failed = waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT | options);
  } while (failed && errno == EINTR);
  if (!failed && info.si_pid == 0) return false;
  const pid_t pid = std::exchange(pid_, -1);
  if (failed) return true;  // the status is lost
  ::kill(-pid, SIGKILL);    // while the ended program still keeps the group's number
  int status = 0;
  waitpid(pid, &status, 0);
  if (WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
  end_.code = WIFSIGNALED(status) ? 128 + end_.signal : WEXITSTATUS(status);
  return true;
}

bool Subprocess::running() { return !ended(WNOHANG); }

Subprocess::End Subprocess::wait() {
  ended(0);
  return end_;
}

bool Subprocess::wait_until(std::chrono::steady_clock::time_point time) {
  while (running()) {
    if (std::chrono::steady_clock::now() >= time) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

void Subprocess::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

void Subprocess::kill() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);  // it may have left its group
  ended(0);
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

}  // namespace hypotrack::internal
