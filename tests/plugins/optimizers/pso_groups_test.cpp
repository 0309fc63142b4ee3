// The options of pso that know which dimensions belong together.
#include <gtest/gtest.h>

#include <cmath>

#include "pso/pso.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

/// The number of particles of a generation in which a limb's dimensions alone lie a new sample's
/// distance from the best, and whether a pose was touched.
struct Moved {
  int limbs = 0;
  int others = 0;
};

// On a flat cost the swarm's best is the start, and particles that begin there (sigma 0 but for a
// tiny spread) stay there: only what is made anew moves.
Moved moved_in_generation(int generation, const PsoParams& params) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return 1.0; });
  Pso(params).minimize(cost, region, {std::int64_t{params.particles} * (generation + 1)}, 5);
  Moved moved;
  for (int p = 0; p < params.particles; ++p) {
    const auto at = [&](int g) -> const Eigen::VectorXd& {
      return cost.points[static_cast<std::size_t>(g * params.particles + p)];
    };
    for (const SearchGroup& group : region.groups) {
      int changed = 0;
      for (const int d : group.dimensions) changed += at(generation)[d] != at(0)[d];
      if (changed == 0) continue;
      if (group.kind == SearchGroup::Kind::limb && changed == 4)
        ++moved.limbs;
      else
        ++moved.others;
    }
  }
  return moved;
}

PsoParams resting() {
  PsoParams params;
  params.particles = 400;
  params.start.group_share = 0;  // everybody begins at the start
  params.start.group_rest = 0;
  params.reset.every = 3;
  return params;
}

TEST(PsoGroups, AShareOfTheParticlesGetsOneLimbAnewEveryFewGenerations) {
  EXPECT_EQ(moved_in_generation(2, resting()).limbs, 0);
  const Moved third = moved_in_generation(3, resting());
  EXPECT_NEAR(third.limbs / 400.0, 0.5, 0.08);
  EXPECT_EQ(third.others, 0) << "poses stay, and so do other limbs";
}

TEST(PsoGroups, NothingIsMadeAnewUnlessAsked) {
  PsoParams params = resting();
  params.reset.every = 0;
  EXPECT_EQ(moved_in_generation(6, params).limbs, 0);
  params.reset.every = 3;
  params.reset.share = 0;
  EXPECT_EQ(moved_in_generation(3, params).limbs, 0);
}

TEST(PsoGroups, ALimbAnewIsANormalSampleWithinTheBounds) {
  PsoParams params = resting();
  params.particles = 4000;
  SearchRegion region{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, -0.5),
                      Eigen::VectorXd::Constant(1, 100), Eigen::VectorXd::Ones(1)};
  region.groups = {{SearchGroup::Kind::limb, {0}}};
  params.reset = {1, 1};
  test::RecordingCost cost(1, [](const Eigen::VectorXd&) { return 1.0; });
  Pso(params).minimize(cost, region, {8000}, 5);
  double above = 0;
  int at_bound = 0;
  for (std::size_t p = 4000; p < 8000; ++p) {
    const double x = cost.points[p][0];
    if (x > 0) above += x * x / 2000;
    at_bound += x == -0.5;
  }
  EXPECT_NEAR(std::sqrt(above), 0.5, 0.03);      // sigma 0.5 times spread 1
  EXPECT_NEAR(at_bound / 4000.0, 0.1587, 0.02);  // beyond one standard deviation
}

TEST(PsoGroups, WithoutGroupsThereAreNoLimbs) {
  SearchRegion region = test::tracking_region(27);
  region.groups.clear();
  PsoParams params = resting();
  params.particles = 20;
  params.reset.every = 1;
  test::RecordingCost cost(27, [](const Eigen::VectorXd&) { return 1.0; });
  Pso(params).minimize(cost, region, {100}, 5);
  for (const auto& point : cost.points) EXPECT_EQ(point, region.start);
}

TEST(PsoGroups, TheDefaultsAreThePapersSwarm) {
  const PsoParams params;
  EXPECT_EQ(params.start.group_share, 1);
  EXPECT_EQ(params.reset.every, 0);
}

}  // namespace
}  // namespace hypotrack
