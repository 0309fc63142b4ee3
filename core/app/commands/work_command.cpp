// The hidden command that a crew starts for a GPU (run/crew/).
#include <fmt/format.h>
#include <malloc.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <list>
#include <memory>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <string>
#include <thread>

#include "base/machine.hpp"
#include "camera/pictures/orientation.hpp"
#include "check_scene.hpp"
#include "commands.hpp"
#include "cost/cuda/device.hpp"
#include "cost/cuda/memory/page_locked_images.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "model/import/imported_meshes.hpp"
#include "plugin/running_plugin.hpp"
#include "run/crew/job.hpp"
#include "run/run_scene.hpp"

namespace hypotrack::app {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = WorkerAnswer::Kind;

/// Writes what a run says to its log, and ends it at its time limit or on a signal.
class LoggedRun final : public RunWatcher {
 public:
  LoggedRun(const std::filesystem::path& log, const InterruptGuard& interrupt, double limit_s)
      : log_(log, std::ios::binary), interrupt_(interrupt), limit_s_(limit_s) {}

  bool overdue() const {
    return limit_s_ > 0 && std::chrono::duration<double>(Clock::now() - begin_).count() > limit_s_;
  }
  bool stop() override { return interrupt_.interrupted() || overdue(); }
  void say(const std::string& text) override { log_ << text << std::endl; }
  void frame(const Frame& frame, const Solution& /*solution*/, double /*error*/) override {
    if (!frame.problem.empty()) say(fmt::format("frame {}: {}", frame.index, frame.problem));
  }

 private:
  std::ofstream log_;
  const InterruptGuard& interrupt_;
  double limit_s_;
  Clock::time_point begin_ = Clock::now();
};

/// Keeps memory that was freed: to give it back interrupts every thread of the process.
void keep_freed_memory() {
  (void)mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that glibc takes
  (void)mallopt(M_TRIM_THRESHOLD, 1 << 30);
  (void)mallopt(M_TOP_PAD, 16 << 20);
}

/// Returns the bytes of images that the worker of a study keeps: the recordings of a seed.
std::size_t kept_bytes() {
  constexpr std::size_t kMost = std::size_t{4} << 30;
  constexpr std::size_t kShare = 64;  // of the memory, for one of up to eight GPUs
  return std::min(kMost, memory_size() / kShare);
}

/// Makes the jobs that come through a socket, each in a thread, and answers.
class Worker {
 public:
  Worker(std::optional<int> gpu, const CommonOptions& common) : gpu_(gpu), common_(common) {}

  void serve() {
    keep_freed_memory();
    cv::setNumThreads(1);  // its threads are one per core, whatever the runs' own may be
    if (!take_gpu()) return;
    keep_imported_meshes();
    LineBuffer lines;
    std::array<char, 4096> chunk;
    for (;;) {
      const ssize_t size = recv(kWorkerSocket, chunk.data(), chunk.size(), 0);
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) break;
      lines.add(chunk.data(), static_cast<std::size_t>(size));
      while (const auto line = lines.next()) begin(*line);
    }
    runs_.clear();  // waits for them
  }

 private:
  struct Thread {
    std::atomic<bool> done = false;
    std::jthread thread;
  };

  bool take_gpu() {
    if (!gpu_) {
      answer({Kind::ready, "CPU"});
      return true;
    }
    std::string why = cuda::why_no_device(*gpu_);
    if (why.empty()) why = cuda::why_not_this_device(*gpu_);
    if (!why.empty()) {
      answer({Kind::absent, why});
      return false;
    }
    // Before threads make images. Blocks are up to a quarter larger than images; a gibibyte is for
    // those that are not kept.
    cuda::page_lock_images(*gpu_, kept_bytes() / 4 * 5 + (std::size_t{1} << 30));
    std::string name = cuda::Device(*gpu_).name();
    if (!cuda::claim_gpu(*gpu_)) name += ", which another hypotrack uses, too";
    answer({Kind::ready, name});
    return true;
  }

  void begin(const std::string& line) {
    runs_.remove_if([](const Thread& each) { return each.done.load(); });
    double limit_s = 0;
    Job job = parse_job(line, limit_s);
    Thread& made = runs_.emplace_back();
    made.thread = std::jthread([this, &made, job = std::move(job), limit_s] {
      answer(make(job, limit_s));
      made.done = true;
    });
  }

  WorkerAnswer make(const Job& job, double limit_s) {
    const hypotrack::detail::ThreadFrame unknown(std::nullopt);  // not that of another run
    LoggedRun watcher(job.log, interrupt_, limit_s);
    WorkerAnswer answer{Kind::ended, {}, job.key, 1};
    try {
      answer.code = run(job, watcher);
      if (answer.code != 0 && watcher.overdue()) answer.kind = Kind::overdue;
    } catch (const DeviceError&) {
      watcher.say("hypotrack: " + failure_text());
      if (gpu_ && !cuda::free_memory(*gpu_)) answer.kind = Kind::lost;
    } catch (...) {
      watcher.say("hypotrack: " + failure_text());
    }
    return answer;
  }

  /// Keeps what the cells of a study share, which begins with checks: first frames for those, then
  /// images for the runs.
  void keep_for(const Job& job) {
    constexpr std::size_t kFrames = 16;  // different ones at a time
    if (!job.check) return first_frames_.keep(0);
    first_frames_.keep(kFrames);
    keep_read_images(kept_bytes());
  }

  /// Returns the exit code that a process of the run would have.
  int run(const Job& job, LoggedRun& watcher) {
    PluginLoader plugins(common_.plugin_path);
    keep_for(job);
    if (job.check) {
      watcher.say(check_scene(job.scene, job.set, plugins, std::nullopt, &first_frames_).backend);
      return 0;
    }
    const RunOptions options{.out = job.out, .frames = job.frames, .stop_now = [&watcher] {
                               return InterruptGuard::signalled() || watcher.overdue();
                             }};
    const RunResult result = run_scene(job.scene, job.set, plugins, options, watcher);
    if (result.summary) watcher.say(summary_text(*result.summary, result.folder));
    if (result.complete) return 0;
    watcher.say(
        fmt::format("hypotrack: {}", result.summary ? kInterruptedLate : kInterruptedEarly));
    return kInterruptedExitCode;
  }

  void answer(const WorkerAnswer& answer) {
    const std::string line = line_of(answer) + "\n";
    const std::lock_guard<std::mutex> lock(answering_);
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t size =
          send(kWorkerSocket, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) return;  // nobody listens
      sent += static_cast<std::size_t>(size);
    }
  }

  std::optional<int> gpu_;
  const CommonOptions& common_;
  const InterruptGuard interrupt_;
  FirstFrames first_frames_{[](const std::shared_ptr<const Frame>&) { return std::size_t{1}; }};
  std::mutex answering_;
  std::list<Thread> runs_;
};

}  // namespace

void add_work_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto gpu = std::make_shared<std::optional<int>>();
  const Command command =
      root.add_command("work", "Make the runs that come through a socket, at the same time");
  command.hide();
  command.add("--gpu", gpu.get(), "Number of the GPU", {.check = whole_number(0)});
  command.on_call([gpu, &common, &exit_code] {
    struct stat info {};
    if (fstat(kWorkerSocket, &info) != 0 || !S_ISSOCK(info.st_mode))
      throw ConfigError(fmt::format(
          "work: descriptor {} is no socket; this command is not for you: `hypotrack run SCENE... "
          "--jobs N --gpus all` starts it",
          kWorkerSocket));
    Worker(*gpu, common).serve();
    exit_code = 0;
  });
}

}  // namespace hypotrack::app
