#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack {

/// The pictures of one moment.
struct TimedFrame {
  std::int64_t time = 0;  ///< of the first view that has a picture, nanoseconds
  std::vector<std::optional<std::size_t>> pictures;  ///< by view: index in its times, or none

  HYPOTRACK_API bool complete() const;  ///< whether every view has a picture
};

/// Returns the index of the nearest time, the earlier of two. `times` must ascend, and not be
/// empty.
HYPOTRACK_API std::size_t nearest_in_time(std::span<const std::int64_t> times, std::int64_t time);

/// Puts the pictures of several views together by their times, nanoseconds that ascend in each
/// view. Pictures are of one frame if each is the other's nearest and they are at most `tolerance`
/// apart. A picture without a partner makes a frame of its own. The frames ascend.
HYPOTRACK_API std::vector<TimedFrame> pair_by_time(std::span<const std::vector<std::int64_t>> views,
                                                   std::int64_t tolerance);

struct TimelineSettings {
  /// Frame of the second video that belongs to frame 0 of the first; negative: the second started
  /// later. Empty: the files' clocks say it.
  std::optional<int> offset{};
  /// Frames per second. If it is given, the files' times are ignored: frames pair by number.
  std::optional<double> frame_rate{};
  /// Largest distance in time within a pair, seconds. Empty: half a frame.
  std::optional<double> tolerance{};
};

/// A moment of one video, or of two that pair by time.
struct TimelineFrame {
  double time = 0;  ///< seconds, on the clock of the first video
  std::optional<int>
      number;  ///< in the first video, gaps counted; nothing between two of its frames
  std::vector<std::optional<std::size_t>> pictures;  ///< by video: index in VideoInfo::times

  /// Returns whether every video has a picture.
  HYPOTRACK_API bool complete() const;
};

/// The frames of one video, or of two from the first to the last pair.
struct VideoTimeline {
  double frame_rate = 0;              ///< frames per second: of the first video if not thinned out
  std::vector<TimelineFrame> frames;  ///< times and numbers grow
  std::vector<std::string> notes;     ///< lines for the user: rates, distances, gaps
};

/// Puts the frames of one or two videos in order. Frames of two videos are a pair if each is the
/// other's nearest in time; one without a partner makes a frame of its own. A gap in an even frame
/// rate makes frames without any picture, if it is at most 10 s long.
///
/// Clocks compare as they are if the videos then overlap; if not, both begin at their first frames.
///
/// Throws DataError if the frame rates do not fit each other, or no two frames are a pair.
HYPOTRACK_API VideoTimeline make_timeline(std::span<const VideoInfo> videos,
                                          const TimelineSettings& settings);

/// Returns why a frame of a timeline lacks a picture, naming the file; empty if it is complete.
HYPOTRACK_API std::string missing_picture(std::span<const VideoInfo> videos,
                                          const TimelineFrame& frame);

}  // namespace hypotrack
