#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "color_learner.hpp"
#include "colored_box.hpp"
#include "foreground.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::skin {
namespace {

/// Mean P inside and outside of the box's true outline in the first view.
struct Means {
  double inside = 0, outside = 0;
};

Means means(const ViewForeground& foreground) {
  Means out;
  const cv::Rect box = box_outline();
  int inside = 0, outside = 0;
  for (int y = 0; y < foreground.pixels.height(); ++y) {
    for (int x = 0; x < foreground.pixels.width(); ++x) {
      const double p = (foreground.pixels.row(y)[x] & 0xFFFF) / 65535.0;
      const bool in = box.contains({x, y});
      (in ? out.inside : out.outside) += p;
      ++(in ? inside : outside);
    }
  }
  return {out.inside / inside, out.outside / outside};
}

TEST(SkinColors, AreLearnedUnderThePose) {
  ForegroundEstimator estimator({});
  const Means p = means(estimator.estimate(colored_box(), 0));
  EXPECT_GT(p.inside, 0.95);
  EXPECT_LT(p.outside, 0.05);
}

TEST(SkinColors, AreLearnedUnderAPoseThatIsWrong) {
  Observation observation = colored_box();
  observation.start[0] += 0.012;  // of a box of 60 mm x 40 mm
  observation.start[1] += 0.006;
  ForegroundEstimator estimator({});
  const Means p = means(estimator.estimate(observation, 0));
  EXPECT_GT(p.inside, 0.9);
  EXPECT_LT(p.outside, 0.15);
}

TEST(SkinColors, OfASleeveThatGoesOnOutsideAreInDoubt) {
  Observation observation = colored_box();
  const cv::Rect box = box_outline();
  cv::Mat& color = observation.views[0].color;
  const int top = box.y + box.height * 4 / 5;
  const cv::Rect sleeve(box.x, top, box.width, color.rows - top);
  color(sleeve).setTo(cv::Scalar(10, 10, 10));
  ForegroundEstimator estimator({});
  const ViewForeground seen = estimator.estimate(observation, 0);
  const auto mean = [&](const cv::Rect& where) {
    double sum = 0;
    for (int y = where.y; y < where.br().y; ++y)
      for (int x = where.x; x < where.br().x; ++x)
        sum += (seen.pixels.row(y)[x] & 0xFFFF) / 65535.0;
    return sum / where.area();
  };
  EXPECT_LT(mean(sleeve), 0.7);
  EXPECT_GT(mean({box.x, box.y, box.width, top - box.y}), 0.9);
}

TEST(SkinColors, AreKeptAfterTheFirstFrames) {
  const Observation first = colored_box();
  Observation second = colored_box();
  second.frame = 1;
  second.views[0].color(box_outline()).setTo(cv::Scalar(0, 255, 0));
  ForegroundEstimator once({}), again({.learn_frames = 2});
  once.estimate(first, 0);
  again.estimate(first, 0);
  EXPECT_LT(means(once.estimate(second, 0)).inside, 0.01);
  EXPECT_GT(means(again.estimate(second, 0)).inside, 0.9);
}

TEST(SkinColors, OfAFrameAreLearnedOnce) {
  const Observation observation = colored_box();
  Observation moved = observation;
  moved.start[0] += 1;
  ForegroundEstimator estimator({.learn_frames = 5});
  const double before = estimator.estimate(observation, 0).sum;
  EXPECT_EQ(estimator.estimate(moved, 0).sum, before);
}

TEST(SkinColors, OfAGuessCountForLess) {
  Observation guess = colored_box();
  guess.context.start_is_guess = true;
  ForegroundEstimator sure({}), half({.guess_trust = 0.5}), none({.guess_trust = 0});
  const Means known = means(sure.estimate(colored_box(), 0));
  const Means half_known = means(half.estimate(guess, 0)), unknown = means(none.estimate(guess, 0));
  EXPECT_NEAR(half_known.inside, 0.5 + 0.5 * (known.inside - 0.5), 1e-4);
  EXPECT_NEAR(half_known.outside, 0.5 + 0.5 * (known.outside - 0.5), 1e-4);
  EXPECT_NEAR(unknown.inside, 0.5, 1e-4);
  EXPECT_NEAR(unknown.outside, 0.5, 1e-4);
}

TEST(SkinColors, OfAGuessAreForgottenWhereTheStartIsASolution) {
  Observation guess = colored_box();
  guess.start[0] += 0.03;  // half the box
  guess.context.start_is_guess = true;
  const Observation solution = colored_box();  // of the same frame
  Observation later = colored_box();
  later.frame = 1;
  later.start[0] += 0.03;
  ForegroundEstimator estimator({}), fresh({});
  const double guessed = estimator.estimate(guess, 0).sum;
  const double found = estimator.estimate(solution, 0).sum;
  EXPECT_NE(found, guessed);
  EXPECT_EQ(found, fresh.estimate(solution, 0).sum);
  EXPECT_EQ(estimator.estimate(later, 0).sum, found) << "and what a solution taught is kept";
}

TEST(SkinColors, ThatNoFrameHasShownYetMayBeEither) {
  const Observation entering = colored_box();
  Observation before = colored_box();
  before.frame = -1;
  before.views[0].valid.setTo(0);  // out of the image
  ForegroundEstimator estimator({});
  estimator.estimate(before, 0);
  before.frame = -2;
  before.views[0].valid.colRange(0, 20).setTo(255);  // beside the box
  const Means unknown = means(estimator.estimate(before, 0));
  EXPECT_NEAR(unknown.inside, 0, 1e-6) << "not valid";
  EXPECT_NEAR(unknown.outside, 0.5 * 20 * 96 / (96 * 96 - box_outline().area()), 1e-3);
  const Means p = means(estimator.estimate(entering, 0));
  EXPECT_GT(p.inside, 0.95);
  EXPECT_LT(p.outside, 0.05);
}

TEST(SkinColors, ThatWereNeverSeenAreBackground) {
  Observation observation = colored_box();
  ForegroundEstimator estimator({});
  estimator.estimate(observation, 0);
  observation.views[0].color.setTo(cv::Scalar(0, 255, 0));
  EXPECT_LT(means(estimator.estimate(observation, 0)).inside, 0.01);
}

TEST(SkinColors, DoNotComeFromInvalidPixels) {
  Observation observation = colored_box();
  observation.views[0].valid.colRange(0, 48).setTo(0);
  observation.views[0].color.colRange(0, 48).setTo(cv::Scalar(0, 255, 0));
  ForegroundEstimator estimator({});
  estimator.estimate(observation, 0);
  observation.views[0].valid.setTo(255);
  const ViewForeground all = estimator.estimate(observation, 0);
  EXPECT_LT(all.pixels.row(48)[40] & 0xFFFF, 700u) << "green, inside the box";
}

TEST(SkinColors, OfTheBackgroundAreTakenForItWhereThatIsKnown) {
  Observation observation = colored_box();
  TileView& view = observation.views[0];
  cv::RNG random(3);
  const cv::Rect ground(0, 0, view.color.cols, box_outline().y);  // of the box's colours
  cv::Mat3f noise(ground.size());
  random.fill(noise, cv::RNG::NORMAL, 0, 12);
  cv::Mat(noise + cv::Scalar(80, 100, 170)).convertTo(view.color(ground), CV_8U);
  const auto mean_at_ground = [&](ForegroundEstimator estimator) {
    const ViewForeground seen = estimator.estimate(observation, 0);
    double sum = 0;
    for (int y = 0; y < ground.height; ++y)
      for (int x = 0; x < ground.width; ++x) sum += (seen.pixels.row(y)[x] & 0xFFFF) / 65535.0;
    return sum / ground.area();
  };
  const Settings still{.still_cameras = true};
  const double unknown = mean_at_ground(ForegroundEstimator(still));
  EXPECT_GT(unknown, 0.3);
  cv::cvtColor(view.color, view.background, cv::COLOR_BGR2BGRA);  // alpha 255
  EXPECT_LT(mean_at_ground(ForegroundEstimator(still)), 0.1);
  view.background.setTo(cv::Scalar(0, 0, 0, 0));
  EXPECT_EQ(mean_at_ground(ForegroundEstimator(still)), unknown);
  view.background.setTo(cv::Scalar(20, 20, 20, 255));
  EXPECT_GT(mean_at_ground(ForegroundEstimator(still)), 0.9) << "something stands before it";
}

TEST(SkinColors, SilhouetteOfABoxIsItsOutline) {
  const Observation observation = colored_box();
  const cv::Mat1b covered =
      silhouette(*observation.scene, observation.start, observation.views[0].camera);
  // The nearest face: 60 mm x 40 mm at 0.44 m, 300 px focal length.
  EXPECT_NEAR(box_outline().width, 300 * 0.06 / 0.44, 2);
  EXPECT_NEAR(box_outline().height, 300 * 0.04 / 0.44, 2);
  EXPECT_EQ(cv::countNonZero(covered), box_outline().area());
}

}  // namespace
}  // namespace hypotrack::skin
