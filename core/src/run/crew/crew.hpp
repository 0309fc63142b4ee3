#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "run/crew/gpu_workers.hpp"
#include "run/crew/process_pool.hpp"
#include "run/crew/scratch_folder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The GPUs that a command line asks for.
struct GpuList {
  std::vector<int> numbers;
  bool all_needed = true;  ///< false: those that do not answer are left out
};

/// Parses `all`, `auto` or numbers with commas. Throws ConfigError, DeviceError if there is no GPU.
GpuList parse_gpus(const std::string& text);

/// Returns the environment that keeps graphics drivers from starting a thread per core in every
/// run: empty if it says already how many they start.
std::vector<std::string> driver_variables(int threads);

/// Makes runs at the same time. Those of a GPU are threads of a worker process, for processes would
/// take turns on it. The others have a process each.
class Crew {
 public:
  /// Throws OutputError if there is no room for temporary files.
  explicit Crew(CrewSettings settings);
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  const CrewSettings& settings() const { return settings_; }
  /// Returns a folder for logs of jobs. It is removed with the crew.
  const std::filesystem::path& scratch() const { return scratch_.path(); }
  /// Starts the workers of the settings' GPUs. Leaves out those that do not answer if
  /// `all_needed` is false. Returns a text that names the others. Throws DeviceError.
  std::string start_gpus(bool all_needed);
  /// Returns true if a further job may start.
  bool has_room() const { return size() < static_cast<std::size_t>(settings_.jobs); }
  /// Returns the GPU of the settings that takes the next job; none if it is not known.
  std::optional<int> next_gpu() const { return workers_.next_gpu(); }
  /// Starts a job, or lets it wait for its GPU. Throws OutputError.
  void start(Job job);
  /// Removes and returns a job that has ended, if any. Its log holds what its run said.
  std::optional<Ended> take_ended();
  std::size_t size() const { return pool_.size() + workers_.size(); }
  /// Returns lines for the user on what happened to workers since the last call.
  std::vector<std::string> take_notes() { return workers_.take_notes(); }
  /// Tells all jobs to end early, and waits for none.
  void interrupt();
  /// Ends all jobs at once, and forgets them.
  void kill();

 private:
  CrewSettings settings_;
  ScratchFolder scratch_;  // outlives the processes
  ProcessPool pool_;
  GpuWorkers workers_;
};

/// Returns why a program failed: hypotrack's own message in its log, or else how it ended and the
/// log's last line.
std::string failure_message(const std::filesystem::path& log, const Ended& ended);

}  // namespace internal
}  // namespace hypotrack
