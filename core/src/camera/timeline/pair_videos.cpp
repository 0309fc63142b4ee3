#include "camera/timeline/pair_videos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/timeline.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kFaster = 1.5;     // a faster video is thinned out
constexpr double kSameRate = 0.01;  // tolerated difference of rates, which are rounded or means

bool about_equal(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance * a; }

/// Returns how many times one rate is the other, as a whole number.
double multiple(double a, double b) { return std::round(std::max(a, b) / std::min(a, b)); }

std::int64_t nanoseconds(double seconds) {
  constexpr double kFarthest = 4e9;  // seconds; differences do not overflow
  return std::llround(1e9 * std::clamp(seconds, -kFarthest, kFarthest));
}

/// Returns whether both have the same even rate: then distances do not change.
bool one_grid(const VideoPair& pair) {
  if (!pair.left.exact || !pair.right.exact) return false;
  const bool rates_only = !pair.videos[0].has_clock && !pair.videos[1].has_clock;
  return about_equal(pair.left.rate, pair.right.rate, rates_only ? kSameRate : 1e-6);
}

void check_rates(const VideoPair& pair) {
  const double a = pair.left.rate, b = pair.right.rate;
  if (!pair.left.even || !pair.right.even) return;
  if (about_equal(std::max(a, b), multiple(a, b) * std::min(a, b), kSameRate)) return;
  throw DataError(
      fmt::format("{} has {:.4g} frames per second, {} {:.4g}; expected equal ones, or one a "
                  "multiple of the other, since videos are paired frame by frame. Convert one of "
                  "them, or give `frame_rate` if what the files say is wrong",
                  pair.videos[0].name, a, pair.videos[1].name, b));
}

/// Returns half a frame of the slower video, but less than a frame of an even faster one: it would
/// take the neighbour of a frame that is missing.
double usual_tolerance(const VideoPair& pair) {
  const double half = 0.5 / pair.slower();
  const double faster = std::max(pair.left.rate, pair.right.rate);
  return pair.left.even && pair.right.even ? std::min(half, 0.75 / faster) : half;
}

/// Sets the shift between two clocks from their starts. Returns a note, or an empty text.
std::string relate_clocks(VideoPair& pair) {
  const VideoClock &a = pair.left, &b = pair.right;
  const double apart = b.first - a.first;
  const double overlap = std::min(a.last, b.last) - std::max(a.first, b.first);
  const double shorter = std::min(a.last - a.first, b.last - b.first);
  const bool one_clock =
      overlap >= 0.9 * shorter || (std::abs(apart) < 1 && overlap >= 0.5 * shorter);
  const std::string names = fmt::format("{} and {}", pair.videos[0].name, pair.videos[1].name);
  if (!one_clock) {
    pair.shift = apart;
    return fmt::format(
        "{} begin at {:.3f} s and {:.3f} s of their clocks, which are two clocks; their first "
        "frames are taken as a pair: give `offset` if they are none",
        names, a.first, b.first);
  }
  if (std::abs(apart) * pair.slower() < 0.5) return {};
  return fmt::format(
      "{} begin at {:.3f} s and {:.3f} s of one clock; what only one of them shows is left out. "
      "Give `offset` if their clocks are not one",
      names, a.first, b.first);
}

/// Sets the shift so that frame `offset` of the right video belongs to frame 0 of the left one.
void apply_offset(VideoPair& pair, int offset) {
  const auto time = [](const VideoClock& clock, int frame) {
    const std::size_t last = clock.times.size() - 1;
    return clock.first + clock.times[std::min(static_cast<std::size_t>(frame), last)];
  };
  pair.shift = time(pair.right, std::max(offset, 0)) - time(pair.left, std::max(-offset, 0));
}

/// Pairs on the common grid of frame numbers, whose phase is that of the first frames.
std::vector<TimelineFrame> pair_numbers(const VideoPair& pair) {
  const double ahead = pair.right_time(0) * pair.left.rate;  // frames
  const std::int64_t shift = std::lround(ahead);
  std::vector<std::vector<std::int64_t>> numbers{pair.left.numbers, pair.right.numbers};
  for (std::int64_t& number : numbers[1]) number += shift;
  std::vector<TimelineFrame> out;
  const bool far = std::abs(ahead - static_cast<double>(shift)) > pair.tolerance * pair.left.rate;
  for (const TimedFrame& frame : pair_by_time(numbers, far ? -1 : 0))
    out.push_back({static_cast<double>(frame.time) / pair.left.rate, static_cast<int>(frame.time),
                   frame.pictures});
  return out;
}

std::vector<TimelineFrame> pair_times(const VideoPair& pair) {
  std::vector<std::vector<std::int64_t>> times(2);
  for (const double time : pair.left.times) times[0].push_back(nanoseconds(time));
  for (std::size_t i = 0; i < pair.right.times.size(); ++i)
    times[1].push_back(nanoseconds(pair.right_time(i)));
  std::vector<TimelineFrame> out;
  for (const TimedFrame& frame : pair_by_time(times, nanoseconds(pair.tolerance))) {
    TimelineFrame added{1e-9 * static_cast<double>(frame.time), {}, frame.pictures};
    if (const auto left = frame.pictures[0]) {
      added.time = pair.left.times[*left];
      added.number = static_cast<int>(pair.left.numbers[*left]);
    }
    out.push_back(std::move(added));
  }
  return out;
}

/// Throws DataError because no two frames are a pair.
[[noreturn]] void no_pairs(const VideoPair& pair) {
  std::vector<double> apart;
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < pair.right.times.size(); ++i)
    times.push_back(nanoseconds(pair.right_time(i)));
  for (const double time : pair.left.times)
    apart.push_back(std::abs(time - pair.right_time(nearest_in_time(times, nanoseconds(time)))));
  throw DataError(
      fmt::format("{} and {} have no two frames within {:.4g} ms of each other; the nearest are "
                  "{:.4g} ms apart in the median. Expected videos of the same time; if they are, "
                  "give `offset`, or `frame_rate` to pair them by number",
                  pair.videos[0].name, pair.videos[1].name, 1e3 * pair.tolerance,
                  1e3 * upper_median(std::move(apart))));
}

/// Keeps the frames from the first to the last pair, and of a faster video only those in pairs.
void keep_pairs(std::vector<TimelineFrame>& frames, const VideoPair& pair) {
  const double ratio = pair.left.rate / pair.right.rate;
  std::erase_if(frames, [&](const TimelineFrame& frame) {
    return (ratio > kFaster && !frame.pictures[1]) || (ratio < 1 / kFaster && !frame.pictures[0]);
  });
  const auto first = std::ranges::find_if(frames, &TimelineFrame::complete);
  if (first == frames.end()) no_pairs(pair);
  frames.erase(frames.begin(), first);
  while (!frames.back().complete()) frames.pop_back();
}

/// Numbers frames that stand in a gap of the first video.
void number_between(std::vector<TimelineFrame>& frames) {
  std::optional<int> next;
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    if (frame->number) next = frame->number;
    if (frame->number || !next) continue;
    const auto before = std::find_if(frame, frames.rend(),
                                     [](const TimelineFrame& f) { return f.number.has_value(); });
    if (before == frames.rend() || *before->number + 1 >= *next) continue;
    frame->number = next = *next - 1;
  }
}

}  // namespace

double VideoPair::slower() const { return std::min(left.rate, right.rate); }

int VideoPair::thinning() const {
  const double ratio = left.rate / right.rate;
  return ratio > kFaster ? static_cast<int>(std::lround(ratio)) : 1;
}

double VideoPair::right_time(std::size_t i) const {
  return right.first + right.times[i] - shift - left.first;
}

double VideoPair::distance(const TimelineFrame& frame) const {
  return std::abs(left.times[*frame.pictures[0]] - right_time(*frame.pictures[1]));
}

std::vector<TimelineFrame> pair_frames(VideoPair& pair, const TimelineSettings& settings,
                                       std::vector<std::string>& notes) {
  if (!settings.frame_rate) check_rates(pair);
  pair.tolerance = settings.tolerance.value_or(usual_tolerance(pair));
  if (settings.offset || settings.frame_rate)
    apply_offset(pair, settings.offset.value_or(0));
  else if (std::string note = relate_clocks(pair); !note.empty())
    notes.push_back(std::move(note));
  std::vector<TimelineFrame> frames = one_grid(pair) ? pair_numbers(pair) : pair_times(pair);
  keep_pairs(frames, pair);
  if (pair.left.even) number_between(frames);
  return frames;
}

}  // namespace hypotrack::internal
