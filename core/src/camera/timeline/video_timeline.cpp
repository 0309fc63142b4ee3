#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/timeline/pair_videos.hpp"
#include "hypotrack/api/timeline.hpp"

namespace hypotrack {
namespace {

/// Adds frames without pictures where numbers are left out; `step` is usual from one to the next.
int fill_gaps(std::vector<TimelineFrame>& frames, double rate, int step) {
  constexpr double kLongest = 10;  // seconds; a longer gap is a pause of the recording
  std::vector<TimelineFrame> filled;
  int added = 0;
  for (TimelineFrame& frame : frames) {
    const std::size_t videos = frame.pictures.size();
    if (!filled.empty() && filled.back().number && frame.number) {
      const TimelineFrame before = filled.back();
      const int gap = (*frame.number - *before.number + (step - 1) / 2) / step;
      if (gap > 1 && gap <= kLongest * rate) added += gap - 1;
      for (int k = 1; k < gap && gap <= kLongest * rate; ++k)
        filled.push_back({before.time + (frame.time - before.time) * k / gap,
                          *before.number + k * step,
                          std::vector<std::optional<std::size_t>>(videos)});
    }
    filled.push_back(std::move(frame));
  }
  frames = std::move(filled);
  return added;
}

/// Adds what lacks in all videos, and says so.
void tell_gaps(std::span<const VideoInfo> videos, VideoTimeline& line, int step) {
  const int added = fill_gaps(line.frames, line.frame_rate, step);
  if (added == 0) return;
  const bool two = videos.size() == 2;
  line.notes.push_back(fmt::format(
      "{}{}: {} frame{} missing in the file{}: there are gaps in the times", videos[0].name,
      two ? " and " + videos[1].name : "", added, added == 1 ? " is" : "s are", two ? "s" : ""));
}

std::string rate_text(const VideoClock& clock) {
  return fmt::format("{:.4g}{}", clock.rate, clock.even ? "" : " (variable)");
}

std::string note_of_pairs(const VideoPair& pair, const std::vector<TimelineFrame>& frames) {
  double farthest = 0;
  int alone = 0;
  for (const TimelineFrame& frame : frames) {
    if (frame.complete())
      farthest = std::max(farthest, pair.distance(frame));
    else
      ++alone;
  }
  std::string out = fmt::format(
      "{} has {} frames per second, {} {}; they are paired by time, and the two of a pair are at "
      "most {:.4g} ms apart",
      pair.videos[0].name, rate_text(pair.left), pair.videos[1].name, rate_text(pair.right),
      std::round(1e6 * farthest) / 1e3);
  if (alone > 0)
    out += fmt::format("; {} frame{} no partner and count{} as missing", alone,
                       alone == 1 ? " has" : "s have", alone == 1 ? "s" : "");
  return out;
}

VideoTimeline of_one(std::span<const VideoInfo> videos, const VideoClock& clock) {
  VideoTimeline out{clock.rate, {}, {}};
  for (std::size_t i = 0; i < clock.times.size(); ++i)
    out.frames.push_back({clock.times[i], static_cast<int>(clock.numbers[i]), {i}});
  if (!clock.even)
    out.notes.push_back(videos[0].name + ": its frame rate varies; times are those of the file");
  tell_gaps(videos, out, 1);
  return out;
}

VideoTimeline of_two(VideoPair pair, const TimelineSettings& settings) {
  const int step = pair.thinning();
  VideoTimeline out{pair.left.rate / step, {}, {}};
  out.frames = pair_frames(pair, settings, out.notes);
  if (!settings.frame_rate) out.notes.push_back(note_of_pairs(pair, out.frames));
  // Which frames of an uneven video are left out follows from the times of the other.
  if (step == 1 || (pair.left.even && pair.right.even)) tell_gaps(pair.videos, out, step);
  return out;
}

}  // namespace

bool TimelineFrame::complete() const {
  return std::ranges::all_of(pictures, [](const auto& picture) { return picture.has_value(); });
}

VideoTimeline make_timeline(std::span<const VideoInfo> videos, const TimelineSettings& settings) {
  const VideoClock left = clock_of(videos[0], settings.frame_rate);
  if (videos.size() == 1) return of_one(videos, left);
  return of_two({videos, left, clock_of(videos[1], settings.frame_rate)}, settings);
}

std::string missing_picture(std::span<const VideoInfo> videos, const TimelineFrame& frame) {
  for (std::size_t v = 0; v < videos.size(); ++v)
    if (!frame.pictures[v])
      return fmt::format("{}: has no frame at {:.3f} s of the recording", videos[v].name,
                         frame.time);
  return {};
}

}  // namespace hypotrack
