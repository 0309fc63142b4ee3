#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "hypotrack/api/timeline.hpp"

namespace hypotrack {
namespace {

/// Adds the pictures of a view to the frames that they belong to, or as new frames.
void add_view(std::vector<TimedFrame>& frames, std::span<const std::vector<std::int64_t>> views,
              std::size_t view, std::int64_t tolerance) {
  const std::vector<std::int64_t>& pictures = views[view];
  std::vector<std::int64_t> times;
  for (const TimedFrame& frame : frames) times.push_back(frame.time);
  std::vector<TimedFrame> alone;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!times.empty()) {
      const std::size_t k = nearest_in_time(times, pictures[i]);
      if (std::abs(times[k] - pictures[i]) <= tolerance &&
          nearest_in_time(pictures, times[k]) == i) {
        frames[k].pictures[view] = i;
        continue;
      }
    }
    alone.push_back({pictures[i], std::vector<std::optional<std::size_t>>(views.size())});
    alone.back().pictures[view] = i;
  }
  std::vector<TimedFrame> all;
  std::ranges::merge(frames, alone, std::back_inserter(all), {}, &TimedFrame::time,
                     &TimedFrame::time);
  frames = std::move(all);
}

}  // namespace

bool TimedFrame::complete() const {
  return std::ranges::all_of(pictures, [](const auto& picture) { return picture.has_value(); });
}

std::size_t nearest_in_time(std::span<const std::int64_t> times, std::int64_t time) {
  const auto after = std::ranges::lower_bound(times, time);
  const auto index = static_cast<std::size_t>(after - times.begin());
  if (index == 0) return 0;
  if (index == times.size()) return index - 1;
  return time - times[index - 1] <= times[index] - time ? index - 1 : index;
}

std::vector<TimedFrame> pair_by_time(std::span<const std::vector<std::int64_t>> views,
                                     std::int64_t tolerance) {
  std::vector<TimedFrame> frames;
  for (std::size_t view = 0; view < views.size(); ++view) add_view(frames, views, view, tolerance);
  return frames;
}

}  // namespace hypotrack
