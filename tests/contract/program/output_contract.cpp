#include <stdlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string_view>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/run/run_output.hpp"
#include "output/run_directory.hpp"
#include "session/opened_scene.hpp"
#include "subject.hpp"
#include "test_models.hpp"

namespace hypotrack::contract {
namespace {

constexpr int kFrames = 6, kMissing = 3;

/// A folder that is removed with the object.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "contract_XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr, "cannot make a temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A run of a hand before one camera. Remembers which files are asked for.
class TestRun final : public OutputContext {
 public:
  TestRun(const Scene& scene, bool fixed_lag, std::vector<std::string> declared)
      : scene_(scene), fixed_lag_(fixed_lag), declared_(std::move(declared)), cameras_(1) {
    Camera& camera = cameras_.front();
    camera.width = 96;
    camera.height = 64;
    camera.fx = camera.fy = 80;
    camera.cx = 47.5;
    camera.cy = 31.5;
  }

  const Scene& scene() const override { return scene_; }
  const std::vector<Camera>& cameras() const override { return cameras_; }
  double frame_rate() const override { return 30; }
  bool fixed_lag() const override { return fixed_lag_; }
  std::filesystem::path file(const std::string& name) override {
    if (std::ranges::none_of(declared_, [&](const auto& known) { return is_result(name, known); }))
      throw Violation("it writes '" + name + "', which is none of its file_names()");
    asked_.insert(name);
    return folder_.path() / name;
  }
  Renderer& renderer() override {
    try {
      if (!renderer_) renderer_ = std::make_unique<Renderer>(scene_);
    } catch (const DeviceError& e) {
      throw Skipped(e.what());
    }
    return *renderer_;
  }

  /// Throws a Violation unless every file that was asked for is there and no other.
  void check_files() const {
    std::set<std::string> there;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      there.insert(entry.path().filename().string());
    for (const std::string& name : asked_)
      require(there.contains(name), "it asked for '" + name + "' and did not write it");
    for (const std::string& name : there)
      require(asked_.contains(name), "it wrote '" + name + "' without asking for it");
  }

  /// Returns the content of every file by name.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const std::string& name : asked_) {
      std::stringstream text;
      text << std::ifstream(folder_.path() / name, std::ios::binary).rdbuf();
      all[name] = text.str();
    }
    return all;
  }

 private:
  const Scene& scene_;
  bool fixed_lag_;
  std::vector<std::string> declared_;
  std::vector<Camera> cameras_;
  Folder folder_;
  std::set<std::string> asked_;
  std::unique_ptr<Renderer> renderer_;
};

struct Step {
  Frame frame;
  Solution solution;
};

/// Makes frames with ground truth and sigmas; frame kMissing has no views.
std::vector<Step> make_steps(const TestRun& run) {
  const Scene& scene = run.scene();
  const Camera& camera = run.cameras().front();
  std::mt19937_64 random(1);
  std::vector<Step> steps;
  for (int i = 0; i < kFrames; ++i) {
    Step step;
    step.frame.index = step.solution.frame = i;
    step.frame.time = step.solution.time = i / run.frame_rate();
    step.solution.status = i == kMissing ? Status::missing : Status::tracked;
    step.solution.models.assign(scene.items().size(), step.solution.status);
    step.solution.probabilities.assign(scene.items().size(), 0.9);
    step.solution.cost = 0.1 * i;
    step.solution.evaluations = 100;
    step.solution.seconds = 0.01;
    step.solution.state = test::random_state(scene, random);
    step.solution.landmarks = scene.landmarks(step.solution.state);
    step.solution.sigma.setConstant(step.solution.landmarks.cols(), 0.004);
    if (i == kMissing)
      step.frame.problem = "the picture is missing";
    else
      step.frame.views.push_back(
          {.color = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar(60, 90, 20 * i))});
    const Eigen::VectorXd truth = test::random_state(scene, random);
    step.frame.truth = GroundTruth{truth, scene.landmarks(truth)};
    steps.push_back(std::move(step));
  }
  return steps;
}

/// Lets an output write the values of its columns. Throws unless what lies behind them stays.
void write_values(Output& output, const Step& step) {
  constexpr double kUntouched = -8191.25;
  const std::size_t count = output.columns().size();
  if (count == 0) return;
  std::vector<double> memory(count, std::numeric_limits<double>::quiet_NaN());
  memory.resize(count + 16, kUntouched);
  output.values(step.frame, step.solution, std::span(memory).first(count));
  require(std::ranges::count(memory.begin() + static_cast<std::ptrdiff_t>(count), memory.end(),
                             kUntouched) == 16,
          "more values are written than it has columns, which are " + std::to_string(count));
}

/// Passes frames to an output as a run does; with fixed-lag smoothing all are smoothed at the end.
void pass(Output& output, TestRun& run, int count, bool complete) {
  output.begin(run);
  const auto frame = [&](const Step& step) {
    write_values(output, step);
    output.frame(step.frame, step.solution);
  };
  std::vector<Step> steps = make_steps(run);
  steps.resize(static_cast<std::size_t>(count));
  for (const Step& step : steps) {
    output.online(step.frame, step.solution);
    if (!run.fixed_lag()) frame(step);
  }
  for (Step& step : steps) {
    step.frame.views.clear();
    if (run.fixed_lag()) frame(step);
  }
  output.finish(complete);
}

void check_names(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    require(!name.empty() && name.front() != '.' && name.find('/') == std::string::npos,
            "'" + name + "' is not the name of a file, or begins with a dot");
    require(std::ranges::count(name, '#') <= 1, "'" + name + "' has more than one #");
    require(seen.insert(name).second, "'" + name + "' is there twice");
  }
}

bool is_text(const std::string& name) {
  static constexpr std::array<std::string_view, 8> kExtensions = {".csv", ".json",  ".txt", ".yaml",
                                                                  ".yml", ".jsonl", ".tum", ".bvh"};
  return std::ranges::any_of(kExtensions,
                             [&](std::string_view extension) { return name.ends_with(extension); });
}

}  // namespace

void check_output(Report& report, const Subject& subject) {
  if (!check_parameters<Output>(report, subject, true)) return;
  const std::vector<std::string> names = subject.make<Output>()->file_names();
  const auto run_of = [&](bool fixed_lag) {
    return std::make_unique<TestRun>(*subject.scene, fixed_lag, names);
  };
  const auto passed = [&](bool fixed_lag, int count, bool complete) {
    auto run = run_of(fixed_lag);
    const auto output = subject.make<Output>();
    pass(*output, *run, count, complete);
    run->check_files();
    return run->contents();
  };
  report.row("the names of its files are names", [&] { check_names(names); });
  report.row("it writes the files that it asks for, and they are among its names",
             [&] { passed(false, kFrames, true); });
  report.row("its columns of track.csv have names, and one value each", [&] {
    std::vector<NamedOutput> outputs(1);
    outputs[0] = {subject.name, subject.make<Output>()};
    check_outputs(outputs);
    const auto run = run_of(false);
    pass(*outputs[0].output, *run, kFrames, true);
  });
  report.row("it takes smoothed solutions without pictures", [&] { passed(true, kFrames, true); });
  report.row("it completes the files of a run that ends early", [&] { passed(false, 2, false); });
  report.row("it may be destroyed before the end", [&] {
    const auto run = run_of(false);
    subject.make<Output>()->begin(*run);
  });
  report.row("a second object writes the same", [&] {
    const auto first = passed(false, kFrames, true), second = passed(false, kFrames, true);
    for (const auto& [name, content] : first) {
      require(second.contains(name), "'" + name + "' is missing");
      // Encoders of pictures and videos need not repeat to the bit.
      if (is_text(name)) require(second.at(name) == content, "'" + name + "' has another content");
    }
    require(first.size() == second.size(), "it writes more files");
  });
}

}  // namespace hypotrack::contract
