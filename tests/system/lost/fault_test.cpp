// The real-time tracker on a short rendered sequence with faults of the pictures.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr int kSpoiledFrom = 10;  // frame of the fault

struct SpoiledFrame {
  Status status;
  FrameFault fault;
  int view;
  double error_mm;
};

/// Spoils a frame, given the one before.
using Spoil = std::function<void(Frame&, const Frame&)>;

std::vector<SpoiledFrame> track_spoiled(int frames, int last, const Spoil& spoil,
                                        std::vector<std::string> overrides = {},
                                        int first = kSpoiledFrom) {
  PluginLoader plugins;
  overrides.insert(overrides.end(),
                   {"evaluate.backend=cpu",
                    "source.cameras={width: 640, height: 360, focal_px: 350, baseline_mm: 120}"});
  OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/real_time.yaml", overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  std::optional<SceneTracker> tracker;
  std::vector<SpoiledFrame> out;
  Frame before;
  for (int i = 0; i < frames; ++i) {
    Frame frame = session.source->next().value();
    if (!tracker)
      tracker.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    if (i >= first && i <= last) spoil(frame, before);
    const Solution s = tracker->track(frame);
    out.push_back(
        {s.status, s.fault, s.fault_view,
         1000 * frame_error(layout, scene.landmarks(s.state), scene.landmarks(frame.truth->state))
                    .mean});
    before = std::move(frame);
  }
  return out;
}

std::string text_of_spoiled(const std::vector<SpoiledFrame>& frames) {
  std::string out;
  for (const SpoiledFrame& f : frames)
    out += fmt::format("{}{}{:.1f} ", to_string(f.status).substr(0, 1),
                       f.fault == FrameFault::none ? "" : "!", f.error_mm);
  return out;
}

/// Expects a fault of frames kSpoiledFrom to `last`, of the view if one is given, and nothing of
/// the others, which are tracked about as well as without it.
void expect_skipped(FrameFault fault, std::optional<int> view, int last, const Spoil& spoil,
                    std::vector<std::string> overrides = {}) {
  constexpr int kBack = 6;  // frames after which the hand is tracked again
  const auto frames = track_spoiled(last + 12, last, spoil, std::move(overrides));
  const std::string text = text_of_spoiled(frames);
  for (int i = 0; i < std::ssize(frames); ++i) {
    const SpoiledFrame& f = frames[static_cast<std::size_t>(i)];
    if (i >= kSpoiledFrom && i <= last) {
      EXPECT_EQ(f.fault, fault) << "frame " << i << " of " << text;
      EXPECT_EQ(f.status, Status::missing) << "frame " << i << " of " << text;
      EXPECT_EQ(f.view, view.value_or(f.view)) << "frame " << i << " of " << text;
      continue;
    }
    EXPECT_EQ(f.fault, FrameFault::none) << "frame " << i << " of " << text;
    if (i > kSpoiledFrom && i <= last + kBack) continue;
    EXPECT_EQ(f.status, Status::tracked) << "frame " << i << " of " << text;
    EXPECT_LT(f.error_mm, 5) << "frame " << i << " of " << text;
  }
}

void freeze(Frame& frame, const Frame& before) { frame.views[1] = before.views[1]; }

// The recommended tracker also looks for fingers that have moved meanwhile.
TEST(Fault, AViewThatIsFrozenForASecondIsNotSearched) {
  expect_skipped(FrameFault::frozen, 1, kSpoiledFrom + 29, freeze,
                 {"tracker=@trackers/recommended"});
}

TEST(Fault, ViewsThatAreExchangedForFiveFramesAreNotSearched) {
  expect_skipped(FrameFault::exchanged, {}, kSpoiledFrom + 4,
                 [](Frame& frame, const Frame&) { std::swap(frame.views[0], frame.views[1]); });
}

TEST(Fault, BlackViewsAreNotSearched) {
  expect_skipped(FrameFault::black, 0, kSpoiledFrom + 9, [](Frame& frame, const Frame&) {
    for (View& view : frame.views) view.color = cv::Mat::zeros(view.color.size(), CV_8UC3);
  });
}

TEST(Fault, ASaturatedViewIsNotSearched) {
  expect_skipped(FrameFault::saturated, 1, kSpoiledFrom + 3, [](Frame& frame, const Frame&) {
    frame.views[1].color = cv::Mat(frame.views[1].color.size(), CV_8UC3, cv::Scalar::all(255));
  });
}

TEST(Fault, OnePictureInBothViewsIsNotSearched) {
  expect_skipped(FrameFault::same_picture, {}, kSpoiledFrom + 3, [](Frame& frame, const Frame&) {
    frame.views[1].color = frame.views[0].color.clone();
  });
}

void expect_right(const std::vector<SpoiledFrame>& frames, int first, int last) {
  for (int i = first; i <= last; ++i) {
    const SpoiledFrame& f = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(f.status, Status::tracked) << "frame " << i << " of " << text_of_spoiled(frames);
    EXPECT_LT(f.error_mm, 5) << "frame " << i << " of " << text_of_spoiled(frames);
  }
}

TEST(Fault, AHandIsTrackedThoughAViewIsLower) {
  const auto frames = track_spoiled(
      30, 99,
      [](Frame& frame, const Frame&) {
        const cv::Matx23d down(1, 0, 0, 0, 1, 3);
        cv::Mat moved;
        cv::warpAffine(frame.views[1].color, moved, down, frame.views[1].color.size(),
                       cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        frame.views[1].color = moved;
      },
      {}, 0);
  expect_right(frames, 3, 29);
}

constexpr int kLastBright = kSpoiledFrom + 9;
constexpr int kAgain = 6;  // frames from a jump of brightness on in which the hand may be lost

/// Tracks frames of which those from kSpoiledFrom to kLastBright have some views brighter, and
/// expects both jumps to be named.
std::vector<SpoiledFrame> track_brighter(double gain, std::size_t first_view) {
  const auto frames = track_spoiled(kLastBright + 12, kLastBright, [&](Frame& frame, const Frame&) {
    for (std::size_t v = first_view; v < 2; ++v) {
      cv::Mat brighter;
      frame.views[v].color.convertTo(brighter, -1, gain);
      frame.views[v].color = brighter;
    }
  });
  for (int i = 0; i < std::ssize(frames); ++i)
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].fault,
              i == kSpoiledFrom || i == kLastBright + 1 ? FrameFault::brightness : FrameFault::none)
        << "frame " << i << " of " << text_of_spoiled(frames);
  return frames;
}

TEST(Fault, AHandIsTrackedAcrossJumpsOfBrightness) {
  for (const std::size_t first_view : {0, 1}) {
    const auto frames = track_brighter(1.0 / 3, first_view);
    expect_right(frames, kSpoiledFrom + kAgain, kLastBright);
    expect_right(frames, kLastBright + 1 + kAgain, kLastBright + 11);
  }
}

TEST(Fault, AHandIsTrackedAgainBehindClippedPictures) {
  expect_right(track_brighter(3, 1), kLastBright + 1 + kAgain, kLastBright + 11);
}

}  // namespace
}  // namespace hypotrack
