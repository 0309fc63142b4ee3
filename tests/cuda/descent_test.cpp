// Searches by least squares whose steps stay on the GPU against those that the host drives.
#include <gtest/gtest.h>

#include <cmath>

#include "device.hpp"
#include "device_scores.hpp"
#include "hypotrack/gpu/device_cost.hpp"
#include "levenberg_marquardt.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "plausible_motion.hpp"
#include "rgbd_depth.hpp"
#include "skin.hpp"
#include "stereo_color.hpp"
#include "stereo_patch.hpp"
#include "track/search/search_cost.hpp"

namespace hypotrack {
namespace {

/// A cost whose searches the host drives.
class DrivenByHost final : public CostFunction {
 public:
  explicit DrivenByHost(CostFunction& cost) : cost_(cost) {}
  int dimension() const override { return cost_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    cost_.evaluate(points, costs);
  }
  ResidualCost* residuals() override { return cost_.residuals(); }

 private:
  CostFunction& cost_;
};

std::vector<ObjectiveTerm> terms_with_slopes(const Scene& scene) {
  stereo_color::Params color;
  color.beta = 2;  // the made-up views are not that alike
  color.direction = stereo_color::Direction::both;
  return {{1, std::make_shared<stereo_color::StereoColor>(color), "stereo_color"},
          {0.04,
           std::make_shared<plausible_motion::PlausibleMotion>(
               plausible_motion::PlausibleMotionParams{}, scene),
           "plausible_motion"},
          {0.3, std::make_shared<skin::Skin>(skin::Params{}), "skin"},
          {2, std::make_shared<stereo_patch::StereoPatch>(stereo_patch::Params{}), "stereo_patch"}};
}

/// Searches of a frame, about a state.
class Searches {
 public:
  Searches(const Scene& scene, std::vector<ObjectiveTerm> terms,
           RotationCoordinates rotation_as = RotationCoordinates::tangent)
      : scene_(scene),
        space_(scene_, settings(rotation_as)),
        cost_(make_cost(scene_, std::move(terms), {.backend = Backend::cuda},
                        {.least_squares = true})) {
    prepare(128);
  }
  void prepare(int size) {
    frame_ = test::with_depth(test::colored(test::rectified_pair(scene_, size)));
    frame_.start = test::scored_states(scene_).col(0);
    cost_->prepare(frame_);
  }

  OptimizerResult on_device(LevenbergMarquardt& optimizer, std::int64_t evaluations, int state) {
    const Eigen::VectorXd prior = test::scored_states(scene_).col(state);
    SearchCost cost(*cost_, space_, prior);
    const OptimizerResult found = optimizer.minimize(cost, space_.region(prior), {evaluations}, 1);
    EXPECT_EQ(cost.tally().evaluations, 0) << "the host evaluated";
    return found;
  }
  OptimizerResult on_host(LevenbergMarquardt& optimizer, std::int64_t evaluations, int state) {
    const Eigen::VectorXd prior = test::scored_states(scene_).col(state);
    SearchCost cost(*cost_, space_, prior);
    DrivenByHost driven(cost);
    return optimizer.minimize(driven, space_.region(prior), {evaluations}, 1);
  }

  void expect_equal(const LevenbergMarquardtParams& params, std::int64_t evaluations, int state) {
    SCOPED_TRACE(testing::Message() << evaluations << " evaluations from state " << state);
    LevenbergMarquardt optimizer(params);
    const OptimizerResult host = on_host(optimizer, evaluations, state);
    const OptimizerResult device = on_device(optimizer, evaluations, state);
    const Eigen::VectorXd spread = space_.region(test::scored_states(scene_).col(state)).spread;
    EXPECT_EQ(device.evaluations, host.evaluations);
    EXPECT_NEAR(device.cost, host.cost, 1e-6 * std::abs(host.cost));
    EXPECT_LT((device.point - host.point).cwiseQuotient(spread).cwiseAbs().maxCoeff(), 1e-4);
    const OptimizerResult again = on_device(optimizer, evaluations, state);
    EXPECT_EQ(again.point, device.point);
    EXPECT_EQ(again.cost, device.cost);
    EXPECT_EQ(again.evaluations, device.evaluations);
  }

  Cost& cost() { return *cost_; }
  const SearchSpace& space() const { return space_; }

 private:
  static SearchSettings settings(RotationCoordinates rotation_as) {
    SearchSettings settings;
    settings.rotation_as = rotation_as;
    return settings;
  }

  Scene scene_;
  SearchSpace space_;
  Observation frame_;
  std::unique_ptr<Cost> cost_;
};

class DescentOnDevice : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(DescentOnDevice, IsThatOfTheHost) {
  LevenbergMarquardtParams params;
  params.mean_share = 0;
  params.tolerance = 0.03;
  const Scene hand = test::hand_scene();
  Searches searches(hand, terms_with_slopes(hand));
  for (const int state : {0, 3, 7}) searches.expect_equal(params, 200, state);
  for (const std::int64_t evaluations : {1, 5, 6, 30})
    searches.expect_equal(params, evaluations, 0);
  searches.prepare(96);
  searches.expect_equal(params, 60, 0);
}

TEST_F(DescentOnDevice, TakesQuaternionsAndSeveralModels) {
  LevenbergMarquardtParams params;
  params.tolerance = 0.03;
  const Scene scene = test::hand_and_box_scene();
  for (const auto rotation_as : {RotationCoordinates::quaternion, RotationCoordinates::tangent})
    Searches(scene, terms_with_slopes(scene), rotation_as).expect_equal(params, 100, 0);
}

TEST_F(DescentOnDevice, TakesSeveralSearchesInStep) {
  LevenbergMarquardtParams params;
  params.tolerance = 0.03;
  params.restarts = 5;
  const Scene hand = test::hand_scene();
  Searches(hand, terms_with_slopes(hand)).expect_equal(params, 300, 0);
}

TEST_F(DescentOnDevice, LeavesToTheHostWhatItCannotDo) {
  const Scene hand = test::hand_scene();
  std::vector<ObjectiveTerm> terms = terms_with_slopes(hand);
  terms.push_back(
      {0.5, std::make_shared<rgbd_depth::RgbdDepth>(rgbd_depth::Params{}), "rgbd_depth"});
  Searches drawing_neighbours(hand, terms), fit(hand, terms_with_slopes(hand));
  const Eigen::VectorXd prior = test::scored_states(hand).col(0);
  const auto descends = [&](Searches& searches, const DampedSettings& settings, int dimension) {
    const SearchRegion region = searches.space().region(prior);
    Eigen::VectorXd point = region.start;
    std::vector<cuda::Descent> searches_of_one{{region.start.data(), region.lower.data(),
                                                region.upper.data(), region.spread.data(),
                                                point.data()}};
    auto& descent = dynamic_cast<cuda::DescentCost&>(*searches.cost().device(&prior));
    return descent.descend(settings, dimension, searches_of_one, [] { return false; });
  };
  const int d = fit.space().dimension();
  EXPECT_TRUE(descends(fit, {.evaluations = 20}, d));
  EXPECT_FALSE(descends(fit, {.evaluations = 20}, d - 3)) << "a model rests";
  EXPECT_FALSE(descends(fit, {.evaluations = 20, .trials = 40}, d));
  EXPECT_FALSE(descends(drawing_neighbours, {.evaluations = 20}, d));
}

TEST_F(DescentOnDevice, EndsWhenItIsTold) {
  LevenbergMarquardtParams params;
  params.finest = 1e-3;
  params.tolerance = 0;
  const Scene hand = test::hand_scene();
  Searches searches(hand, terms_with_slopes(hand));
  const Eigen::VectorXd prior = test::scored_states(hand).col(0);
  SearchCost cost(searches.cost(), searches.space(), prior);
  const OptimizerResult found =
      LevenbergMarquardt(params).minimize(cost, searches.space().region(prior), {1 << 20, 1e-4}, 1);
  EXPECT_LT(found.evaluations, 100);
  EXPECT_TRUE(std::isfinite(found.cost));
}

}  // namespace
}  // namespace hypotrack
