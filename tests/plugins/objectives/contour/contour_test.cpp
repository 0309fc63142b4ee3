#include "contour.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>

#include "box_pictures.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_models.hpp"

namespace hypotrack::contour {
namespace {

using testing::HasSubstr;

class ContourTest : public testing::Test {
 protected:
  /// Lets the objective learn the box's colours where the box is.
  void teach(Contour& objective) {
    objective.prepare(pictures_.seen(pictures_.state(), pictures_.state()));
  }
  /// Returns a later frame of the box as one view or both see it.
  Observation later(const std::vector<int>& views, const Eigen::VectorXd& start) {
    Observation all = pictures_.seen(pictures_.state(), start);
    Observation out = all;
    out.frame = 1;
    out.views.clear();
    for (const int view : views) out.views.push_back(all.views[static_cast<std::size_t>(view)]);
    return out;
  }
  /// Returns how far from the truth the objective's start is, which learned from the same views.
  double error_from(const Eigen::VectorXd& start, const std::vector<int>& views) {
    const auto objective = pictures_.objective();
    Observation first = later(views, pictures_.state());
    first.frame = 0;
    objective->prepare(first);
    objective->prepare(later(views, start));
    return corner_distance_mm(objective->refined_start(), pictures_.state());
  }

  BoxPictures& pictures_ = box_pictures();
};

TEST_F(ContourTest, RefinesAStartWithTwoViews) {
  EXPECT_LT(error_from(pictures_.state(), {0, 1}), 0.5);
  EXPECT_LT(error_from(pictures_.displaced({0.01, -0.008, 0.01}, {0.05, 0.05, -0.08}), {0, 1}),
            0.7);
  EXPECT_LT(error_from(pictures_.displaced({-0.01, 0.01, -0.01}, {0, -0.1, 0.05}), {0, 1}), 0.7);
}

TEST_F(ContourTest, RefinesAStartWithOneCamera) {
  const Eigen::VectorXd off = pictures_.displaced({0.006, -0.005, 0.004}, {0.02, 0, -0.03});
  const double start = corner_distance_mm(off, pictures_.state());
  for (const int view : {0, 1}) {
    EXPECT_LT(error_from(pictures_.state(), {view}), 2);
    EXPECT_LT(error_from(off, {view}), 0.6 * start);  // mostly along the line of sight
  }
}

TEST_F(ContourTest, RefinesAStartWithOneCameraAndDepth) {
  const auto objective = pictures_.objective(0.002);
  Observation first = later({0}, pictures_.state());
  first.frame = 0;
  objective->prepare(first);
  objective->prepare(later({0}, pictures_.displaced({0.006, -0.005, 0.004}, {0.02, 0, -0.03})));
  EXPECT_LT(corner_distance_mm(objective->refined_start(), pictures_.state()), 0.6);
}

TEST_F(ContourTest, IgnoresDepthOfWhatIsBeforeTheModel) {
  const auto objective = pictures_.objective(0.002);
  Observation first = later({0}, pictures_.state());
  first.frame = 0;
  objective->prepare(first);
  Observation hidden = later({0}, pictures_.state());
  hidden.views[0].depth(cv::Rect(0, 0, 80, 160)).setTo(0.3);
  objective->prepare(hidden);
  EXPECT_LT(corner_distance_mm(objective->refined_start(), pictures_.state()), 0.8);
}

TEST_F(ContourTest, MissesDepthWhereItIsAskedForIt) {
  const auto objective = pictures_.objective(0.002);
  Observation seen = pictures_.seen(pictures_.state(), pictures_.state());
  seen.views[0].depth.release();
  objective->prepare(seen);  // one view is enough
  seen.views[1].depth.release();
  EXPECT_THAT(test::message_of<DataError>([&] { objective->prepare(seen); }),
              testing::AllOf(HasSubstr("none with depth"), HasSubstr("leave depth_sigma_mm out")));
}

TEST_F(ContourTest, FollowsABoxThatIsHalfHiddenByOtherColours) {
  const auto objective = pictures_.objective();
  teach(*objective);
  const Eigen::VectorXd start = pictures_.displaced({0.005, 0, 0.003}, {0.03, 0, -0.03});
  for (const int covered : {50, 60, 70}) {
    Observation hidden = later({0, 1}, start);
    for (TileView& view : hidden.views)
      view.color(cv::Rect(0, 0, covered, view.color.rows)).setTo(cv::Scalar(40, 200, 90));
    objective->prepare(hidden);
    EXPECT_LT(corner_distance_mm(objective->refined_start(), pictures_.state()), 6) << covered;
  }
}

TEST_F(ContourTest, SkipsLinesBehindColoursThatItNeverSaw) {
  const auto objective = pictures_.objective();
  teach(*objective);
  const std::int64_t all = objective->residual_count();
  Observation hidden = later({0, 1}, pictures_.state());
  for (TileView& view : hidden.views)
    view.color(cv::Rect(0, 0, 70, view.color.rows)).setTo(cv::Scalar(40, 200, 90));
  objective->prepare(hidden);
  EXPECT_LT(objective->residual_count(), 0.8 * static_cast<double>(all));
  EXPECT_GT(objective->residual_count(), 0.2 * static_cast<double>(all));
}

TEST_F(ContourTest, CostsLeastAboutWhereTheBoxIs) {
  const auto objective = pictures_.objective();
  teach(*objective);
  const Observation seen = later({0, 1}, pictures_.displaced({0.004, 0, 0}, {0, 0, 0}));
  objective->prepare(seen);
  const auto cost = [&](const Eigen::VectorXd& state) {
    return objective->cost({test::values_of(state), {}});
  };
  const double least = cost(pictures_.state());
  for (const double off : {-0.004, 0.004}) {
    EXPECT_GT(cost(pictures_.displaced({off, 0, 0}, {0, 0, 0})), 1.5 * least);
    EXPECT_GT(cost(pictures_.displaced({0, off, 0}, {0, 0, 0})), 1.5 * least);
    EXPECT_GT(cost(pictures_.displaced({0, 0, 2 * off}, {0, 0, 0})), 1.2 * least);
    EXPECT_GT(cost(pictures_.displaced({0, 0, 0}, {0, 0, 10 * off})), 1.2 * least);
  }
}

TEST_F(ContourTest, ViewsCountEquallyInAnyOrder) {
  const Eigen::VectorXd start = pictures_.displaced({0.004, 0, 0}, {0, 0.02, 0});
  const auto refined = [&](const std::vector<int>& views) {
    const auto objective = pictures_.objective();
    Observation first = later(views, pictures_.state());
    first.frame = 0;
    objective->prepare(first);
    objective->prepare(later(views, start));
    return objective->refined_start();
  };
  EXPECT_LT(corner_distance_mm(refined({0, 1}), refined({1, 0})), 1e-3);
}

TEST_F(ContourTest, LooksAtViewsWithColourOnly) {
  const auto objective = pictures_.objective();
  Observation seen = pictures_.seen(pictures_.state(), pictures_.state());
  seen.views[0].color.release();
  objective->prepare(seen);
  const std::int64_t one = objective->residual_count();
  EXPECT_GT(one, 100);
  seen.views[1].color.release();
  EXPECT_THAT(test::message_of<DataError>([&] { objective->prepare(seen); }),
              HasSubstr("frame 0 has 2 views, none with colour"));
}

TEST_F(ContourTest, LearnsAFrameOnceItsAnswerIsKnown) {
  const auto objective = pictures_.objective();
  teach(*objective);
  const Eigen::VectorXd start = pictures_.displaced({0.004, 0, 0}, {0, 0, 0});
  const auto cost_of = [&](int frame, const cv::Scalar& light, int previous) {
    Observation seen = later({0, 1}, start);
    seen.frame = frame;
    for (TileView& view : seen.views) view.color = view.color + light;
    if (previous >= 0)
      seen.context.previous = std::make_shared<PreviousSolution>(
          PreviousSolution{previous, 0, 0, pictures_.state(), {}});
    objective->prepare(seen);
    return objective->refined_start();
  };
  const Eigen::VectorXd dark = cost_of(1, cv::Scalar::all(0), -1);
  EXPECT_EQ(cost_of(1, cv::Scalar::all(0), -1), dark);  // the same frame again
  cost_of(2, cv::Scalar::all(40), 1);                   // brighter; learns frame 1
  const Eigen::VectorXd once = cost_of(3, cv::Scalar::all(40), 2);
  EXPECT_EQ(cost_of(3, cv::Scalar::all(40), 2), once);  // frame 2 was learned already
  EXPECT_LT(corner_distance_mm(once, pictures_.state()), 1);
}

TEST_F(ContourTest, LearnsAnewAfterAGuess) {
  const auto objective = pictures_.objective();
  const Eigen::VectorXd guess = pictures_.displaced({0.02, 0.02, 0}, {0, 0, 0.3});
  Observation first = pictures_.seen(pictures_.state(), guess);
  first.context.start_is_guess = true;
  objective->prepare(first);
  teach(*objective);
  const auto fresh = pictures_.objective();
  teach(*fresh);
  EXPECT_EQ(objective->refined_start(), fresh->refined_start());
}

TEST_F(ContourTest, StaysWhereTheModelIsNotSeen) {
  const auto objective = pictures_.objective();
  teach(*objective);
  const Eigen::VectorXd away = pictures_.displaced({0.4, 0, 0}, {0, 0, 0});
  objective->prepare(later({0, 1}, away));
  EXPECT_LT(corner_distance_mm(objective->refined_start(), away), 1e-6);
  EXPECT_EQ(objective->residual_count(), 0);
}

TEST(ContourOfModels, WithJointsCostsNothing) {
  const Scene hand({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  Contour objective({}, hand);
  Observation seen = box_pictures().seen(box_pictures().state(), box_pictures().state());
  seen.scene = &hand;
  seen.start = hand.rest_state();
  objective.prepare(seen);
  EXPECT_EQ(objective.residual_count(), 0);
  EXPECT_EQ(objective.refined_start(), seen.start);
  EXPECT_EQ(objective.cost({test::values_of(seen.start), {}}), 0);
}

}  // namespace
}  // namespace hypotrack::contour
