#include "hypotrack/api/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "colored_box.hpp"
#include "skin.hpp"

namespace hypotrack::skin {
namespace {

using testing::HasSubstr;

std::string refusal(const Params& params, const Observation& observation) {
  Skin objective(params);
  try {
    objective.prepare(observation);
  } catch (const DataError& e) {
    return e.what();
  }
  return "no DataError";
}

TEST(SkinErrors, SayWhatNoViewHas) {
  Observation observation = colored_box();
  observation.frame = 12;
  Params params;
  params.foreground = Foreground::mask;
  EXPECT_THAT(refusal(params, observation),
              HasSubstr("objective skin: frame 12 has 2 views, none with a foreground mask"));
  params.foreground = Foreground::depth;
  EXPECT_THAT(refusal(params, observation), HasSubstr("none with depth; use a source that"));
  for (TileView& view : observation.views) view.color.release();
  EXPECT_THAT(refusal({}, observation), HasSubstr("none with a foreground mask or colour"));
}

TEST(SkinErrors, OneViewWithWhatIsAskedForIsEnough) {
  Observation observation = colored_box();
  observation.views[1].color.release();
  EXPECT_EQ(refusal({}, observation), "no DataError");
}

TEST(SkinErrors, ImagesOfAnotherSizeThanTheTileAreErrors) {
  Observation observation = colored_box();
  observation.views[1].mask = cv::Mat1b(8, 8);
  EXPECT_THAT(refusal({}, observation), HasSubstr("the mask of view 1 is 8x8"));
}

TEST(SkinErrors, TilesOfAnotherSizeThanThePreparedFrameAreErrors) {
  const Observation observation = colored_box();
  Skin objective({});
  objective.prepare(observation);
  try {
    objective.cost({});
    FAIL();
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("objective skin"));
    EXPECT_THAT(e.what(), HasSubstr("expected a 96x96 tile as view 0"));
  }
}

}  // namespace
}  // namespace hypotrack::skin
