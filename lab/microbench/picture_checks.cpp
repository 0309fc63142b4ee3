// What the search for faults in pictures costs per pair of 1280x720 pixels, beside reading them.

#include "track/faults/picture_checks.hpp"

#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

namespace hypotrack {
namespace {

constexpr int kWidth = 1280, kHeight = 720;

std::vector<Camera> cameras() {
  std::vector<Camera> out(
      2, Camera{kWidth, kHeight, 700, 700, 639.5, 359.5, DistortionModel::none, {}, {}});
  for (Camera& camera : out) camera.camera_from_world.setIdentity();
  out[1].camera_from_world.translation().x() = -0.12;
  return out;
}

/// Two frames of a textured wall, with noise or as still as a rendering.
std::vector<Frame> frames(double sigma) {
  constexpr int kCoarse = 16, kDisparity = 60;
  cv::RNG random(7);
  cv::Mat small(kHeight / kCoarse, 2 * kWidth / kCoarse, CV_8UC3), wall;
  random.fill(small, cv::RNG::UNIFORM, 20, 220);
  cv::resize(small, wall, {2 * kWidth, kHeight}, 0, 0, cv::INTER_CUBIC);
  std::vector<Frame> out(2);
  for (Frame& frame : out)
    for (const int left : {0, kDisparity}) {
      cv::Mat noise(kHeight, kWidth, CV_16SC3), sum;
      random.fill(noise, cv::RNG::NORMAL, 0, sigma);
      cv::add(wall(cv::Rect(left, 0, kWidth, kHeight)), noise, sum, cv::noArray(), CV_8U);
      frame.views.push_back({sum, {}, {}});
    }
  return out;
}

void check(benchmark::State& state, double sigma) {
  const std::vector<Frame> pair = frames(sigma);
  PictureChecks checks(cameras(), false);
  checks.check(pair[1]);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(checks.check(pair[i++ % 2]));
}

void read(benchmark::State& state) {
  const std::vector<Frame> pair = frames(2);
  std::size_t i = 0;
  for (auto _ : state) {
    for (const View& view : pair[i % 2].views) benchmark::DoNotOptimize(cv::sum(view.color));
    ++i;
  }
}

BENCHMARK_CAPTURE(check, noise, 2.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(check, still, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK(read)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hypotrack

BENCHMARK_MAIN();
