#include "hypotrack/video_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/timeline/pair_videos.hpp"

namespace hypotrack {
namespace {

/// Adds frames without pictures where numbers are left out.
int fill_gaps(std::vector<TimelineFrame>& frames, double rate) {
  constexpr double kLongest = 10;  // seconds; a longer gap is a pause of the recording
  std::vector<TimelineFrame> filled;
  int added = 0;
  for (TimelineFrame& frame : frames) {
    const std::size_t videos = frame.pictures.size();
    if (!filled.empty() && filled.back().number && frame.number) {
      const TimelineFrame before = filled.back();
      const int gap = *frame.number - *before.number;
      if (gap > 1 && gap <= kLongest * rate) added += gap - 1;
      for (int k = 1; k < gap && gap <= kLongest * rate; ++k)
        filled.push_back({before.time + (frame.time - before.time) * k / gap, *before.number + k,
                          std::vector<std::optional<std::size_t>>(videos)});
    }
    filled.push_back(std::move(frame));
  }
  frames = std::move(filled);
  return added;
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

VideoTimeline of_one(const VideoInfo& video, const VideoClock& clock) {
  VideoTimeline out{clock.rate, {}, {}};
  for (std::size_t i = 0; i < clock.times.size(); ++i)
    out.frames.push_back({clock.times[i], static_cast<int>(clock.numbers[i]), {i}});
  if (!clock.even)
    out.notes.push_back(video.name + ": its frame rate varies; times are those of the file");
  return out;
}

VideoTimeline of_two(VideoPair pair, const TimelineSettings& settings) {
  VideoTimeline out{pair.left.rate, {}, {}};
  out.frames = pair_frames(pair, settings, out.notes);
  if (!settings.frame_rate) out.notes.push_back(note_of_pairs(pair, out.frames));
  return out;
}

}  // namespace

bool TimelineFrame::complete() const {
  return std::ranges::all_of(pictures, [](const auto& picture) { return picture.has_value(); });
}

VideoTimeline make_timeline(std::span<const VideoInfo> videos, const TimelineSettings& settings) {
  const VideoClock left = clock_of(videos[0], settings.frame_rate);
  VideoTimeline out =
      videos.size() == 1
          ? of_one(videos[0], left)
          : of_two({videos, left, clock_of(videos[1], settings.frame_rate)}, settings);
  if (const int added = fill_gaps(out.frames, out.frame_rate); added > 0)
    out.notes.push_back(
        fmt::format("{}{}: {} frame{} missing in the file{}: there are gaps in the times",
                    videos[0].name, videos.size() == 2 ? " and " + videos[1].name : "", added,
                    added == 1 ? " is" : "s are", videos.size() == 2 ? "s" : ""));
  return out;
}

std::string missing_picture(std::span<const VideoInfo> videos, const TimelineFrame& frame) {
  for (std::size_t v = 0; v < videos.size(); ++v)
    if (!frame.pictures[v])
      return fmt::format("{}: has no frame at {:.3f} s of the recording", videos[v].name,
                         frame.time);
  return {};
}

}  // namespace hypotrack
