#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "colored_box.hpp"
#include "every_target.hpp"
#include "score.hpp"
#include "skin.hpp"
#include "written_residuals.hpp"

namespace hypotrack::skin {
namespace {

TEST(SkinResiduals, SquaredAddUpToTheCost) {
  Observation observation = colored_box();
  observation.views[1].valid.rowRange(0, 40).setTo(0);
  for (const double spill : {1.0, 0.5, 3.0}) {
    Params params;
    params.spill = spill;
    Skin objective(params);
    objective.prepare(observation);
    ASSERT_EQ(objective.residual_term(), &objective);
    EXPECT_EQ(objective.residual_count(), 2 * 96 * 96);
    for (const cv::Rect& covered :
         {box_outline(), box_outline() + cv::Point(7, -5), cv::Rect(0, 0, 96, 96),
          cv::Rect(11, 3, 61, 2), cv::Rect(0, 0, 0, 0)}) {
      SCOPED_TRACE(testing::Message() << "spill " << spill << ", " << covered);
      const Rectangle hypothesis(observation, covered);
      test::on_every_target(compiled_targets(), [&] {
        const double squares =
            test::sum_of_squares(test::written_residuals(objective, hypothesis.hypothesis()));
        EXPECT_NEAR(squares / objective.cost(hypothesis.hypothesis()), 1, 1e-3);
      });
    }
  }
}

TEST(SkinResiduals, AreOneWhereTheHypothesisIsWrong) {
  Observation observation = colored_box();
  for (TileView& view : observation.views) {
    view.mask = cv::Mat1b(96, 96, uchar{0});
    view.mask(cv::Rect(10, 10, 20, 30)).setTo(255);
  }
  observation.views.pop_back();
  Skin objective({});
  objective.prepare(observation);
  const cv::Rect foreground(10, 10, 20, 30), covered(17, 5, 20, 30);
  const auto found =
      test::written_residuals(objective, Rectangle(observation, covered).hypothesis());
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const bool wrong = foreground.contains({x, y}) != covered.contains({x, y});
      EXPECT_EQ(found[static_cast<std::size_t>(96 * y + x)], wrong ? 1.0f : 0.0f);
    }
  }
}

TEST(SkinResiduals, AreThereForTheViewsThatAreLookedAt) {
  Observation observation = colored_box();
  observation.views[0].color.release();
  Skin objective({});
  objective.prepare(observation);
  EXPECT_EQ(objective.residual_count(), 96 * 96);
  EXPECT_THAT(objective.pixel_views(), testing::ElementsAre(1));
  objective.prepare(colored_box());
  EXPECT_THAT(objective.pixel_views(), testing::ElementsAre(0, 1));
}

TEST(SkinResiduals, DoNotDependOnDepth) {
  const Observation observation = colored_box();
  Skin objective({});
  objective.prepare(observation);
  ASSERT_TRUE(objective.has_slopes());
  const Rectangle hypothesis(observation, box_outline() + cv::Point(7, -5));
  const auto expected = test::written_residuals(objective, hypothesis.hypothesis());
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<float> found(96 * 96), slopes(found.size(), NAN);
    objective.write_slopes(hypothesis.hypothesis(), i, found, slopes);
    const auto* own = expected.data() + i * found.size();
    EXPECT_EQ(found, std::vector<float>(own, own + found.size()));
    EXPECT_EQ(slopes, std::vector<float>(slopes.size(), 0.0f));
  }
}

}  // namespace
}  // namespace hypotrack::skin
