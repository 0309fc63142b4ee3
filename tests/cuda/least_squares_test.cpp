// Searches by least squares whose residuals stay on the GPU.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "device.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr const char* kNumerical = "{type: levenberg_marquardt, jacobian: numerical}";
constexpr const char* kAnalytic = "{type: levenberg_marquardt, jacobian: analytic}";

struct Tracked {
  std::vector<Eigen::VectorXd> states;
  std::vector<double> costs;
  double error = 0;  ///< mean joint error over the frames, mm
};

/// Frames of configs/scenes/demo.yaml.
struct Frames {
  int first = 0, count = 8;
};

/// Tracks frames from the truth in the first of them.
Tracked track(const std::string& backend, const std::string& optimizer,
              const std::vector<std::string>& more = {}, const Frames& frames = {}) {
  PluginLoader plugins;
  std::vector<std::string> overrides{"optimizer=" + optimizer, "evaluate.backend=" + backend,
                                     "budget.evaluations=512"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/demo.yaml", overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  for (int i = 0; i < frames.first; ++i) session.source->next();
  Frame frame = session.source->next().value();
  const Eigen::VectorXd start = initial_state(session, frame);
  SceneTracker tracker(scene, std::move(session.parts), start, session.seed);
  Tracked tracked;
  for (int i = 0; i < frames.count; ++i) {
    const Solution solution = tracker.track(frame);
    tracked.states.push_back(solution.state);
    tracked.costs.push_back(solution.cost);
    tracked.error +=
        1e3 / frames.count *
        frame_error(layout, scene.landmarks(solution.state), scene.landmarks(frame.truth->state))
            .mean;
    frame = session.source->next().value();
  }
  return tracked;
}

class LeastSquaresOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(LeastSquaresOnDevice, FindsTheHandAsTheCpuDoesAndRepeatsToTheBit) {
  for (const char* optimizer : {kNumerical, kAnalytic}) {
    const Tracked cpu = track("cpu", optimizer), gpu = track("cuda", optimizer);
    EXPECT_LT(cpu.error, 1.5) << optimizer;
    EXPECT_LT(gpu.error, 1.5) << optimizer;
    const Tracked again = track("cuda", optimizer);
    EXPECT_EQ(again.states, gpu.states) << optimizer;
    EXPECT_EQ(again.costs, gpu.costs) << optimizer;
  }
}

// Each frame by itself: where tiles are cut, and how colours are compared, follows from the frames
// before, and with them what costs mean.
TEST_F(LeastSquaresOnDevice, GetsAsFarDownAsTheCpuDoes) {
  for (const int first : {0, 3, 6}) {
    const Frames frame{first, 1};
    const Tracked cpu = track("cpu", kNumerical, {}, frame);
    const Tracked gpu = track("cuda", kNumerical, {}, frame);
    EXPECT_NEAR(gpu.costs[0] / cpu.costs[0], 1, 0.02) << "frame " << first;
  }
}

TEST_F(LeastSquaresOnDevice, RefinesWhatASwarmOnTheGpuFound) {
  const auto after = [](const char* swarm) {
    return track("cuda", fmt::format("{{type: pipeline, stages: [{{optimizer: {}, share: 0.3}}, "
                                     "{{optimizer: {{type: levenberg_marquardt}}, share: 0.7}}]}}",
                                     swarm));
  };
  const Tracked by_batches = after("{type: pso, particles: 16, group_share: 0.3}");
  const Tracked on_device = after("{type: pso_cuda, particles: 16, group_share: 0.3}");
  EXPECT_LT(by_batches.error, 1.5);
  EXPECT_LT(on_device.error, 1.5);
  EXPECT_EQ(after("{type: pso_cuda, particles: 16, group_share: 0.3}").states, on_device.states);
  RecordProperty("errors_mm",
                 fmt::format("pso {}, pso_cuda {}", by_batches.error, on_device.error));
}

// A search for one hand plans tiles of that hand alone.
TEST_F(LeastSquaresOnDevice, LooksForOneOfTwoHands) {
  PluginLoader plugins;
  const std::vector<std::string> overrides{
      "evaluate.backend=cuda", "budget.evaluations=256",
      "source.faults=[{frames: [4, 6], kind: absent, model: left}]"};
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/two_hands.yaml", overrides, plugins);
  const Scene& scene = *session.scene;
  const auto left = scene.items()[1].offset;
  std::optional<SceneTracker> tracker;
  for (int i = 0; i < 10; ++i) {
    const Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    const Solution solution = tracker->track(frame);
    EXPECT_EQ(solution.models[0], Status::tracked) << "frame " << i;
    if (i == 5) {
      EXPECT_NE(solution.models[1], Status::tracked);
    }
    if (i == 9) {
      const Eigen::VectorXd apart = solution.state - frame.truth->state;
      EXPECT_LT(apart.segment<3>(0).norm(), 0.01);
      EXPECT_LT(apart.segment<3>(left).norm(), 0.01);
    }
  }
}

TEST_F(LeastSquaresOnDevice, GivesSigmasToo) {
  const std::vector<std::string> sigmas{"uncertainty.enabled=true"};
  const Tracked cpu = track("cpu", kNumerical, sigmas), gpu = track("cuda", kNumerical, sigmas);
  EXPECT_LT(gpu.error, 1.5);
  EXPECT_NEAR(gpu.error, cpu.error, 0.5);
}

}  // namespace
}  // namespace hypotrack
