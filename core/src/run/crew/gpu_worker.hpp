#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptor.hpp"
#include "base/exported.hpp"
#include "base/subprocess.hpp"
#include "run/crew/job.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How a crew starts its processes.
struct CrewSettings {
  std::filesystem::path program;                        ///< `hypotrack`
  std::vector<std::filesystem::path> plugin_path = {};  ///< absolute
  std::filesystem::path directory = {};                 ///< of work; empty: this program's
  std::vector<std::string> variables = {};              ///< NAME=value, of the environment
  std::vector<int> gpus = {};  ///< for all jobs that take a GPU; empty: each takes its scene's
  int jobs = 1;                ///< at the same time, over all GPUs and the CPU
  double time_limit_s = 0;     ///< of a job; 0: none
};

/// A process that makes runs on one GPU for its whole life, several at a time.
class GpuWorker {
 public:
  /// Starts the process; `log` takes what it prints. Throws OutputError.
  GpuWorker(const CrewSettings& settings, int gpu, const std::filesystem::path& log);

  /// Gives it a job. It is lost if the process has ended. Throws ConfigError as line_of().
  void give(const Job& job);
  /// Returns the answers that have come since the last call. Throws DataError on nonsense.
  std::vector<WorkerAnswer> take_answers();
  bool running() { return process_.running(); }
  Subprocess::End wait() { return process_.wait(); }
  void kill() { process_.kill(); }
  void signal(int number) const { process_.signal(number); }
  /// Gives it no more jobs: it ends when those that it has do.
  void close();

 private:
  GpuWorker(const CrewSettings& settings, int gpu, const std::filesystem::path& log,
            std::pair<Descriptor, Descriptor> ends);

  double time_limit_s_;
  Descriptor socket_;
  Subprocess process_;
  LineBuffer lines_;
};

}  // namespace internal
}  // namespace hypotrack
