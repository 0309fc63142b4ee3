#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// Makes a scene of models, each given by its name and its YAML.
std::unique_ptr<Scene> make_scene(
    const std::vector<std::pair<std::string, std::string>>& models_by_name);

/// Returns a frame's solution in which all models are tracked, at 30 frames a second.
Solution tracked(const Scene& scene, int frame, const Eigen::VectorXd& state);
/// Gives one model a status.
void set_status(Solution& solution, std::size_t model, Status status);
/// Returns solutions in random states.
std::vector<Solution> random_solutions(const Scene& scene, int count);

/// A run of 30 frames a second before two cameras, 100 mm apart, the second with a distorting lens.
class OutputRun final : public OutputContext {
 public:
  explicit OutputRun(const Scene& scene);

  const Scene& scene() const override { return scene_; }
  const std::vector<Camera>& cameras() const override { return cameras_; }
  double frame_rate() const override { return 30; }
  bool fixed_lag() const override { return false; }
  std::filesystem::path file(const std::string& name) override {
    return full_disk ? std::filesystem::path("/dev/full") : folder_.path() / name;
  }
  Renderer& renderer() override { throw DeviceError("this run has no renderer"); }

  /// Makes an output from its YAML.
  std::unique_ptr<Output> open(const std::string& yaml) const;
  /// Passes solutions to an output, from begin() to finish().
  void play(const std::string& yaml, const std::vector<Solution>& solutions, bool complete = true);
  /// Passes solutions to an output that is destroyed before the end, as in a killed run.
  void play_killed(const std::string& yaml, const std::vector<Solution>& solutions);

  /// Returns the content of a file.
  std::string text(const std::string& name) const;
  /// Returns the lines of a file without those that begin with a #.
  std::vector<std::string> lines(const std::string& name) const;

  bool full_disk = false;                  ///< files cannot be written
  std::optional<std::int64_t> stamp = {};  ///< of frame 0 and, a nanosecond later each, the rest

 private:
  std::unique_ptr<Output> begin(const std::string& yaml, const std::vector<Solution>& solutions);

  const Scene& scene_;
  std::vector<Camera> cameras_;
  TemporaryDirectory folder_;
};

}  // namespace hypotrack::test
