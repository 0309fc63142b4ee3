// A swarm's search in one kernel against the same search in many.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device.hpp"
#include "device_scores.hpp"
#include "hypotrack/gpu/device_cost.hpp"
#include "observations.hpp"
#include "probes.hpp"
#include "pso_cuda.hpp"
#include "stereo_color.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
namespace {

/// A device cost that may keep its search in one kernel to itself, and counts those it does.
class CountedCost : public cuda::DeviceCost {
 public:
  CountedCost(cuda::DeviceCost& cost, bool as_one) : cost_(cost), as_one_(as_one) {}
  cuda::Stream stream() const override { return cost_.stream(); }
  void reserve(std::int64_t count) override { cost_.reserve(count); }
  void enqueue(const double* points, std::int64_t count, double* costs) override {
    cost_.enqueue(points, count, costs);
  }
  bool enqueue_search(const cuda::SwarmSearch& search) override {
    const bool done = as_one_ && cost_.enqueue_search(search);
    searches_ += done ? 1 : 0;
    return done;
  }
  std::uint64_t revision() const override { return cost_.revision(); }
  int searches() const { return searches_; }

 private:
  cuda::DeviceCost& cost_;
  bool as_one_;
  int searches_ = 0;
};

/// The costs of a frame, for optimizers of the device.
class FrameCost : public CostFunction {
 public:
  FrameCost(const SearchSpace& space, cuda::DeviceCost& cost) : space_(space), cost_(cost) {}
  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::VectorXd>) override {
    FAIL() << "costs do not leave the device";
  }
  cuda::DeviceCost* device() override { return &cost_; }

 private:
  const SearchSpace& space_;
  cuda::DeviceCost& cost_;
};

struct Searched {
  OptimizerResult result;
  int as_one = 0;  ///< searches in one kernel
};

/// Searches of one cost.
class Searches {
 public:
  Searches(Scene scene, Observation observation, std::vector<ObjectiveTerm> terms,
           RotationCoordinates rotation_as = RotationCoordinates::quaternion)
      : scene_(std::move(scene)),
        observation_(std::move(observation)),
        space_(scene_, settings(rotation_as)),
        cost_(make_cost(scene_, std::move(terms), {.backend = Backend::cuda})) {
    observation_.scene = &scene_;
    observation_.start = test::scored_states(scene_).col(0);
    cost_->prepare(observation_);
  }

  Searched search(PsoCuda& pso, std::int64_t evaluations, bool as_one, std::uint64_t seed = 1) {
    cuda::DeviceCost* device =
        cost_->device(space_.rotation_vectors() ? &observation_.start : nullptr);
    CountedCost counted(*device, as_one);
    FrameCost cost(space_, counted);
    Searched searched;
    searched.result = pso.minimize(cost, space_.region(observation_.start), {evaluations}, seed);
    searched.as_one = counted.searches();
    return searched;
  }

  /// Searches with `particles` in both ways and several times; returns whether one of them was in
  /// one kernel.
  bool expect_the_same(PsoParams params, int generations) {
    SCOPED_TRACE(std::to_string(params.particles) + " particles, " + std::to_string(generations) +
                 " generations");
    PsoCuda in_one(params), in_many(params);
    const std::int64_t evaluations = std::int64_t{params.particles} * generations;
    bool as_one = false;
    for (const std::uint64_t seed : {1, 2, 1}) {
      const Searched one = search(in_one, evaluations, true, seed);
      const Searched many = search(in_many, evaluations, false, seed);
      EXPECT_EQ(one.result.point, many.result.point);
      EXPECT_EQ(one.result.cost, many.result.cost);
      EXPECT_EQ(one.result.evaluations, many.result.evaluations);
      EXPECT_EQ(many.as_one, 0);
      as_one = one.as_one > 0;
    }
    return as_one;
  }

 private:
  static SearchSettings settings(RotationCoordinates rotation_as) {
    SearchSettings settings;
    settings.rotation_as = rotation_as;
    return settings;
  }

  Scene scene_;
  Observation observation_;
  SearchSpace space_;
  std::unique_ptr<Cost> cost_;
};

std::shared_ptr<Objective> colors(bool both, bool bilinear = false) {
  stereo_color::Params params;
  params.beta = 2;  // the made-up views are not that alike
  params.direction = both ? stereo_color::Direction::both : stereo_color::Direction::left_to_right;
  params.lookup = bilinear ? stereo_color::Lookup::bilinear : stereo_color::Lookup::nearest;
  return std::make_shared<stereo_color::StereoColor>(params);
}

PsoParams particles(int count) {
  PsoParams params;
  params.particles = count;
  return params;
}

Searches of_pair(const std::shared_ptr<Objective>& objective, int size = 128) {
  const Scene scene = test::hand_scene();
  return {scene, test::colored(test::rectified_pair(scene, size)), {{1, objective}}};
}

class SwarmSearchInOneKernel : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(SwarmSearchInOneKernel, GoesTheSameWayToTheBit) {
  Searches searches = of_pair(colors(true));
  for (const int count : {1, 2, 7, 31, 32, 33, 64}) {
    for (const int generations : {1, 2, 3, 4, 32}) {
      EXPECT_TRUE(searches.expect_the_same(particles(count), generations));
    }
  }
}

TEST_F(SwarmSearchInOneKernel, GoesItWhereHypothesesAreDrawnWhole) {
  Searches searches = of_pair(colors(false, true));
  EXPECT_TRUE(searches.expect_the_same(particles(128), 9));
  EXPECT_TRUE(searches.expect_the_same(particles(200), 9));
}

TEST_F(SwarmSearchInOneKernel, GoesItWithLargeTilesInPieces) {
  EXPECT_TRUE(of_pair(colors(true), 256).expect_the_same(particles(32), 9));
  EXPECT_TRUE(of_pair(colors(true), 512).expect_the_same(particles(32), 3));
}

TEST_F(SwarmSearchInOneKernel, GoesItWithTermsThatHaveNoTexelsOrLookAtSingleViews) {
  EXPECT_TRUE(of_pair(test::seen_probe(false)).expect_the_same(particles(32), 9));
  EXPECT_TRUE(of_pair(test::seen_probe(true)).expect_the_same(particles(32), 9));
  EXPECT_TRUE(of_pair(test::covered_probe()).expect_the_same(particles(32), 9));
}

TEST_F(SwarmSearchInOneKernel, GoesItForSeveralModelsAndRotationVectors) {
  const Scene scene = test::hand_and_box_scene();
  for (const auto rotation_as : {RotationCoordinates::quaternion, RotationCoordinates::tangent}) {
    Searches searches(scene, test::colored(test::rectified_pair(scene)), {{2, colors(true)}},
                      rotation_as);
    EXPECT_TRUE(searches.expect_the_same(particles(32), 17));
  }
}

TEST_F(SwarmSearchInOneKernel, GoesItWithGroupedStartsAndLimbsAnew) {
  PsoParams params = particles(33);
  params.start.group_share = 0.3;
  params.reset = {2, 0.6};
  EXPECT_TRUE(of_pair(colors(true)).expect_the_same(params, 12));
}

TEST_F(SwarmSearchInOneKernel, LeavesToManyWhatItCannotDo) {
  const Scene scene = test::hand_scene();
  const Observation general = test::colored(test::general_pair(scene));
  EXPECT_FALSE(Searches(scene, general, {{1, colors(true)}}).expect_the_same(particles(32), 3));
  const Observation pair = test::colored(test::rectified_pair(scene));
  Searches two_terms(scene, pair, {{1, colors(true)}, {1, test::covered_probe()}});
  EXPECT_FALSE(two_terms.expect_the_same(particles(32), 3));
  EXPECT_FALSE(of_pair(colors(true)).expect_the_same(particles(1000), 2));  // too many at once
  PsoCuda pso(particles(32));
  EXPECT_EQ(of_pair(colors(true)).search(pso, 33, true).as_one, 0);  // a part of a generation
}

TEST_F(SwarmSearchInOneKernel, TakesASearchInManyKernelsInBetween) {
  Searches searches = of_pair(colors(true));
  PsoCuda pso(particles(32));
  const auto first = searches.search(pso, 320, true);
  const auto part = searches.search(pso, 333, true);
  const auto again = searches.search(pso, 320, true);
  EXPECT_EQ(first.as_one + part.as_one + again.as_one, 2);
  EXPECT_EQ(first.result.point, again.result.point);
  EXPECT_LE(part.result.cost, first.result.cost);
}

}  // namespace
}  // namespace hypotrack
