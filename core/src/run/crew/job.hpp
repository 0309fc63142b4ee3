#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A run of a scene, to be made by another process.
struct Job {
  std::size_t key = 0;  ///< tells the jobs of a crew apart
  std::filesystem::path scene;
  std::vector<std::string> set = {};         ///< overrides: `key.path=value`
  std::filesystem::path out = {};            ///< folder for the results
  std::filesystem::path log = {};            ///< file for what the run says
  std::optional<int> frames = std::nullopt;  ///< stop after this many
  std::optional<int> gpu = std::nullopt;     ///< number of the GPU that its scene takes, if any
  bool check = false;                        ///< only open the scene and look at its first frame
  /// More descriptors for its process, if it has one of its own.
  std::vector<std::pair<int, int>> descriptors = {};
};

/// What a worker says: a line of JSON.
struct WorkerAnswer {
  enum class Kind {
    ready,    ///< its GPU answers; `text` is the GPU's name
    absent,   ///< there is no such GPU, or it does not answer; `text` says why
    ended,    ///< the run of `key` has ended with `code`
    overdue,  ///< the time limit ended that run
    lost,     ///< that run has ended because the GPU failed, which all runs of the process lose
  };
  Kind kind = Kind::ready;
  std::string text = {};
  std::size_t key = 0;
  int code = 0;
};

/// Descriptor by which a worker gets jobs and answers.
inline constexpr int kWorkerSocket = 3;

// Lines without their ends. Parsing throws DataError, line_of() a ConfigError on a name of a file
// that is no UTF-8.
std::string line_of(const Job& job, double time_limit_s);
Job parse_job(const std::string& line, double& time_limit_s);
std::string line_of(const WorkerAnswer& answer);
WorkerAnswer parse_answer(const std::string& line);

/// Takes complete lines out of text that arrives in pieces.
class LineBuffer {
 public:
  void add(const char* text, std::size_t size) { text_.append(text, size); }
  /// Returns the next complete line, without its end.
  std::optional<std::string> next();

 private:
  std::string text_;
};

}  // namespace internal
}  // namespace hypotrack
