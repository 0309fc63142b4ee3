// What the features of stereo_color take on the GPU, from two tiles in its memory to the last
// pixel's weight, by the device's clock.
#include <benchmark/benchmark.h>

#include "cost/cuda/device.hpp"
#include "cuda/feature_maps.hpp"
#include "made_up_frame.hpp"

namespace hypotrack::stereo_color {
namespace {

struct Event {
  Event() { cuda::check(cudaEventCreate(&handle), "making an event"); }
  ~Event() { cudaEventDestroy(handle); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  cudaEvent_t handle = nullptr;
};

// `frames` are enqueued at once: 1 shows what a frame waits for, many what it costs.
void features(benchmark::State& run) {
  if (const std::string why = cuda::why_no_device(); !why.empty()) {
    run.SkipWithError(why.c_str());
    return;
  }
  const cuda::Device device(0);
  const int size = static_cast<int>(run.range(0)), frames = static_cast<int>(run.range(1));
  Settings settings;
  settings.color_space = static_cast<ColorSpace>(run.range(2));
  Observation observation;
  observation.views.assign(2, test::made_up_view({.width = size, .height = size}));
  const test::DeviceFrame frame(observation, device.stream());
  FeatureMaps maps(settings);
  const Event begin, end;
  for (auto _ : run) {
    cuda::check(cudaEventRecord(begin.handle, cuda::native(device.stream())), "timing");
    for (int i = 0; i < frames; ++i) maps.enqueue(frame.observation(), device.stream());
    cuda::check(cudaEventRecord(end.handle, cuda::native(device.stream())), "timing");
    cuda::check(cudaEventSynchronize(end.handle), "timing");
    float milliseconds = 0;
    cuda::check(cudaEventElapsedTime(&milliseconds, begin.handle, end.handle), "timing");
    run.SetIterationTime(1e-3 * milliseconds / frames);
  }
}
BENCHMARK(features)
    ->ArgNames({"tile", "frames", "color_space"})
    ->ArgsProduct({{64, 128, 256, 1024}, {1, 20}, {static_cast<long>(ColorSpace::rgb)}})
    ->Args({128, 1, static_cast<long>(ColorSpace::lab)})
    ->Args({128, 1, static_cast<long>(ColorSpace::hsv)})
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hypotrack::stereo_color

BENCHMARK_MAIN();
