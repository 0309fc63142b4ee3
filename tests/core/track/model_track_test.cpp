#include "track/loop/model_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The track of the second of two boxes.
class ModelTrackTest : public testing::Test {
 protected:
  ModelTrack track(bool is_given = true) const {
    return {scene_, 1, landmarks_, scene_.rest_state(), is_given, {}};
  }

  /// Measures of a pose by its probability.
  static StatusMeasures likely(double probability) {
    return {.cost = -1,
            .probability = probability,
            .visible = 1,
            .sigma = std::numeric_limits<double>::quiet_NaN()};
  }
  static StatusMeasures nothing(bool in_view = true) {
    return {.cost = kInfinite, .in_view = in_view};
  }
  /// A state in which the second box is moved.
  Eigen::VectorXd moved_by(double metres) const {
    Eigen::VectorXd state = scene_.rest_state();
    state[scene_.items()[1].offset] += metres;
    return state;
  }
  double x_of(const Eigen::VectorXd& state) const { return state[scene_.items()[1].offset]; }

  std::shared_ptr<Model> box_ = std::make_shared<Model>(test::make_test_box());
  Scene scene_{{{"one", box_}, {"other", box_}}};
  Eigen::Index landmarks_ = std::ssize(box_->data().landmarks);
};

TEST_F(ModelTrackTest, KeepsWhatConfirmedItsPoseWhileItRests) {
  ModelTrack one = track();
  StatusMeasures seen = likely(0.5);
  seen.confirmed = seen.detected = true;
  one.judge(seen);
  EXPECT_FALSE(one.keeps_confirmed() || one.keeps_detected());
  one.rest(true);
  EXPECT_TRUE(one.keeps_confirmed() && one.keeps_detected());
  one.judge(likely(0.5));
  EXPECT_FALSE(one.keeps_confirmed() || one.keeps_detected());
  one.rest(true);
  EXPECT_FALSE(one.keeps_confirmed() || one.keeps_detected()) << "the last search denied it";
}

TEST_F(ModelTrackTest, GoesFromTheGivenStartThroughALossAndBack) {
  ModelTrack one = track();
  EXPECT_EQ(one.phase(), Phase::awaited);
  EXPECT_EQ(one.judge(nothing()), Status::lost);
  EXPECT_EQ(one.phase(), Phase::awaited);
  EXPECT_EQ(one.judge(likely(0.2)), Status::uncertain);
  EXPECT_EQ(one.phase(), Phase::begun);
  EXPECT_EQ(one.judge(likely(0.9)), Status::tracked);
  EXPECT_EQ(one.phase(), Phase::begun) << "until something is learned";
  one.learn();
  EXPECT_EQ(one.phase(), Phase::followed);
  EXPECT_EQ(one.judge(likely(0.3)), Status::uncertain);
  EXPECT_EQ(one.phase(), Phase::doubted);
  EXPECT_EQ(one.judge(nothing()), Status::lost);
  EXPECT_EQ(one.phase(), Phase::lost);
  EXPECT_EQ(one.judge(nothing(false)), Status::absent);
  EXPECT_EQ(one.phase(), Phase::absent);
  EXPECT_EQ(one.judge(likely(0.9)), Status::tracked);
  EXPECT_EQ(one.phase(), Phase::followed);
}

TEST_F(ModelTrackTest, IsSoughtWithoutAStartAndTentativeUntilItIsLearned) {
  ModelTrack one = track(false);
  EXPECT_EQ(one.phase(), Phase::sought);
  one.judge(likely(0.9));
  EXPECT_EQ(one.phase(), Phase::tentative);
  EXPECT_EQ(one.seconds_since_right(1), kInfinite) << "nothing tells where it is";
  one.learn();
  EXPECT_EQ(one.phase(), Phase::followed);
}

TEST_F(ModelTrackTest, NeedsMoreAfterItLeftItsStart) {
  ModelTrack one = track();
  EXPECT_EQ(one.needed(), JudgeThresholds().first_above);
  EXPECT_EQ(track(false).needed(), JudgeThresholds().tracked_above);
  one.leave_start();
  EXPECT_EQ(one.phase(), Phase::sought);
  EXPECT_EQ(one.needed(), JudgeThresholds().certain_above);
}

TEST_F(ModelTrackTest, ExtrapolatesTheLastRightPoseByItsFadingMotion) {
  ModelTrack one = track();
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(12);
  velocity[6] = 0.5;  // metres per second
  one.take(true, moved_by(0.1), velocity, 1);
  one.take(false, moved_by(9), velocity, 2);
  Eigen::VectorXd state = moved_by(3);
  one.write_kept(state);
  EXPECT_EQ(state, moved_by(0.1));
  one.extrapolate(1, state);
  EXPECT_NEAR(x_of(state), x_of(moved_by(0.1)), 1e-12);
  one.extrapolate(1.01, state);
  EXPECT_NEAR(x_of(state), x_of(moved_by(0.105)), 5e-4);
  one.extrapolate(20, state);
  EXPECT_NEAR(x_of(state), x_of(moved_by(0.15)), 1e-12);
  EXPECT_EQ(state.head(scene_.items()[1].offset), moved_by(0).head(scene_.items()[1].offset));
  one.restart();
  one.extrapolate(20, state);
  EXPECT_EQ(state, moved_by(0.1)) << "a search anew expects no motion";
}

TEST_F(ModelTrackTest, IsConfirmedByFramesInWhichItIsRight) {
  ModelTrack one = track();
  EXPECT_FALSE(one.needs_confirmation());
  one.take(false, moved_by(0), {}, 0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(one.needs_confirmation()) << i;
    one.take(true, moved_by(0), {}, 0);
  }
  EXPECT_FALSE(one.needs_confirmation());
}

TEST_F(ModelTrackTest, SearchesAllInTheFirstFourthAndSixteenthFrameOfALoss) {
  ModelTrack one = track();
  const auto times = [&](bool is_detectable) {
    std::vector<int> out;
    for (int i = 1; i <= 20; ++i)
      if (one.is_time_to_search_all(is_detectable)) out.push_back(i);
    return out;
  };
  EXPECT_EQ(times(false), (std::vector<int>{1, 4, 16}));
  one.take(true, moved_by(0), {}, 0);
  EXPECT_EQ(times(false), (std::vector<int>{1, 4, 16}));
}

TEST_F(ModelTrackTest, SearchesAllMoreSeldomForWhatADetectorHasNeverSeen) {
  ModelTrack one = track(false);
  std::vector<int> times;
  for (int i = 1; i <= 70; ++i)
    if (one.is_time_to_search_all(true)) times.push_back(i);
  EXPECT_EQ(times, (std::vector<int>{1, 16, 64}));
}

TEST_F(ModelTrackTest, IsContradictedByTwoChecksInARow) {
  ModelTrack one = track();
  EXPECT_FALSE(one.take_check(true));
  EXPECT_FALSE(one.take_check(false));
  EXPECT_FALSE(one.take_check(true));
  EXPECT_TRUE(one.take_check(true));
  one.forget();
  EXPECT_FALSE(one.take_check(true));
}

TEST_F(ModelTrackTest, RemembersWhenADetectorSawIt) {
  ModelTrack one = track();
  EXPECT_EQ(one.seconds_unseen(3), kInfinite);
  one.see(2);
  EXPECT_EQ(one.seconds_unseen(3), 1);
}

TEST_F(ModelTrackTest, WidensSigmasOfItsLandmarksWhileItHasNoPose) {
  ModelTrack one = track();
  one.judge(likely(0.9));
  one.take(true, moved_by(0), {}, 1);
  Eigen::VectorXd sigma = Eigen::VectorXd::Constant(2 * landmarks_, 0.001);
  one.widen(2, sigma);
  EXPECT_EQ(sigma.maxCoeff(), 0.001);
  one.judge(nothing());
  one.widen(2, sigma);
  EXPECT_EQ(sigma.head(landmarks_).maxCoeff(), 0.001) << "of the other model";
  EXPECT_NEAR(sigma.tail(landmarks_).minCoeff(), 0.33, 1e-12);
  EXPECT_NEAR(one.mean_sigma(sigma), 0.33, 1e-12);
  EXPECT_TRUE(std::isnan(one.mean_sigma({})));
}

TEST_F(ModelTrackTest, WidensSigmasOfHiddenLandmarksByTheTimeSinceTheyWereSeen) {
  ModelTrack one = track();
  std::vector<bool> hidden(static_cast<std::size_t>(2 * landmarks_), false);
  Eigen::VectorXd sigma = Eigen::VectorXd::Zero(2 * landmarks_);
  EXPECT_FALSE(one.widen_hidden({}, true, 1, 0, sigma));
  const Eigen::Index last = 2 * landmarks_ - 1;
  hidden[static_cast<std::size_t>(last)] = true;
  EXPECT_TRUE(one.widen_hidden(hidden, true, 1.2, 0.008, sigma)) << "25 mm over three landmarks";
  EXPECT_NEAR(sigma[last], 0.025, 1e-12);
  EXPECT_EQ(sigma.head(last).maxCoeff(), 0);
  EXPECT_FALSE(one.widen_hidden(hidden, true, 1.2, 0.009, sigma));
  one.widen_hidden(hidden, true, 9, 0, sigma);
  EXPECT_NEAR(sigma[last], 0.08, 1e-12) << "it stays in the hand";
}

}  // namespace
}  // namespace hypotrack
