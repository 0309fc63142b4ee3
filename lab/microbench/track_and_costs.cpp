// Measures tracking and costs for a program in C++; track_and_costs.py compares them with Python's:
//
//   bench_track_and_costs SCENE FRAMES
//
// Prints frames per second and batches of 1,024 costs per second.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <random>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/source.hpp"

namespace hypotrack {
namespace {

constexpr int kWarmUp = 10, kBatches = 60;

/// Returns 1 / the median time of calls after the first `kWarmUp`.
double per_second(int calls, const std::function<void(int)>& call) {
  std::vector<double> seconds;
  for (int i = 0; i < calls; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    call(i);
    if (i >= kWarmUp)
      seconds.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const auto middle = seconds.begin() + std::ssize(seconds) / 2;
  std::ranges::nth_element(seconds, middle);
  return 1 / *middle;
}

void measure(const char* file, int count) {
  Session session(file);
  const auto source = session.source();
  std::vector<Frame> frames;
  for (auto frame = source->next(); frame && std::ssize(frames) < count; frame = source->next())
    frames.push_back(*frame);
  if (std::ssize(frames) <= kWarmUp || !frames.front().truth)
    throw Error("the scene needs a truth and more than 10 frames, and FRAMES has to be more, too");
  for (Frame& frame : frames) {  // pictures alone, but in the first the truth, to start from
    for (View& view : frame.views) view = {.color = view.color};
    if (&frame != &frames.front()) frame.truth.reset();
  }

  Tracker tracker = session.tracker(source->cameras());
  const double tracked = per_second(static_cast<int>(frames.size()), [&](int i) {
    tracker.track(frames[static_cast<std::size_t>(i)]);
  });

  const Eigen::VectorXd truth = frames.front().truth->state;
  Eigen::MatrixXd states(truth.size(), 1024);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.01);
  for (double& value : states.reshaped()) value = normal(random);
  states.colwise() += truth;
  FrameCost cost = session.frame_cost(source->cameras());
  cost.look(frames.front(), truth);
  const double costs = per_second(kBatches, [&](int) { cost.costs(states); });
  std::printf("%.17g %.17g\n", tracked, costs);
}

}  // namespace
}  // namespace hypotrack

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s SCENE FRAMES\n", argv[0]);
    return 1;
  }
  hypotrack::measure(argv[1], std::atoi(argv[2]));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
