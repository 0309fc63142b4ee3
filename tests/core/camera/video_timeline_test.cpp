#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/timeline.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A video of these frames of a recording that begins at `start`, without some of them.
VideoInfo video(const std::string& name, int frames, const std::vector<int>& without = {},
                double start = 0, double rate = 30) {
  VideoInfo out{name, 64, 48, rate, {}, 1e-5, true, {}, {}};
  for (int i = 0; i < frames; ++i)
    if (std::ranges::find(without, i) == without.end()) out.times.push_back(start + i / rate);
  return out;
}

std::vector<int> numbers(const VideoTimeline& line) {
  std::vector<int> out;
  for (const TimelineFrame& frame : line.frames) out.push_back(frame.number.value_or(-1));
  return out;
}

/// Numbers of the frames that lack a picture.
std::vector<int> missing(const VideoTimeline& line) {
  std::vector<int> out;
  for (const TimelineFrame& frame : line.frames)
    if (!frame.complete()) out.push_back(frame.number.value_or(-1));
  return out;
}

VideoTimeline pair(const VideoInfo& left, const VideoInfo& right,
                   const TimelineSettings& settings = {}) {
  return make_timeline(std::array{left, right}, settings);
}

/// Largest distance in time of two pictures of a frame.
double farthest(const VideoInfo& left, const VideoInfo& right, const VideoTimeline& line) {
  double out = 0;
  for (const TimelineFrame& f : line.frames)
    if (f.complete())
      out = std::max(out, std::abs(left.times[*f.pictures[0]] - right.times[*f.pictures[1]]));
  return out;
}

TEST(VideoTimeline, AFrameThatOneVideoMissesIsMissingAndOthersPair) {
  const VideoInfo left = video("l", 20, {9, 10}), right = video("r", 20, {5});
  const VideoTimeline line = pair(left, right);
  EXPECT_THAT(missing(line), ElementsAre(5, 9, 10));
  EXPECT_EQ(numbers(line).back(), 19);
  EXPECT_EQ(line.frames.size(), 20);
  EXPECT_LT(farthest(left, right, line), 1e-9);
  EXPECT_NEAR(line.frames[12].time, 12 / 30.0, 1e-12);
  EXPECT_THAT(line.notes, ElementsAre(AllOf(HasSubstr("l has 30 frames per second, r 30;"),
                                            HasSubstr("3 frames have no partner"))));
  EXPECT_EQ(missing_picture(std::array{left, right}, line.frames[5]),
            "r: has no frame at 0.167 s of the recording");
}

TEST(VideoTimeline, AGapInAllVideosIsMissingFrames) {
  const VideoTimeline one = make_timeline(std::array{video("l", 20, {4, 5})}, {});
  EXPECT_THAT(missing(one), ElementsAre(4, 5));
  EXPECT_THAT(one.notes, ElementsAre(HasSubstr("l: 2 frames are missing in the file")));
  const VideoTimeline two = pair(video("l", 20, {7}), video("r", 20, {7}));
  EXPECT_THAT(missing(two), ElementsAre(7));
  EXPECT_EQ(numbers(two).back(), 19);
}

TEST(VideoTimeline, APauseMakesNoFrames) {
  VideoInfo left = video("l", 20);
  for (std::size_t i = 10; i < left.times.size(); ++i) left.times[i] += 3600;
  const VideoTimeline line = make_timeline(std::array{left}, {});
  EXPECT_EQ(line.frames.size(), 20);
  EXPECT_NEAR(line.frames.back().time, 3600 + 19 / 30.0, 1e-6);
}

TEST(VideoTimeline, VariableRatesPairByTheNearestTime) {
  VideoInfo left = video("l", 0), right = video("r", 0);
  double time = 0;
  for (int i = 0; i < 40; ++i) {
    left.times.push_back(time);
    if (i % 7 != 3) right.times.push_back(time + 0.004);
    time += i % 3 == 0 ? 0.033 : i % 3 == 1 ? 0.05 : 0.09;
  }
  const VideoTimeline line = pair(left, right);
  EXPECT_EQ(missing(line).size(), 6);
  EXPECT_NEAR(farthest(left, right, line), 0.004, 1e-9);
  EXPECT_THAT(line.notes, ElementsAre(AllOf(HasSubstr("(variable)"), HasSubstr("at most 4 ms"))));
  EXPECT_NEAR(line.frames[1].time, 0.033, 1e-9);
}

TEST(VideoTimeline, RoundedTimesAreThoseOfTheRate) {
  VideoInfo left = video("l", 60);
  left.tick = 1e-3;
  for (double& time : left.times) time = std::round(1e3 * time) / 1e3;
  const VideoTimeline line = make_timeline(std::array{left}, {});
  EXPECT_EQ(line.frame_rate, 30);
  for (int i = 0; i < 60; ++i)
    EXPECT_DOUBLE_EQ(line.frames[static_cast<std::size_t>(i)].time, i / 30.0);
}

TEST(VideoTimeline, AVideoThatBeginsLaterOnTheSameClockPairsByIt) {
  const VideoInfo right = video("r", 20, {0, 1});
  const VideoTimeline line = pair(video("l", 20), right);
  EXPECT_EQ(line.frames.size(), 18);
  EXPECT_EQ(line.frames[0].number, 2);
  EXPECT_THAT(line.notes, Contains(HasSubstr("begin at 0.000 s and 0.067 s of one clock")));
  EXPECT_EQ(pair(video("l", 300), video("r", 120, {}, 5)).frames[0].number, 150);
}

TEST(VideoTimeline, VideosOfTwoClocksBeginTogether) {
  const VideoTimeline line = pair(video("l", 30), video("r", 30, {}, 5));
  EXPECT_EQ(line.frames.size(), 30);
  EXPECT_THAT(missing(line), IsEmpty());
  EXPECT_THAT(line.notes, Contains(AllOf(HasSubstr("two clocks"), HasSubstr("`offset`"))));
}

TEST(VideoTimeline, AnOffsetSaysWhichFramesBelongTogether) {
  const VideoInfo left = video("l", 20, {6}), right = video("r", 20, {}, 7);
  const VideoTimeline line = pair(left, right, {.offset = 3});
  EXPECT_EQ(line.frames[0].pictures[1], 3);
  EXPECT_THAT(missing(line), ElementsAre(6));
  EXPECT_EQ(line.frames[8].pictures[1], 11);
  EXPECT_EQ(pair(left, right, {.offset = -2}).frames[0].pictures[0], 2);
}

TEST(VideoTimeline, AFasterVideoIsThinnedOut) {
  const VideoTimeline line = pair(video("l", 20), video("r", 40, {}, 0, 60));
  EXPECT_EQ(line.frames.size(), 20);
  EXPECT_THAT(missing(line), IsEmpty());
  EXPECT_EQ(line.frames[7].pictures[1], 14);
}

TEST(VideoTimeline, AFirstVideoThatIsFasterIsThinnedOut) {
  VideoInfo fast = video("f", 40, {}, 0, 60);
  const VideoInfo slow = video("s", 20, {6, 7});
  const VideoTimeline line = pair(fast, slow);
  EXPECT_EQ(line.frames.size(), 20);
  EXPECT_NEAR(line.frame_rate, 30, 1e-9);
  EXPECT_THAT(missing(line), ElementsAre(12, 14));
  EXPECT_NEAR(line.frames[7].time, 7 / 30.0, 1e-9);
  EXPECT_EQ(line.frames[8].pictures[0], 16);
  for (std::size_t i = 1; i < fast.times.size(); i += 2) fast.times[i] -= 0.005;
  EXPECT_LE(missing(pair(fast, slow)).size(), 2);
  EXPECT_THAT(missing(pair(video("f", 400, {}, 0, 60), video("s", 200, {}, 0, 30000 / 1001.0))),
              IsEmpty());
}

TEST(VideoTimeline, AFrameThatAFasterVideoMissesIsMissing) {
  const VideoInfo slow = video("s", 20), fast = video("f", 40, {14, 33}, 0, 60);
  EXPECT_THAT(missing(pair(slow, fast)), ElementsAre(7));
  const VideoTimeline line = pair(fast, slow);
  EXPECT_LE(farthest(fast, slow, line), 0.5 / 60);
  EXPECT_EQ(line.frames.size(), 20);
}

TEST(VideoTimeline, ACloseRatePairsByTime) {
  const VideoInfo left = video("l", 900), right = video("r", 900, {}, 0, 29.8);
  const VideoTimeline line = pair(left, right);
  EXPECT_LE(farthest(left, right, line), 0.5 / 29.8);
  EXPECT_LE(missing(line).size(), 12);
  VideoInfo a = left, b = right;  // containers without times of frames: their rates are rounded
  a.has_clock = b.has_clock = false;
  EXPECT_THAT(missing(pair(a, b)), IsEmpty());
}

TEST(VideoTimeline, AHalfFrameBetweenTheVideosDoesNotAlternate) {
  VideoInfo left = video("l", 60), right = video("r", 60, {}, 0.5 / 30);
  for (VideoInfo* info : {&left, &right}) {
    info->tick = 1e-3;
    for (double& time : info->times) time = std::round(1e3 * time) / 1e3;
  }
  EXPECT_THAT(missing(pair(left, right)), IsEmpty());
}

TEST(VideoTimeline, AGivenRateIgnoresTheTimes) {
  const VideoTimeline line =
      pair(video("l", 20, {6}), video("r", 18, {}, 9, 25), {.offset = 1, .frame_rate = 50});
  EXPECT_EQ(line.frames.size(), 17);
  EXPECT_EQ(line.frame_rate, 50);
  EXPECT_EQ(line.frames[7].pictures[0], 7);
  EXPECT_EQ(line.frames[7].pictures[1], 8);
  EXPECT_DOUBLE_EQ(line.frames[7].time, 7 / 50.0);
}

TEST(VideoTimeline, SaysWhatDoesNotPair) {
  EXPECT_THAT(
      test::message_of<DataError>([] { pair(video("l", 9, {}, 0, 12), video("r", 9, {}, 0, 25)); }),
      AllOf(HasSubstr("l has 12 frames per second, r 25"), HasSubstr("frame by frame")));
  EXPECT_THAT(test::message_of<DataError>(
                  [] { pair(video("l", 20), video("r", 20, {}, 0.01), {.tolerance = 1e-3}); }),
              AllOf(HasSubstr("no two frames within 1 ms"), HasSubstr("10 ms apart")));
}

}  // namespace
}  // namespace hypotrack
