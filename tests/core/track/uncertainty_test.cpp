#include "track/uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

/// Residuals of a box: `pixels` readings of its position along some axes, each with noise of its
/// own.
class Readings final : public Objective, public ResidualTerm {
 public:
  Readings(std::vector<int> axes, int pixels, double noise, bool draws = false)
      : axes_(std::move(axes)), draws_(draws) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < pixels / 2; ++i) {
      noise_.push_back(noise * normal(random));
      noise_.push_back(-noise_.back());  // so that the middle is the minimum
    }
  }

 private:
  bool do_needs_rendering() const override { return draws_; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    double sum = 0;
    for (const int axis : axes_)
      for (const double noise : noise_) sum += std::pow(position(h, axis) + noise, 2);
    return sum;
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override {
    return static_cast<std::int64_t>(axes_.size() * noise_.size());
  }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    std::size_t i = 0;
    for (const int axis : axes_)
      for (const double noise : noise_)
        residuals[i++] = static_cast<float>(position(h, axis) + noise);
  }

  static double position(const RenderedHypothesis& h, int axis) {
    return h.state[static_cast<std::size_t>(axis)];
  }
  std::vector<int> axes_;
  bool draws_;
  std::vector<double> noise_;
};

struct UncertainBox {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  UncertaintySettings settings{.noise = 1, .floor = 0, .position = 0.05, .rotation = 1e-6};

  /// Sigma of the box's centre, `away` from the middle along x.
  double sigma(std::vector<int> axes, int pixels, double noise, double away = 0) const {
    return sigma({{1.0, std::make_shared<Readings>(axes, pixels, noise)}}, away);
  }
  double sigma(std::vector<ObjectiveTerm> terms, double away = 0) const {
    const auto cost = make_cost(scene, std::move(terms), {.backend = Backend::cpu, .threads = 1},
                                {.least_squares = true});
    cost->prepare(Observation{});
    Eigen::VectorXd state = scene.rest_state();
    state[0] = away;
    return PoseUncertainty(scene, settings).of(*cost, state)[0];
  }
};

TEST(PoseUncertainty, IsWhatTheScatterOfTheResidualsLeavesOpen) {
  const UncertainBox f;
  // 400 readings per axis with noise of 20 mm: 1 mm per axis.
  EXPECT_NEAR(f.sigma({0, 1, 2}, 400, 0.020), std::sqrt(3.0) * 0.001, 0.0002);
  EXPECT_NEAR(f.sigma({0, 1, 2}, 1600, 0.020), std::sqrt(3.0) * 0.0005, 0.0001);
  EXPECT_NEAR(f.sigma({0, 1, 2}, 400, 0.040), std::sqrt(3.0) * 0.002, 0.0004);
}

TEST(PoseUncertainty, GrowsByTheSettingsFactor) {
  UncertainBox f;
  const double before = f.sigma({0, 1, 2}, 400, 0.020);
  f.settings.noise = 5;
  EXPECT_NEAR(f.sigma({0, 1, 2}, 400, 0.020), 5 * before, 0.1 * before);
}

TEST(PoseUncertainty, OfWhatNothingIsSeenIsWhatTheSettingsSay) {
  const UncertainBox f;
  const double seen = f.sigma({0, 1, 2}, 400, 0.020);
  EXPECT_NEAR(f.sigma({0, 1}, 400, 0.020), std::hypot(seen * std::sqrt(2.0 / 3), 0.05), 0.001);
  EXPECT_NEAR(f.sigma({}, 400, 0.020), std::sqrt(3.0) * 0.05, 0.001);
}

TEST(PoseUncertainty, GrowsWhereASearchEndedBesideTheMinimum) {
  const UncertainBox f;
  const double away = f.sigma({0, 1, 2}, 400, 0.020, 0.015);
  EXPECT_GT(away, 0.014);
  EXPECT_LT(away, 0.018);
}

TEST(PoseUncertainty, IsNotLessForATermThatLooksAtThePoseOnly) {
  const UncertainBox f;
  const auto seen = [] { return std::make_shared<Readings>(std::vector{0, 1}, 400, 0.020, true); };
  const auto held = std::make_shared<Readings>(std::vector{2}, 400, 0.020);
  EXPECT_NEAR(f.sigma({{1.0, seen()}, {1.0, held}}), f.sigma({{1.0, seen()}}), 1e-9);
  EXPECT_LT(f.sigma({{1.0, held}}), 0.08) << "where nothing looks at pictures, it counts";
}

/// Readings of x + y, without any noise.
class ExactSum final : public Objective, public ResidualTerm {
 public:
 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    return static_cast<double>(do_residual_count()) * reading(h) * reading(h);
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 400; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    std::ranges::fill(residuals, static_cast<float>(reading(h)));
  }

  static double reading(const RenderedHypothesis& h) { return 1000 * (h.state[0] + h.state[1]); }
};

TEST(PoseUncertainty, OfWhatAnExactReadingLeavesOpenIsWhatTheSettingsSay) {
  const UncertainBox f;
  EXPECT_NEAR(f.sigma({{1.0, std::make_shared<ExactSum>()}}), std::sqrt(2.0) * 0.05, 0.001)
      << "z, and x against y";
}

TEST(PoseUncertainty, HasAValueForEveryLandmarkAtTheBoundsToo) {
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  const auto cost =
      make_cost(scene, {{1.0, std::make_shared<Readings>(std::vector{0, 1, 2}, 50, 0.01)}},
                {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
  cost->prepare(Observation{});
  Eigen::VectorXd state = scene.rest_state();
  for (Eigen::Index i = 7; i < state.size(); ++i)
    state[i] = scene.parameters()[static_cast<std::size_t>(i)].upper;
  const Eigen::VectorXd sigma = PoseUncertainty(scene, {}).of(*cost, state);
  ASSERT_EQ(sigma.size(), 21);
  EXPECT_TRUE(sigma.allFinite());
  EXPECT_GT(sigma.minCoeff(), 0);
}

}  // namespace
}  // namespace hypotrack
