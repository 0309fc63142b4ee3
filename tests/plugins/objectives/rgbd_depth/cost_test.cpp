// 4x4 tiles with costs worked out by hand: D in cm, then S, then D + 20 S.
#include <gtest/gtest.h>

#include "depth_scene.hpp"
#include "rgbd_depth.hpp"

namespace hypotrack::rgbd_depth {
namespace {

// The middle four pixels half a metre away; what is around them the sensor did not see.
const Grid kSquare = {0, 0,   0,   0,  //
                      0, 0.5, 0.5, 0,  //
                      0, 0.5, 0.5, 0,  //
                      0, 0,   0,   0};

Grid moved(Grid grid, float by) {
  for (float& z : grid) z = z > 0 ? z + by : 0;
  return grid;
}

Observation square() {
  Observation observation = blank_observation(4);
  observation.views[0].depth = image(kSquare);
  observation.views[0].mask = observation.views[0].depth > 0;
  return observation;
}

double cost(const Observation& observation, const std::vector<Grid>& drawn,
            const Params& params = {}) {
  RgbdDepth objective(params);
  objective.prepare(observation);
  return objective.cost(Drawn(drawn).hypothesis());
}

constexpr double kTolerance = 2e-5;  // eps, and depths of 32 bits

TEST(Cost, OfWhatWasObservedIsZero) { EXPECT_NEAR(cost(square(), {kSquare}), 0, kTolerance); }

TEST(Cost, OfNothingDrawnIsTheClampAndTheWholeSilhouette) {
  EXPECT_NEAR(cost(square(), {Grid(16)}), 4 + 20, kTolerance);
}

TEST(Cost, OfSmallDifferencesIsTheirMeanInCentimetres) {
  EXPECT_NEAR(cost(square(), {moved(kSquare, 0.005f)}), 0.5, kTolerance);
  EXPECT_NEAR(cost(square(), {moved(kSquare, -0.005f)}), 0.5, kTolerance);
  Grid one = kSquare;
  one[5] += 0.008f;
  EXPECT_NEAR(cost(square(), {one}), 0.8 / 4, kTolerance);
}

TEST(Cost, OfDifferencesBeyondTheMatchCountsInBothTerms) {
  EXPECT_NEAR(cost(square(), {moved(kSquare, 0.02f)}), 2 + 20, kTolerance);
  Grid one = kSquare;
  one[5] += 0.02f;  // 3 of 4 match: S = 1 - 6 / 7
  EXPECT_NEAR(cost(square(), {one}), 2.0 / 4 + 20 * (1 - 6.0 / 7), kTolerance);
}

TEST(Cost, OfLargeDifferencesIsClamped) {
  EXPECT_NEAR(cost(square(), {moved(kSquare, 0.05f)}), 4 + 20, kTolerance);
  EXPECT_NEAR(cost(square(), {moved(kSquare, 100)}), 4 + 20, kTolerance);
}

TEST(Cost, OfForegroundThatIsNotCoveredIsTheClamp) {
  Grid two = kSquare;
  two[5] = two[6] = 0;  // D = 2 * 4 / 4, S = 1 - 2 * 2 / (2 + 4)
  EXPECT_NEAR(cost(square(), {two}), 2 + 20 * (1 - 4.0 / 6), kTolerance);
}

TEST(Cost, OfCoveredBackgroundIsTheClampWhateverWasMeasuredThere) {
  Grid six = kSquare;
  six[1] = six[2] = 0.5f;  // D = 2 * 4 / 6, S = 1 - 2 * 4 / (4 + 6)
  const double expected = 8.0 / 6 + 20 * 0.2;
  Observation observation = square();
  EXPECT_NEAR(cost(observation, {six}), expected, kTolerance) << "nothing measured";
  for (const float z : {0.5f, 0.3f, 0.7f, 5.0f, 1e30f}) {
    cv::Mat1f(observation.views[0].depth).row(0).setTo(z);
    EXPECT_NEAR(cost(observation, {six}), expected, kTolerance) << "measured " << z;
  }
}

TEST(Cost, OfAHoleInTheForegroundIsOfTheSilhouetteOnly) {
  Observation observation = square();
  observation.views[0].depth.at<float>(1, 1) = 0;
  EXPECT_NEAR(cost(observation, {kSquare}), 0, kTolerance);
  EXPECT_NEAR(cost(observation, {moved(kSquare, 0.02f)}), 100 * 3 * 0.02 / 4 + 20 * (1 - 2 / 5.0),
              kTolerance);
  Grid uncovered = kSquare;
  uncovered[5] = 0;
  EXPECT_NEAR(cost(observation, {uncovered}), 20 * (1 - 6 / 7.0), kTolerance);
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    observation.views[0].depth.at<float>(1, 1) = bad;
    EXPECT_NEAR(cost(observation, {kSquare}), 0, kTolerance) << bad;
  }
}

TEST(Cost, OutsideOfTheImageNothingCounts) {
  Observation observation = square();
  observation.views[0].valid.row(1).setTo(0);  // half of the square is left
  Grid six = kSquare;
  six[4] = six[7] = 0.5f;
  EXPECT_NEAR(cost(observation, {six}), 0, kTolerance);
  EXPECT_NEAR(cost(observation, {moved(six, 0.005f)}), 0.5, kTolerance);
}

TEST(Cost, WhereNothingWasObservedAndNothingIsDrawnIsLambda) {
  EXPECT_EQ(cost(blank_observation(4), {Grid(16)}), 20);
}

TEST(Cost, SumsOverAllViewsWithDepth) {
  Observation observation = square();
  observation.views.push_back(observation.views[0]);
  // One view 5 mm off, the other empty: D = (4 * 0.5 + 4 * 4) / 8, S = 1 - 2 * 4 / (4 + 8).
  EXPECT_NEAR(cost(observation, {moved(kSquare, 0.005f), Grid(16)}), 18.0 / 8 + 20 * (1 - 8.0 / 12),
              kTolerance);
  EXPECT_NEAR(cost(observation, {kSquare, kSquare}), 0, kTolerance);
}

TEST(Cost, IgnoresViewsWithoutDepth) {
  Observation observation = square();
  TileView color = blank_view(4);
  color.depth.release();
  observation.views.insert(observation.views.begin(), color);
  EXPECT_NEAR(cost(observation, {Grid(16, 0.3f), moved(kSquare, 0.005f)}), 0.5, kTolerance);
}

TEST(Cost, FollowsItsParameters) {
  Params params;
  params.d_max = 0.1;
  params.d_match = 0.06;
  params.lambda = 3;
  EXPECT_NEAR(cost(square(), {moved(kSquare, 0.05f)}, params), 5, kTolerance);
  EXPECT_NEAR(cost(square(), {moved(kSquare, 0.07f)}, params), 7 + 3, kTolerance);
  EXPECT_NEAR(cost(square(), {moved(kSquare, 1)}, params), 10 + 3, kTolerance);
}

TEST(Cost, DefaultsAreThePapers) {
  const Params params;
  EXPECT_DOUBLE_EQ(params.d_max, 0.04);
  EXPECT_DOUBLE_EQ(params.d_match, 0.01);
  EXPECT_EQ(params.lambda, 20);
  EXPECT_EQ(params.lambda_k, 10);
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
