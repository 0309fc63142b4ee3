#include "camera/timeline/video_clock.hpp"

#include <algorithm>
#include <cmath>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kUsualRate = 30;  // frames per second

std::vector<double> steps_of(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  return steps;
}

/// Returns the mean of the steps near the median: containers round times.
double usual_step(const std::vector<double>& steps) {
  const double median = upper_median(steps);
  double sum = 0;
  int count = 0;
  for (const double step : steps) {
    if (step < 0.5 * median || step > 1.5 * median) continue;
    sum += step;
    ++count;
  }
  return sum / count;
}

/// Returns whether most steps are equal, but for what recorders and containers round.
bool is_even(const std::vector<double>& steps, double period, double tick) {
  constexpr double kRounding = 2e-3;  // seconds
  constexpr double kMost = 0.75;
  const double tolerance = std::min(std::max(kRounding, 1.1 * tick), period / 4);
  const auto equal = std::ranges::count_if(
      steps, [&](double step) { return std::abs(step - period) <= tolerance; });
  return static_cast<double>(equal) >= kMost * static_cast<double>(steps.size());
}

/// Returns whether times are numbers over a rate, but for the container's rounding.
bool fits(const VideoClock& clock, double rate, double tick) {
  const double tolerance = std::max(1.05 * tick, 1e-4);
  for (std::size_t i = 0; i < clock.times.size(); ++i) {
    const double expected = static_cast<double>(clock.numbers[i]) / rate;
    if (std::abs(clock.times[i] - expected) > tolerance) return false;
  }
  return true;
}

void set_constant(VideoClock& clock, std::size_t frames, double rate) {
  clock.rate = rate;
  for (std::size_t i = 0; i < frames; ++i) {
    clock.numbers.push_back(static_cast<std::int64_t>(i));
    clock.times.push_back(static_cast<double>(i) / rate);
  }
  clock.last = clock.first + (frames > 0 ? clock.times.back() : 0);
}

/// Numbers the frames, and takes the rate that the file says if its times are of that rate.
void set_numbers(VideoClock& clock, const std::vector<double>& steps, double period,
                 const VideoInfo& video) {
  clock.numbers.push_back(0);
  for (const double step : steps) {
    const std::int64_t frames = clock.even ? std::max(1L, std::lround(step / period)) : 1;
    clock.numbers.push_back(clock.numbers.back() + frames);
  }
  clock.rate = 1 / period;
  clock.exact = false;
  if (!clock.even) return;
  const auto mean = static_cast<double>(clock.numbers.back()) / clock.times.back();
  for (const double rate : {video.frame_rate, std::round(mean), mean}) {
    if (rate <= 0 || !fits(clock, rate, video.tick)) continue;
    clock.rate = rate;
    clock.exact = true;
    for (std::size_t i = 0; i < clock.times.size(); ++i)
      clock.times[i] = static_cast<double>(clock.numbers[i]) / rate;
    return;
  }
}

}  // namespace

VideoClock clock_of(const VideoInfo& video, const std::optional<double>& rate) {
  VideoClock clock;
  const std::size_t frames = video.times.size();
  if (rate || frames < 2) {
    if (!rate && frames > 0) clock.first = video.times[0];
    set_constant(clock, frames,
                 rate.value_or(video.frame_rate > 0 ? video.frame_rate : kUsualRate));
    return clock;
  }
  clock.first = video.times.front();
  clock.last = video.times.back();
  for (const double time : video.times) clock.times.push_back(time - clock.first);
  const std::vector<double> steps = steps_of(video.times);
  const double period = usual_step(steps);
  constexpr double kMostFrames = 1e9;
  clock.even = is_even(steps, period, video.tick) && clock.times.back() < kMostFrames * period;
  set_numbers(clock, steps, period, video);
  return clock;
}

}  // namespace hypotrack::internal
