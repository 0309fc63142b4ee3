#include "output/metrics/status_metrics.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "output/metrics/metrics.hpp"

namespace hypotrack {
namespace {

using testing::IsNan;
using enum FrameStatus;

/// Frames of one model.
class Frames {
 public:
  Frames& seen(FrameStatus status, double error_mm) {
    collector_.add(status, {{.status = status, .error_mm = error_mm, .in_view = true}});
    return *this;
  }
  Frames& away(FrameStatus status, int count = 1) {
    for (int i = 0; i < count; ++i) collector_.add(status, {{.status = status, .absent = true}});
    return *this;
  }
  StatusMetrics metrics() const { return collector_.metrics(); }

 private:
  StatusCollector collector_;
};

TEST(StatusMetrics, WordsOfAStatusColumn) {
  EXPECT_EQ(status_named("tracked"), tracked);
  EXPECT_EQ(status_named("absent"), absent);
  EXPECT_EQ(status_named("missing"), missing);
  EXPECT_FALSE(status_named("solved"));
  EXPECT_FALSE(status_named(""));
}

TEST(StatusMetrics, CountsAndShares) {
  const StatusMetrics m =
      Frames().seen(tracked, 1).seen(uncertain, 1).seen(lost, 90).away(absent).metrics();
  EXPECT_EQ(m.judged_frames, 4);
  EXPECT_EQ(m.tracked_frames, 1);
  EXPECT_EQ(m.uncertain_frames, 1);
  EXPECT_EQ(m.said_lost_frames, 1);
  EXPECT_EQ(m.absent_frames, 1);
  EXPECT_DOUBLE_EQ(m.tracked_share, 0.25);
  EXPECT_DOUBLE_EQ(m.absent_share, 0.25);
}

TEST(StatusMetrics, TrackedIsFalseBeyond20MmAndWhereSomethingIsAbsent) {
  const StatusMetrics m = Frames()
                              .seen(tracked, 20)
                              .seen(tracked, 21)
                              .away(tracked)
                              .seen(uncertain, 100)
                              .seen(tracked, std::nan(""))
                              .metrics();
  EXPECT_DOUBLE_EQ(m.false_tracked_share, 2.0 / 3) << "where the truth is known";
}

TEST(StatusMetrics, FramesWithin10MmShouldBeTracked) {
  const StatusMetrics m = Frames()
                              .seen(tracked, 3)
                              .seen(tracked, 10)
                              .seen(uncertain, 9)
                              .seen(lost, 1)
                              .seen(uncertain, 11)
                              .metrics();
  EXPECT_DOUBLE_EQ(m.right_tracked_share, 0.5);
}

TEST(StatusMetrics, AnAbsenceHasTwoFramesOfGrace) {
  EXPECT_THAT(Frames().away(tracked, 2).metrics().absent_tracked_share, IsNan());
  const StatusMetrics m =
      Frames().away(tracked, 3).away(lost, 3).seen(tracked, 1).away(tracked, 2).metrics();
  EXPECT_DOUBLE_EQ(m.absent_tracked_share, 0.25);
}

TEST(StatusMetrics, AReturnIsRecoveredWhenAFrameIsTrackedAndWithin20Mm) {
  Frames frames;
  frames.seen(tracked, 1).away(absent, 3).seen(tracked, 30).seen(tracked, 12);          // in 2
  frames.away(absent).seen(lost, 1).seen(uncertain, 1).seen(lost, 2).seen(tracked, 3);  // in 4
  frames.away(absent);
  for (int i = 0; i < 12; ++i) frames.seen(lost, 50);  // never
  frames.away(absent, 2).seen(tracked, 1);             // in 1
  const StatusMetrics m = frames.metrics();
  EXPECT_EQ(m.returns, 4);
  EXPECT_DOUBLE_EQ(m.recovered_2_share, 0.5);
  EXPECT_DOUBLE_EQ(m.recovered_10_share, 0.75);
  EXPECT_DOUBLE_EQ(m.frames_to_recovery, 7.0 / 3);
}

TEST(StatusMetrics, WithoutAnAbsenceThereIsNoReturn) {
  const StatusMetrics m = Frames().seen(lost, 100).seen(tracked, 1).metrics();
  EXPECT_EQ(m.returns, 0);
  EXPECT_THAT(m.recovered_10_share, IsNan());
  EXPECT_THAT(m.frames_to_recovery, IsNan());
}

TEST(StatusMetrics, WithoutAWordThereIsNothingToJudge) {
  const StatusMetrics m = Frames().seen(solved, 1).away(solved).seen(solved, 50).metrics();
  EXPECT_EQ(m.judged_frames, 0);
  EXPECT_EQ(m.returns, 0);
  EXPECT_THAT(m.tracked_share, IsNan());
  EXPECT_THAT(m.right_tracked_share, IsNan());
}

/// Two models with a landmark each, found 1 and 3 mm off.
class TwoModels {
 public:
  TwoModels& add(FrameStatuses status, std::vector<bool> gone = {},
                 Eigen::Vector2d sigma = {0, 0}) {
    Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Zero(3, 2), estimate = truth;
    estimate.row(0) << 0.001, 0.003;
    for (std::size_t m = 0; m < gone.size(); ++m)
      if (gone[m]) truth.col(static_cast<Eigen::Index>(m)).setConstant(std::nan(""));
    collector_.add(frame_, frame_, status, estimate, truth, gone, sigma);
    ++frame_;
    return *this;
  }
  Metrics metrics() const { return collector_.metrics(); }

 private:
  MetricsCollector collector_{landmark_layout(std::vector<std::string>{"a.x", "b.x"})};
  int frame_ = 0;
};

TEST(StatusMetrics, OfTwoModelsOneMayBeAbsent) {
  const Metrics m = TwoModels()
                        .add({tracked})
                        .add({tracked}, {true, false})
                        .add({uncertain})
                        .add({tracked})
                        .metrics();
  EXPECT_EQ(m.evaluated_frames, 4);
  EXPECT_NEAR(m.mean_error_mm, (2 + 3 + 2 + 2) / 4.0, 1e-9) << "over what is there";
  EXPECT_DOUBLE_EQ(m.status.false_tracked_share, 1.0 / 6);
  EXPECT_DOUBLE_EQ(m.status.right_tracked_share, 5.0 / 7);
  EXPECT_EQ(m.status.returns, 1);
  EXPECT_DOUBLE_EQ(m.status.frames_to_recovery, 2);
}

TEST(StatusMetrics, ModelsAreJudgedOneByOne) {
  const Metrics m = TwoModels()
                        .add({tracked, {tracked, tracked}})
                        .add({lost, {absent, tracked}}, {true, false})
                        .add({lost, {lost, tracked}})
                        .metrics();
  EXPECT_DOUBLE_EQ(m.status.false_tracked_share, 0);
  EXPECT_DOUBLE_EQ(m.status.right_tracked_share, 4.0 / 5);
  EXPECT_EQ(m.status.tracked_frames, 1) << "frames in which all are";
  EXPECT_EQ(m.lost_frames, 1) << "that of a model in view";
}

TEST(StatusMetrics, AbsentIsALossOnlyOfWhatIsInView) {
  const Metrics m = TwoModels().add({absent}, {true, true}).add({absent}).add({tracked}).metrics();
  EXPECT_EQ(m.lost_frames, 1);
  EXPECT_EQ(m.frames_to_loss, 1);
  EXPECT_EQ(m.evaluated_frames, 2);
}

TEST(StatusMetrics, TheLeastMeanSigmaOfLostFrames) {
  EXPECT_THAT(TwoModels().add({tracked}, {}, {0.001, 0.001}).metrics().status.lost_sigma_min_mm,
              IsNan());
  const Metrics m = TwoModels()
                        .add({tracked}, {}, {0.001, 0.001})
                        .add({lost}, {}, {0.06, 0.02})
                        .add({lost}, {}, {std::nan(""), 0.03})
                        .add({lost}, {}, {std::nan(""), std::nan("")})
                        .metrics();
  EXPECT_NEAR(m.status.lost_sigma_min_mm, 20, 1e-9) << "over the landmarks of a model";
}

}  // namespace
}  // namespace hypotrack
