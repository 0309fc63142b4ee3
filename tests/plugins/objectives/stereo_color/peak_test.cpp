#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rendered_pair.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

/// A way to move: one position, one rotation axis (about the wrist) or one joint angle.
struct Freedom {
  std::string name;
  double unit;  ///< 1 mm or 1 degree
};

std::vector<Freedom> freedoms(const Scene& scene) {
  std::vector<Freedom> out;
  for (const char* axis : {"x", "y", "z"}) out.push_back({std::string("position ") + axis, 1e-3});
  for (const char* axis : {"x", "y", "z"}) {
    out.push_back({std::string("rotation ") + axis, kDegree});
  }
  for (std::size_t i = 7; i < scene.parameters().size(); ++i) {
    out.push_back({scene.parameters()[i].name, kDegree});
  }
  return out;
}

Eigen::VectorXd moved(Eigen::VectorXd state, std::size_t freedom, double by) {
  if (freedom < 3) {
    state[static_cast<Eigen::Index>(freedom)] += by;
  } else if (freedom < 6) {
    const Eigen::Quaterniond q(state[3], state[4], state[5], state[6]);
    const Eigen::Quaterniond r =
        Eigen::AngleAxisd(by, Eigen::Vector3d::Unit(static_cast<Eigen::Index>(freedom) - 3)) * q;
    state.segment<4>(3) << r.w(), r.x(), r.y(), r.z();
  } else {
    state[static_cast<Eigen::Index>(freedom) + 1] += by;
  }
  return state;
}

// Offsets in units (1 mm or 1 degree); the truth in the middle.
constexpr double kOffsets[] = {-16, -8, -4, -2, -1, 0, 1, 2, 4, 8, 16};
constexpr Eigen::Index kTruth = 5, kCount = 11;

// A joint of one finger turns few pixels, and they are looked up at whole pixels: a degree or two
// beside the truth the score may be this much above it.
constexpr double kRipple = 2e-3;
constexpr double kFar = 6;  // in units: from here on it must be below

void expect_peak_at_truth(const RenderedPair& pair, const Params& params) {
  const auto objective = std::make_shared<StereoColor>(params);
  const auto all = freedoms(pair.scene());
  ASSERT_EQ(all.size(), 26u);
  for (std::size_t f = 0; f < all.size(); ++f) {
    SCOPED_TRACE(all[f].name);
    Eigen::MatrixXd states(pair.truth().size(), kCount);
    for (Eigen::Index i = 0; i < kCount; ++i) {
      states.col(i) = moved(pair.truth(), f, kOffsets[i] * all[f].unit);
    }
    const Eigen::VectorXd costs = pair.costs(objective, states);
    ASSERT_LT(costs[kTruth], 0);
    const Eigen::VectorXd score = costs / costs[kTruth];  // 1 at the truth
    for (Eigen::Index i = 0; i < kCount; ++i) {
      const double limit = std::abs(kOffsets[i]) < kFar ? 1 + kRipple : 1;
      EXPECT_LE(score[i], limit) << "off by " << kOffsets[i];
    }
    if (f >= 6) continue;  // the whole hand: a clear peak
    EXPECT_LT(std::max(score[kTruth - 3], score[kTruth + 3]), 0.95) << "off by 4";
    EXPECT_LT(std::max(score[0], score[kCount - 1]), 0.8) << "off by 16";
  }
}

TEST(Peak, IsAtTheTruthInEveryDegreeOfFreedom) { expect_peak_at_truth(RenderedPair(), {}); }

TEST(Peak, IsAtTheTruthPerRootOfTheArea) {
  Params params;
  params.aggregation = Aggregation::sum_per_sqrt;
  expect_peak_at_truth(RenderedPair(), params);
}

TEST(Peak, IsAtTheTruthInBothDirectionsAndBilinear) {
  const RenderedPair pair;
  Params params;
  params.direction = Direction::both;
  expect_peak_at_truth(pair, params);
  params.lookup = Lookup::bilinear;
  expect_peak_at_truth(pair, params);
}

TEST(Peak, IsAtTheTruthWithACoveragePenalty) {
  Params params;
  params.beta = 60;
  params.falloff = Falloff::gaussian;
  params.coverage_penalty = 0.1;
  params.direction = Direction::both;
  params.lookup = Lookup::bilinear;
  expect_peak_at_truth(RenderedPair(), params);
}

}  // namespace
}  // namespace hypotrack::stereo_color
