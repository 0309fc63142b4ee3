// Terms with slopes, with Jacobians and with residuals only in one scene.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>

#include "cost/cost.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "test_models.hpp"

namespace hypotrack::test {
namespace {

/// Residuals of both tiles, but no slopes.
class WithoutSlopes : public DepthPattern {
 public:
  using DepthPattern::DepthPattern;

 protected:
  bool do_has_slopes() const override { return false; }
};

/// Says where a point of a model should be: its rotated place, with a Jacobian by the quaternion.
class PointOfModel : public Objective, public ResidualTerm {
 public:
  mutable std::atomic<int> jacobians = 0;

 protected:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    return residual(h.state).squaredNorm();
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 3; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    Eigen::Map<Eigen::Vector3f>(residuals.data()) = residual(h.state).cast<float>();
  }
  bool do_has_jacobian() const override { return true; }
  void do_write_jacobian(const RenderedHypothesis& h, std::span<float> residuals,
                         Jacobian& jacobian) const override {
    ++jacobians;
    do_write_residuals(h, residuals);
    const double w = h.state[3];
    const Eigen::Vector3d v(h.state[4], h.state[5], h.state[6]);
    // Of (w^2 - v.v) p + 2 w v x p + 2 v (v.p): the rotated point, without normalising.
    jacobian.leftCols<3>().setIdentity();
    jacobian.col(3) = (2 * w * kPoint + 2 * v.cross(kPoint)).cast<float>();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(i);
      jacobian.col(4 + i) =
          (-2 * v[i] * kPoint + 2 * w * e.cross(kPoint) + 2 * e * v.dot(kPoint) + 2 * v * kPoint[i])
              .cast<float>();
    }
  }

 private:
  static inline const Eigen::Vector3d kPoint{0.3, -0.2, 0.5};

  static Eigen::Vector3d residual(std::span<const double> state) {
    const Eigen::Quaterniond q(state[3], state[4], state[5], state[6]);
    return Eigen::Vector3d(state[0], state[1], state[2]) + q * kPoint;
  }
};

/// The point of a model, for hypotheses that are drawn.
class DrawnPoint final : public PointOfModel {
 public:
  mutable std::atomic<bool> drawn = false;

 private:
  bool do_needs_rendering() const override { return true; }
  void do_write_jacobian(const RenderedHypothesis& h, std::span<float> residuals,
                         Jacobian& jacobian) const override {
    drawn = h.views.size() == 2 && h.views[0].x1 > h.views[0].x0;
    PointOfModel::do_write_jacobian(h, residuals, jacobian);
  }
};

/// Is infeasible beyond a place.
class Fenced final : public WithoutSlopes {
 public:
  explicit Fenced(double fence) : WithoutSlopes(0.2f, 0.5f), fence_(fence) {}

 private:
  double do_cost(const RenderedHypothesis& h) const override {
    if (h.state[0] > fence_) return std::numeric_limits<double>::infinity();
    return WithoutSlopes::do_cost(h);
  }

  double fence_;
};

class MixedTerms : public testing::Test {
 protected:
  std::unique_ptr<Cost> cost(const std::vector<ObjectiveTerm>& terms, int threads = 1) const {
    auto out = make_cost(scene_, terms, {.backend = Backend::cpu, .threads = threads},
                         {.least_squares = true});
    out->prepare(frame_);
    return out;
  }
  NormalEquations analytic(const std::vector<ObjectiveTerm>& terms, int threads = 1) const {
    return cost(terms, threads)->least_squares()->linearize(states_, steps_, 1);
  }
  /// Normal equations of one-sided differences, or of central ones.
  NormalEquations numerical(const std::vector<ObjectiveTerm>& terms, bool central) const {
    const auto all = cost(terms);
    const Eigen::MatrixXd back = moved_states(scene_, states_.col(0), -steps_);
    Eigen::MatrixXf plus(all->least_squares()->count(), states_.cols()), minus = plus;
    Eigen::VectorXd costs(states_.cols());
    all->least_squares()->evaluate(states_, plus, costs);
    all->least_squares()->evaluate(back, minus, costs);
    const Eigen::VectorXd r = plus.col(0).cast<double>();
    const Eigen::MatrixXd beside = plus.rightCols(steps_.size()).cast<double>();
    const Eigen::MatrixXd before = minus.rightCols(steps_.size()).cast<double>();
    const Eigen::MatrixXd j =
        central ? Eigen::MatrixXd((beside - before) / 2) : Eigen::MatrixXd(beside.colwise() - r);
    const Eigen::MatrixXd scaled = j * steps_.cwiseInverse().asDiagonal();
    return {scaled.transpose() * scaled, scaled.transpose() * r};
  }

  Scene scene_ = hand_scene();
  Observation frame_ = rectified_pair(scene_);
  Eigen::VectorXd steps_ = metres_and_radians(scene_.dimension() - 1, 1e-3, 5e-3);
  Eigen::MatrixXd states_ = moved_states(scene_, hand_state(scene_), steps_);
  std::shared_ptr<DepthPattern> slopes_ = std::make_shared<DepthPattern>(0.2f, 0.5f);
  std::shared_ptr<WithoutSlopes> residuals_ = std::make_shared<WithoutSlopes>(0.4f, 0.6f);
  std::shared_ptr<PointOfModel> jacobian_ = std::make_shared<PointOfModel>();
  std::shared_ptr<Position> position_ = std::make_shared<Position>();
};

TEST_F(MixedTerms, AddUpToWhatEachOfThemGives) {
  const NormalEquations found =
      analytic({{2, slopes_}, {0.5, residuals_}, {3, jacobian_}, {1, position_}, {0, residuals_}});
  EXPECT_EQ(jacobian_->jacobians, 1);
  const NormalEquations s = analytic({{2, slopes_}});
  const NormalEquations r = numerical({{0.5, residuals_}}, false);
  const NormalEquations j = numerical({{3, jacobian_}}, true);
  const NormalEquations p = numerical({{1, position_}}, true);
  EXPECT_TRUE(found.a.isApprox(s.a + r.a + j.a + p.a, 1e-4));
  EXPECT_TRUE(found.g.isApprox(s.g + r.g + j.g + p.g, 1e-4));
}

TEST_F(MixedTerms, TakeAJacobianOfAQuaternionAlongTheUnitSphere) {
  const NormalEquations found = analytic({{1, jacobian_}});
  const NormalEquations expected = numerical({{1, jacobian_}}, true);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4)) << found.a << "\n\n" << expected.a;
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-4));
}

TEST_F(MixedTerms, GiveWhatIsDrawnToAJacobianThatNeedsIt) {
  const auto drawn = std::make_shared<DrawnPoint>();
  const NormalEquations found = analytic({{2, drawn}});
  const NormalEquations expected = numerical({{2, jacobian_}}, true);
  EXPECT_TRUE(drawn->drawn);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4));
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-4));
}

TEST_F(MixedTerms, DoNotDependOnTheNumberOfThreads) {
  const std::vector<ObjectiveTerm> terms{{1, slopes_}, {1, residuals_}, {1, jacobian_}};
  const NormalEquations expected = analytic(terms);
  for (const int threads : {2, 5}) {
    const NormalEquations found = analytic(terms, threads);
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.g, expected.g);
  }
}

TEST_F(MixedTerms, LeaveANeighbourOfInfiniteCostOut) {
  const auto fenced = std::make_shared<Fenced>(states_(0, 0) + 0.5 * steps_[0]);
  const NormalEquations s = analytic({{1, slopes_}});
  const NormalEquations found = analytic({{1, slopes_}, {1, fenced}});
  EXPECT_DOUBLE_EQ(found.a(0, 0), s.a(0, 0));
  EXPECT_GT(found.a(1, 1), s.a(1, 1));
}

TEST_F(MixedTerms, CountNeighboursThatAreDrawn) {
  const auto d = static_cast<int>(steps_.size());
  const auto price = [&](const std::vector<ObjectiveTerm>& terms) {
    const auto all = cost(terms);
    EXPECT_TRUE(all->least_squares()->can_linearize());
    return all->least_squares()->linearize_price(d);
  };
  EXPECT_EQ(price({{1, slopes_}, {1, jacobian_}, {1, position_}}), 1);
  EXPECT_EQ(price({{1, slopes_}, {0, residuals_}}), 1);
  EXPECT_EQ(price({{1, slopes_}, {1, residuals_}}), 1 + d);
  EXPECT_EQ(price({{1, std::make_shared<DrawnPoint>()}, {1, residuals_}}), 1 + d);
}

TEST_F(MixedTerms, AreDifferencesIfNothingThatIsDrawnIsAnalytic) {
  EXPECT_FALSE(cost({{1, residuals_}, {1, jacobian_}})->least_squares()->can_linearize());
}

}  // namespace
}  // namespace hypotrack::test
