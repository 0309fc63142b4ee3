#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "subject.hpp"

namespace hypotrack::contract {
namespace {

// Enough to judge a source; a recording may be long.
constexpr int kMostFrames = 20;
constexpr int kLongest = 500;

std::vector<Frame> read(Source& source, int at_most) {
  std::vector<Frame> frames;
  while (static_cast<int>(frames.size()) < at_most) {
    auto frame = source.next();
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

std::string name(const Frame& frame) { return "frame " + std::to_string(frame.index); }

void check_cameras(const Source& source) {
  require(!source.cameras().empty(), "it has no cameras");
  for (std::size_t i = 0; i < source.cameras().size(); ++i) {
    validate(source.cameras()[i], "camera " + std::to_string(i));
  }
}

void check_views(const Frame& frame) {
  if (frame.views.empty()) {
    require(frame.problem.find("this is a bug") == std::string::npos,
            name(frame) + ": " + frame.problem);
    return;
  }
  require(frame.problem.empty(),
          name(frame) + " has views and a problem (" + frame.problem + "), expected one of them");
  for (std::size_t i = 0; i < frame.views.size(); ++i) {
    const cv::Mat& depth = frame.views[i].depth;
    require(depth.empty() || cv::checkRange(depth, true, nullptr, 0, 1e6),
            name(frame) + ", view " + std::to_string(i) +
                ": depth is negative or not finite, expected metres, or 0 where not measured");
  }
}

void check_order(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames)
    require(frame.fault != FrameFault::time_back,
            name(frame) + " is not later than the one before it; expected times that grow");
}

void check_truth(const Scene& scene, const Frame& frame) {
  if (!frame.truth) return;
  const GroundTruth& truth = *frame.truth;
  require(truth.state.size() == 0 || truth.state.size() == scene.dimension(),
          name(frame) + ": the true state has " + std::to_string(truth.state.size()) +
              " numbers, expected " + std::to_string(scene.dimension()));
  require(truth.state.allFinite(), name(frame) + ": the true state is not finite");
  const auto landmarks = static_cast<Eigen::Index>(scene.landmark_names().size());
  require(truth.landmarks.cols() == 0 || truth.landmarks.cols() == landmarks,
          name(frame) + ": there are " + std::to_string(truth.landmarks.cols()) +
              " true landmarks, expected " + std::to_string(landmarks));
}

void check_end(Source& source) {
  const auto count = source.frame_count();
  if (!count) throw Skipped("it does not say how many frames there are");
  if (*count > kLongest) {
    throw Skipped("it has " + std::to_string(*count) + " frames, too many to read here");
  }
  const std::vector<Frame> frames = read(source, *count + 1);
  require(static_cast<int>(frames.size()) == *count,
          "it promises " + std::to_string(*count) + " frames and gives " +
              (static_cast<int>(frames.size()) > *count ? "more" : std::to_string(frames.size())));
  require(!source.next() && !source.next(), "frames come after the end");
}

bool same_image(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0);
}

void check_same(const Frame& a, const Frame& b) {
  require(a.index == b.index && a.time == b.time && a.views.size() == b.views.size() &&
              a.problem == b.problem,
          name(a) + " differs in number, time, views or problem");
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    require(same_image(a.views[i].color, b.views[i].color) &&
                same_image(a.views[i].mask, b.views[i].mask) &&
                same_image(a.views[i].depth, b.views[i].depth),
            name(a) + ", view " + std::to_string(i) + ": the pictures differ");
  }
}

}  // namespace

void check_source(Report& report, const Subject& subject) {
  if (!check_parameters<Source>(report, subject, true)) return;
  const auto source = subject.make<Source>();
  report.row("its cameras are valid", [&] { check_cameras(*source); });
  report.row("its frame rate is positive", [&] {
    require(source->frame_rate() > 0 && std::isfinite(source->frame_rate()),
            "it is " + std::to_string(source->frame_rate()));
  });
  std::vector<Frame> frames;
  report.row("it yields frames, with a picture of the right size for each camera", [&] {
    frames = read(*source, kMostFrames);
    require(!frames.empty(), "there is none");
  });
  if (frames.empty()) return;
  report.row("every frame has pictures, or a problem", [&] {
    for (const Frame& frame : frames) check_views(frame);
  });
  report.row("times of frames grow", [&] { check_order(frames); });
  report.row("ground truth fits the scene", [&] {
    for (const Frame& frame : frames) check_truth(*subject.scene, frame);
  });
  report.row("pictures belong to their frame", [&] {
    const auto other = subject.make<Source>();
    auto first = other->next();
    require(first.has_value(), "a second object yields no frame");
    other->next();
    check_same(frames[0], *first);  // not drawn over by the second frame
  });
  report.row("a second object yields the same frames", [&] {
    const auto second = subject.make<Source>();
    const std::vector<Frame> again = read(*second, kMostFrames);
    require(again.size() == frames.size(), "it yields " + std::to_string(again.size()) +
                                               " frames, expected " +
                                               std::to_string(frames.size()));
    for (std::size_t i = 0; i < frames.size(); ++i) check_same(frames[i], again[i]);
  });
  report.row("it ends where it says", [&] { check_end(*subject.make<Source>()); });
}

}  // namespace hypotrack::contract
