// Whole evaluations per second and what each stage takes: a hand drawn in both views of a rectified
// pair and scored by stereo_color, or drawn in one view and scored by rgbd_depth. Hypotheses are as
// far apart as those of a search around the last solution. Run on a quiet machine:
//   build/release/bin/bench_evaluate
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "cost/cost.hpp"
#include "cost/draw/hypothesis_drawer.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr int kBatch = 64;

// The hand that comes with hypotrack, or a simple one of the same size where there is none.
std::shared_ptr<const Model> make_hand(PluginLoader& plugins, std::string& label) {
  try {
    auto hand = plugins.make<Model>(ConfigNode::parse("type: hand", "bench"));
    label = "default hand";
    return hand;
  } catch (const Error& error) {
    label = "test hand";
    return std::make_shared<const Model>(test::make_test_hand());
  }
}

Eigen::VectorXd start_state(const Scene& scene) {
  Eigen::VectorXd start = scene.rest_state();
  start[2] = 0.5;
  start.segment<4>(3) << 0, 1, 0, 0;  // fingers up, the palm turned to the cameras
  return start;
}

// Two rectified views, 120 mm apart, of a textured scene 0.5 m away; a hand fills 1 / 1.4 of them.
Observation make_observation(const Scene& scene, int size) {
  Observation observation;
  observation.scene = &scene;
  observation.start = start_state(scene);
  observation.rectified = true;
  TileCamera left;
  left.width = left.height = size;
  left.fx = left.fy = 1.9 * size;
  left.cx = (size - 1) / 2.0;
  left.cy = 0.66 * size;  // the wrist is at the origin of the hand
  TileCamera right = left;
  right.camera_from_world.translation().x() = -0.12;
  right.cx += right.fx * 0.12 / 0.5;
  cv::RNG random(1);
  for (const TileCamera& camera : {left, right}) {
    TileView view;
    view.camera = camera;
    view.color.create(size, size, CV_8UC3);
    random.fill(view.color, cv::RNG::UNIFORM, 0, 256);
    view.valid = cv::Mat(size, size, CV_8UC1, cv::Scalar(255));
    observation.views.push_back(view);
  }
  return observation;
}

// The first view alone, with the depth of the hand before a wall.
void keep_one_view_with_depth(Observation& observation) {
  observation.views.resize(1);
  observation.rectified = false;
  const ScenePlan plan(*observation.scene);
  const FrameProjection frame(observation);
  HypothesisDrawer drawer(plan);
  drawer.prepare(frame);
  const auto& start = observation.start;
  const DepthTile tile = drawer.draw({start.data(), static_cast<std::size_t>(start.size())})[0];
  cv::Mat1f depth(tile.height, tile.width);
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const float w = tile.inverse_depth[y * tile.stride + x];
      depth(y, x) = w > 0 ? 1 / w : 0.9f;
    }
  }
  observation.views[0].depth = depth;
}

// States like those of a particle swarm: +-20 mm, +-5 degrees and +-5 degrees per joint (1 sigma).
Eigen::MatrixXd make_states(const Scene& scene) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd start = start_state(scene);
  Eigen::MatrixXd states(scene.dimension(), kBatch);
  for (int i = 0; i < kBatch; ++i) {
    Eigen::VectorXd state = start;
    for (int k = 0; k < scene.dimension(); ++k) {
      const double sigma = k < 3 ? 0.02 : k < 7 ? 0.044 : 0.087;
      const Parameter& parameter = scene.parameters()[static_cast<std::size_t>(k)];
      state[k] = std::clamp(state[k] + sigma * normal(random), parameter.lower, parameter.upper);
    }
    scene.normalize(state);
    states.col(i) = state;
  }
  return states;
}

struct Setup {
  Setup(const char* type, int size)
      : scene({{"hand", make_hand(plugins, label)}}),
        observation(make_observation(scene, size)),
        states(make_states(scene)),
        objective(plugins.make<Objective>(ConfigNode::parse(std::string("type: ") + type, "bench"),
                                          &scene)) {
    if (type == std::string_view("rgbd_depth")) keep_one_view_with_depth(observation);
  }

  PluginLoader plugins;
  std::string label;
  Scene scene;
  Observation observation;
  Eigen::MatrixXd states;
  std::shared_ptr<Objective> objective;
};

// Arguments: tile size, threads.
void whole_evaluation(benchmark::State& state, const char* objective) {
  const Setup setup(objective, static_cast<int>(state.range(0)));
  EvaluateSettings settings;
  settings.backend = Backend::cpu;
  settings.threads = static_cast<int>(state.range(1));
  const auto cost = make_cost(setup.scene, {{1, setup.objective, objective}}, settings);
  cost->prepare(setup.observation);
  Eigen::VectorXd costs(kBatch);
  for (auto _ : state) {
    cost->evaluate(setup.states, costs);
    benchmark::DoNotOptimize(costs.data());
  }
  state.SetItemsProcessed(state.iterations() * kBatch);
  state.SetLabel(setup.label + ", " + cost->backend());
}

// Microseconds per evaluation of every stage. Argument: tile size.
void stages(benchmark::State& state, const char* objective) {
  const Setup setup(objective, static_cast<int>(state.range(0)));
  const ScenePlan plan(setup.scene);
  const FrameProjection frame(setup.observation);
  HypothesisDrawer drawer(plan);
  drawer.prepare(frame);
  setup.objective->prepare(setup.observation);
  constexpr std::array kNames{"clear_us", "pose_us", "project_us",
                              "cull_us",  "fill_us", "score_us"};
  std::array<double, kNames.size()> seconds{};
  for (auto _ : state) {
    for (int i = 0; i < kBatch; ++i) {
      const std::span<const double> x(setup.states.col(i).data(),
                                      static_cast<std::size_t>(setup.states.rows()));
      std::size_t stage = 0;
      auto before = std::chrono::steady_clock::now();
      const auto lap = [&] {
        const auto now = std::chrono::steady_clock::now();
        seconds[stage++] += std::chrono::duration<double>(now - before).count();
        before = now;
      };
      drawer.clear(), lap();
      drawer.pose(x), lap();
      drawer.project(), lap();
      drawer.cull(), lap();
      drawer.fill(), lap();
      benchmark::DoNotOptimize(setup.objective->cost({x, drawer.tiles()})), lap();
    }
  }
  const auto count = static_cast<double>(state.iterations() * kBatch);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    state.counters[kNames[i]] = seconds[i] / count * 1e6;
  }
  state.SetItemsProcessed(state.iterations() * kBatch);
  state.SetLabel(setup.label + ", " + simd_target());
}

void whole_arguments(benchmark::internal::Benchmark* b) {
  b->ArgNames({"tile", "threads"})->ArgsProduct({{128, 256}, {1, 2}});
  b->UseRealTime()->Unit(benchmark::kMicrosecond);
}
void stage_arguments(benchmark::internal::Benchmark* b) {
  b->ArgName("tile")->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(whole_evaluation, stereo_color, "stereo_color")->Apply(whole_arguments);
BENCHMARK_CAPTURE(whole_evaluation, rgbd_depth, "rgbd_depth")->Apply(whole_arguments);
BENCHMARK_CAPTURE(stages, stereo_color, "stereo_color")->Apply(stage_arguments);
BENCHMARK_CAPTURE(stages, rgbd_depth, "rgbd_depth")->Apply(stage_arguments);

}  // namespace
}  // namespace hypotrack

BENCHMARK_MAIN();
