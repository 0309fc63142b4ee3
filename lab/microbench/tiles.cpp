// What a frame's tiles take: planning them, matching their colours, and cutting them on the CPU and
// on the GPU.
#include "tile/tiles.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "cost/cuda/device.hpp"
#include "cost/cuda/tiles/tile_resampler.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "test_models.hpp"
#include "track/color/photometric.hpp"

namespace hypotrack {
namespace {

constexpr int kFrames = 8;  // more than caches hold
constexpr int kWidth = 1280, kHeight = 720;

/// A hand half a metre in front of two cameras with lenses.
struct Setup {
  Setup() : scene({{"hand", std::make_shared<Model>(test::make_test_hand())}}) {
    Camera camera{kWidth, kHeight, 700, 700, 640, 360, DistortionModel::brown, {}, {}};
    camera.distortion = {-0.17, 0.02, 0.0003, -0.0002};
    camera.camera_from_world.setIdentity();
    cameras.assign(2, camera);
    cameras[1].camera_from_world.translation().x() = -0.12;
    tiles = std::make_unique<TileMaker>(scene, cameras, TileSettings{});
    state = scene.rest_state();
    state[2] = 0.5;
    other_state = state;
    other_state[2] = 0.501;
    frames.resize(kFrames);
  }

  /// Frames whose images lie in ordinary memory, or in `memory`.
  void make_frames(unsigned char* memory = nullptr) {
    cv::RNG random(1);
    for (Frame& frame : frames) {
      frame.views.resize(cameras.size());
      for (View& view : frame.views) {
        view.color =
            memory ? cv::Mat(kHeight, kWidth, CV_8UC3, memory) : cv::Mat(kHeight, kWidth, CV_8UC3);
        if (memory) memory += view.color.total() * view.color.elemSize();
        random.fill(view.color, cv::RNG::UNIFORM, 0, 256);
      }
    }
  }

  Scene scene;
  std::vector<Camera> cameras;
  std::unique_ptr<TileMaker> tiles;
  Eigen::VectorXd state, other_state;
  std::vector<Frame> frames;
};

/// Around another state each time.
void plan(benchmark::State& run) {
  Setup setup;
  setup.make_frames();
  for (auto _ : run) {
    benchmark::DoNotOptimize(setup.tiles->plan(setup.frames[0], setup.state));
    setup.state.swap(setup.other_state);
  }
}
BENCHMARK(plan)->Unit(benchmark::kMicrosecond);

void visible_share(benchmark::State& run) {
  Setup setup;
  for (auto _ : run) {
    benchmark::DoNotOptimize(setup.tiles->visible_share(setup.state));
    setup.state.swap(setup.other_state);
  }
}
BENCHMARK(visible_share)->Unit(benchmark::kMicrosecond);

/// As a tracker without prediction asks: tiles around the last solution, the share of the next one.
void plan_and_visible_share(benchmark::State& run) {
  Setup setup;
  setup.make_frames();
  for (auto _ : run) {
    benchmark::DoNotOptimize(setup.tiles->plan(setup.frames[0], setup.state));
    setup.state.swap(setup.other_state);
    benchmark::DoNotOptimize(setup.tiles->visible_share(setup.state));
  }
}
BENCHMARK(plan_and_visible_share)->Unit(benchmark::kMicrosecond);

void cut_on_the_cpu(benchmark::State& run) {
  Setup setup;
  setup.make_frames();
  const TilePlan tile_plan = setup.tiles->plan(setup.frames[0], setup.state);
  std::size_t next = 0;
  for (auto _ : run) {
    benchmark::DoNotOptimize(setup.tiles->resample(setup.frames[next++ % kFrames], tile_plan));
  }
}
BENCHMARK(cut_on_the_cpu)->Unit(benchmark::kMicrosecond)->UseRealTime();

/// Per frame: the solution drawn once more, both images looked up, three lines fitted.
void learn_colors(benchmark::State& run) {
  Setup setup;
  setup.make_frames();
  for (Frame& frame : setup.frames) {
    for (View& view : frame.views) view.color.convertTo(view.color, CV_8U, 0.15, 90);
  }
  const TilePlan tile_plan = setup.tiles->plan(setup.frames[0], setup.state);
  PhotometricMatch match(setup.scene, {});
  std::size_t next = 0;
  for (auto _ : run) {
    match.learn(*setup.tiles, setup.frames[next++ % kFrames], tile_plan, setup.state);
  }
  if (!match.knows()) run.SkipWithError("nothing was learned");
}
BENCHMARK(learn_colors)->Unit(benchmark::kMicrosecond);

/// From the call to the tiles' being there; `enqueued` is what the call itself takes.
void cut_on_the_gpu(benchmark::State& run) {
  if (const std::string why = cuda::why_no_device(); !why.empty()) {
    run.SkipWithError(why.c_str());
    return;
  }
  Setup setup;
  const cuda::Device device(0);
  cuda::PinnedBuffer<unsigned char> memory;
  if (run.range(0) != 0) memory.reserve(std::size_t{2 * kFrames} * kWidth * kHeight * 3);
  setup.make_frames(memory.data());
  const TilePlan tile_plan = setup.tiles->plan(setup.frames[0], setup.state);
  cuda::TileResampler resampler(setup.tiles->resamplers(), device.limits());
  std::size_t next = 0;
  double enqueued = 0;
  for (auto _ : run) {
    const auto begin = std::chrono::steady_clock::now();
    resampler.resample(setup.frames[next++ % kFrames], tile_plan, device.stream());
    enqueued += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cuda::check(cudaStreamSynchronize(cuda::native(device.stream())), "cutting tiles");
  }
  run.counters["enqueued_us"] =
      benchmark::Counter(1e6 * enqueued, benchmark::Counter::kAvgIterations);
}
BENCHMARK(cut_on_the_gpu)
    ->ArgName("page_locked")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

}  // namespace
}  // namespace hypotrack

BENCHMARK_MAIN();
