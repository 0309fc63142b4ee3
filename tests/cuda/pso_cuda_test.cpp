// The search on the GPU against the one on the CPU.
#include "pso_cuda.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "device.hpp"
#include "device_twin.hpp"
#include "hypotrack/api/error.hpp"
#include "pso.hpp"
#include "quadratic_cost.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Close to the start compared with the start's own size, so that the last digits of the initial
/// samples, in which the logarithms of CPU and GPU differ, are lost in the first addition. A pose
/// of three dimensions, then limbs of three.
SearchRegion narrow_region(Eigen::Index dimension) {
  const auto all = [&](double x) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(dimension, x);
  };
  SearchRegion region{all(1000), all(1000 - 1e-3), all(1000 + 2e-3), all(1e-3)};
  for (int d = 0; d < dimension; ++d) {
    if (d % 3 == 0) {
      const auto kind = d == 0 ? SearchGroup::Kind::pose : SearchGroup::Kind::limb;
      region.groups.push_back({kind, {}});
    }
    region.groups.back().dimensions.push_back(d);
  }
  return region;
}

/// Partly beyond the bounds.
Eigen::VectorXd target(Eigen::Index dimension) {
  return Eigen::VectorXd::LinSpaced(dimension, 1000 - 5e-4, 1000 + 2.5e-3);
}

PsoParams particles(int count) {
  PsoParams params;
  params.particles = count;
  return params;
}

void expect_equal(const OptimizerResult& gpu, const OptimizerResult& cpu) {
  EXPECT_EQ(gpu.point, cpu.point);
  EXPECT_EQ(gpu.cost, cpu.cost);
  EXPECT_EQ(gpu.evaluations, cpu.evaluations);
}

class PsoCudaSearch : public ::testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }

  /// Both searches of the quadratic cost, in a narrow region.
  static void expect_the_way_of_pso(int count, Eigen::Index dimension, std::int64_t evaluations,
                                    std::uint64_t seed = 1) {
    SCOPED_TRACE(std::to_string(count) + " particles, " + std::to_string(dimension) +
                 " dimensions, " + std::to_string(evaluations) + " evaluations");
    const SearchRegion region = narrow_region(dimension);
    test::QuadraticCost cost(target(dimension));
    expect_equal(PsoCuda(particles(count)).minimize(cost, region, {evaluations}, seed),
                 Pso(particles(count)).minimize(cost, region, {evaluations}, seed));
  }
};

TEST(PsoCuda, SaysWhatToWriteForACostOnTheCpu) {
  const SearchRegion region = narrow_region(3);
  test::RecordingCost cost(3, [](const Eigen::VectorXd&) { return 1.0; });
  PsoCuda pso({}, "scene.yaml:7:3");
  EXPECT_THAT([&] { pso.minimize(cost, region, {10}, 1); },
              ::testing::ThrowsMessage<DeviceError>(
                  "scene.yaml:7:3: pso_cuda searches on the GPU, and this scene is not evaluated "
                  "there. Write `evaluate: {backend: cuda}`, or `type: pso`, the same search on "
                  "the CPU"));
  EXPECT_TRUE(cost.points.empty());
  EXPECT_TRUE(pso.requirements().device);
}

TEST(PsoCuda, CoefficientsThatDoNotConstrictAreRefused) {
  PsoParams params;
  params.social = 1.0;
  EXPECT_THAT([&] { PsoCuda(params, "scene.yaml:7:3"); },
              ::testing::ThrowsMessage<ConfigError>(
                  HasSubstr("scene.yaml:7:3: cognitive + social is 3.800000, expected above 4")));
}

TEST_F(PsoCudaSearch, FindsTheBestPointOfPsoToTheBit) {
  for (const Eigen::Index dimension : {1, 7, 27, 54}) {
    for (const std::int64_t evaluations : {1, 7, 31, 32, 33, 112, 1024}) {
      for (const std::uint64_t seed : {1, 2}) {
        expect_the_way_of_pso(32, dimension, evaluations, seed);
      }
    }
  }
}

TEST_F(PsoCudaSearch, FindsItWithAnyNumberOfParticles) {
  for (const int count : {1, 2, 33, 128, 129, 1000, 20000}) {
    expect_the_way_of_pso(count, 27, std::int64_t{7} * count / 2);
  }
  expect_the_way_of_pso(1 << 20, 5, 3 << 20);
}

TEST_F(PsoCudaSearch, FindsItWithGroupedStartsAndLimbsAnew) {
  for (const Eigen::Index dimension : {2, 7, 27, 54}) {
    PsoParams params = particles(33);
    params.start.group_share = 0.3;
    params.reset = {2, 0.6};
    const SearchRegion region = narrow_region(dimension);
    test::QuadraticCost cost(target(dimension));
    const OptimizerResult cpu = Pso(params).minimize(cost, region, {400}, 3);
    expect_equal(PsoCuda(params).minimize(cost, region, {400}, 3), cpu);
    EXPECT_NE(cpu.point, Pso(particles(33)).minimize(cost, region, {400}, 3).point);
  }
}

TEST_F(PsoCudaSearch, FindsItWithoutGroups) {
  PsoParams params = particles(33);
  params.start.group_share = 0.3;
  params.reset = {2, 0.6};
  SearchRegion region = narrow_region(27);
  region.groups.clear();
  test::QuadraticCost cost(target(27));
  expect_equal(PsoCuda(params).minimize(cost, region, {400}, 3),
               Pso(params).minimize(cost, region, {400}, 3));
}

TEST_F(PsoCudaSearch, FindsItInMoreGenerationsThanAGraphHolds) {
  expect_the_way_of_pso(2, 3, 2 * 1024);
  expect_the_way_of_pso(2, 3, 2 * 1024 + 1);
}

TEST_F(PsoCudaSearch, FindsItWithABudgetOfTimeThatIsNotUsedUp) {
  const SearchRegion region = narrow_region(27);
  test::QuadraticCost cost(target(27));
  expect_equal(PsoCuda(particles(32)).minimize(cost, region, {112, 1e6}, 1),
               Pso(particles(32)).minimize(cost, region, {112}, 1));
}

TEST_F(PsoCudaSearch, StopsBetweenGenerationsWhenTheTimeIsUp) {
  const SearchRegion region = narrow_region(27);
  test::QuadraticCost cost(target(27));
  expect_equal(PsoCuda(particles(32)).minimize(cost, region, {112, 0.0}, 1),
               Pso(particles(32)).minimize(cost, region, {32}, 1));
}

// The earliest of equally good points is the best, within a generation and among generations.
TEST_F(PsoCudaSearch, FindsItAmongEquallyGoodPoints) {
  const SearchRegion region = narrow_region(4);
  const auto steps = [&](const Eigen::VectorXd& x) {
    return std::round(4 * test::offsets(region, target(4), x).squaredNorm());
  };
  for (const int count : {20, 300}) {
    test::RecordingCost on_cpu(4, steps), on_gpu(4, steps);
    test::DeviceTwin twin(on_gpu);
    expect_equal(PsoCuda(particles(count)).minimize(twin, region, {10 * count}, 3),
                 Pso(particles(count)).minimize(on_cpu, region, {10 * count}, 3));
    EXPECT_EQ(on_gpu.points, on_cpu.points);
  }
}

TEST_F(PsoCudaSearch, InitialSampleIsThatOfPsoUpToRounding) {
  const SearchRegion region = test::tracking_region(27);
  const auto flat = [](const Eigen::VectorXd&) { return 1.0; };
  test::RecordingCost on_cpu(27, flat), on_gpu(27, flat);
  test::DeviceTwin twin(on_gpu);
  PsoCuda(particles(64)).minimize(twin, region, {64}, 5);
  Pso(particles(64)).minimize(on_cpu, region, {64}, 5);
  ASSERT_EQ(on_gpu.points.size(), 64u);
  EXPECT_EQ(on_gpu.points[0], region.start);
  for (std::size_t p = 0; p < 64; ++p) {
    EXPECT_LT((on_gpu.points[p] - on_cpu.points[p]).cwiseAbs().maxCoeff(), 1e-15) << p;
  }
}

TEST_F(PsoCudaSearch, AWholeGenerationIsOneBatchAndTheLastOneMayBePartial) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  test::DeviceTwin twin(cost);
  PsoCuda(particles(16)).minimize(twin, region, {40}, 1);
  EXPECT_THAT(cost.batches, ElementsAre(16, 16, 8));
}

TEST_F(PsoCudaSearch, SameSeedSameAnswerAndAnotherSeedAnother) {
  const SearchRegion region = test::tracking_region(27);
  test::QuadraticCost cost(test::hidden_target(region, 5));
  PsoCuda pso(particles(32));
  const OptimizerResult first = pso.minimize(cost, region, {1024}, 77);
  const OptimizerResult other = pso.minimize(cost, region, {1024}, 78);
  const OptimizerResult high = pso.minimize(cost, region, {1024}, 77 + (std::uint64_t{1} << 40));
  expect_equal(pso.minimize(cost, region, {1024}, 77), first);
  expect_equal(PsoCuda(particles(32)).minimize(cost, region, {1024}, 77), first);
  EXPECT_NE(other.point, first.point);
  EXPECT_NE(high.point, first.point) << "the seed's high word counts";
}

TEST_F(PsoCudaSearch, AGraphServesManyFramesUntilItsRevisionChanges) {
  PsoCuda pso(particles(32));
  test::QuadraticCost cost(target(27));
  SearchRegion region = narrow_region(27);
  const auto search = [&](std::int64_t evaluations, std::uint64_t seed) {
    expect_equal(pso.minimize(cost, region, {evaluations}, seed),
                 Pso(particles(32)).minimize(cost, region, {evaluations}, seed));
  };
  search(320, 1);
  EXPECT_EQ(cost.enqueued(), 10);
  region.start.array() += 1e-4;
  region.upper.array() += 1e-4;
  cost.retarget(target(27).array() - 7e-4);
  search(320, 2);
  EXPECT_EQ(cost.enqueued(), 10) << "another frame is not captured again";
  cost.revise();
  search(320, 3);
  EXPECT_EQ(cost.enqueued(), 20);
  search(330, 3);
  EXPECT_EQ(cost.enqueued(), 31) << "another budget needs another graph";
  search(320, 3);
  EXPECT_EQ(cost.enqueued(), 41);
}

TEST_F(PsoCudaSearch, ReturnsTheStartWhereEverythingIsInfeasible) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return kInfinity; });
  test::DeviceTwin twin(cost);
  const OptimizerResult result = PsoCuda(particles(200)).minimize(twin, region, {700}, 1);
  EXPECT_EQ(result.point, region.start);
  EXPECT_EQ(result.cost, kInfinity);
  EXPECT_EQ(result.evaluations, 700);
}

TEST_F(PsoCudaSearch, AFlatCostGivesTheStart) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return 0.25; });
  test::DeviceTwin twin(cost);
  const OptimizerResult result = PsoCuda(particles(200)).minimize(twin, region, {700}, 1);
  EXPECT_EQ(result.point, region.start);
  EXPECT_EQ(result.cost, 0.25);
}

TEST_F(PsoCudaSearch, NoNumberIsNeverTheBest) {
  const SearchRegion region = test::tracking_region(4);
  const auto smooth = test::sphere(region, test::hidden_target(region, 5));
  test::RecordingCost cost(4, [&](const Eigen::VectorXd& x) {
    return x[0] <= region.start[0] ? std::nan("") : smooth(x);
  });
  test::DeviceTwin twin(cost);
  const OptimizerResult result = PsoCuda(particles(50)).minimize(twin, region, {500}, 1);
  EXPECT_TRUE(std::isfinite(result.cost));
  EXPECT_GT(result.point[0], region.start[0]);
}

TEST_F(PsoCudaSearch, BoundsHoldWhereTheOptimumLiesBeyondThem) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start.array() + 3.0));
  test::DeviceTwin twin(cost);
  PsoCuda(particles(40)).minimize(twin, region, {600}, 1);
  ASSERT_EQ(cost.points.size(), 600u);
  for (const auto& point : cost.points) {
    ASSERT_TRUE((point.array() >= region.lower.array()).all() &&
                (point.array() <= region.upper.array()).all())
        << point.transpose();
  }
}

using PsoCudaDeathTest = PsoCudaSearch;

// In a process of its own: a kernel that has failed takes the whole device context with it. The
// kernel traps: behind an illegal access a driver was seen to take seconds for every picture that
// OpenGL drew on that GPU, in other processes, too.
TEST_F(PsoCudaDeathTest, AFailedEvaluationIsADeviceError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto search = [] {
    test::QuadraticCost cost(target(27));
    cost.break_down();
    try {
      PsoCuda(particles(32)).minimize(cost, narrow_region(27), {112}, 1);
    } catch (const DeviceError& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(7);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(search(), ::testing::ExitedWithCode(7),
              "CUDA: a search of pso_cuda failed: unspecified launch failure");
}

}  // namespace
}  // namespace hypotrack
