// stereo_color beside a prior with a Jacobian and a term that has residuals only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cost/cost.hpp"
#include "stereo_color.hpp"
#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack::stereo_color {
namespace {

/// Pulls the model to a distance and a rotation; has a Jacobian.
class Prior final : public Objective, public ResidualTerm {
 public:
 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    float r[2];
    do_write_residuals(h, r);
    return r[0] * r[0] + r[1] * r[1];
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 2; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    residuals[0] = static_cast<float>(100 * (h.state[2] * h.state[2] - 0.3));
    residuals[1] = static_cast<float>(20 * (h.state[5] + 0.1));
  }
  bool do_has_jacobian() const override { return true; }
  void do_write_jacobian(const RenderedHypothesis& h, std::span<float> residuals,
                         Jacobian& jacobian) const override {
    do_write_residuals(h, residuals);
    jacobian(0, 2) = static_cast<float>(200 * h.state[2]);
    jacobian(1, 5) = 20;
  }
};

/// Passes an objective's residuals on, and none of their derivatives.
class ResidualsOnly final : public Objective, public ResidualTerm {
 public:
  explicit ResidualsOnly(std::shared_ptr<Objective> objective) : all_(std::move(objective)) {}

 private:
  bool do_needs_rendering() const override { return all_->needs_rendering(); }
  void do_prepare(const Observation& observation) override { all_->prepare(observation); }
  double do_cost(const RenderedHypothesis& h) const override { return all_->cost(h); }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override {
    return all_->residual_term()->residual_count();
  }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    all_->residual_term()->write_residuals(h, residuals);
  }

  std::shared_ptr<Objective> all_;
};

std::shared_ptr<Objective> colors(double beta) {
  Params params;
  params.beta = beta;
  params.distinctiveness = Distinctiveness::none;
  params.falloff = Falloff::gaussian;
  params.lookup = Lookup::bilinear;
  params.direction = Direction::both;
  return std::make_shared<StereoColor>(params);
}

/// Returns a picture of gentle waves of colour that fade to a level towards the edges. If the
/// levels of two views differ, nothing agrees there, as where only one of them sees the surface.
cv::Mat3b waves(int size, double phase, double edge) {
  cv::Mat3b out(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int from_edge = std::min({x, y, size - 1 - x, size - 1 - y});
      const double t = std::clamp((from_edge - 10) / 30.0, 0.0, 1.0);
      const double share = t * t * (3 - 2 * t);
      const auto wave = [&](double angle) {
        return cv::saturate_cast<uchar>(edge +
                                        share * (128 + 100 * std::sin(angle + phase) - edge));
      };
      out(y, x) = {wave(0.06 * x + 0.03 * y), wave(0.05 * y - 0.02 * x), wave(0.04 * (x - y))};
    }
  }
  return out;
}

/// A wall that fills both pictures, and hypotheses of it. There is no silhouette.
class MixedTerms : public testing::Test {
 protected:
  MixedTerms() {
    state_[2] = 0.6;
    state_.segment<4>(3) << 0.98, 0.1, -0.15, 0.05;
    wall_.normalize(state_);
    frame_.scene = &wall_;
    frame_.start = state_;
    frame_.rectified = true;
    for (int i = 0; i < 2; ++i) {
      constexpr int kSize = 128;
      constexpr double kFocal = 320, kBaseline = 0.12;
      TileView view;
      view.camera = {kSize, kSize, kFocal, kFocal, kSize / 2.0, kSize / 2.0};
      view.camera.camera_from_world.translation().x() = -i * kBaseline;
      view.camera.cx += i * kFocal * kBaseline / 0.6;
      view.color = waves(kSize, 0.5 * i, 255 * i);
      view.valid = cv::Mat1b(kSize, kSize, uchar{255});
      frame_.views.push_back(view);
    }
    steps_.head<3>().setConstant(5e-4);  // a quarter of a pixel
  }

  std::unique_ptr<Cost> cost(const std::vector<ObjectiveTerm>& terms) const {
    auto out =
        make_cost(wall_, terms, {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
    out->prepare(frame_);
    return out;
  }
  /// Returns the state and its neighbours, forth (1) or back (-1).
  Eigen::MatrixXd around(double sign) const {
    Eigen::MatrixXd out(state_.size(), steps_.size() + 1);
    out.col(0) = state_;
    for (Eigen::Index i = 0; i < steps_.size(); ++i) {
      out.col(i + 1) =
          moved(wall_, state_, sign * steps_[i] * Eigen::VectorXd::Unit(steps_.size(), i));
    }
    return out;
  }

  Scene wall_{{{"wall", std::make_shared<Model>(test::make_test_box({0.8, 0.8, 0.1}))}}};
  Eigen::VectorXd state_ = wall_.rest_state();
  Eigen::VectorXd steps_ = Eigen::VectorXd::Constant(6, 5e-3);
  Observation frame_;
};

TEST_F(MixedTerms, GiveTheNormalEquationsOfDifferences) {
  const auto terms = [](const auto& as) {
    return std::vector<ObjectiveTerm>{{1, as(colors(3))},
                                      {0.5, as(std::make_shared<Prior>())},
                                      {0.7, std::make_shared<ResidualsOnly>(colors(2))}};
  };
  const auto mixed = cost(terms([](std::shared_ptr<Objective> term) { return term; }));
  const auto plain = cost(
      terms([](std::shared_ptr<Objective> term) { return std::make_shared<ResidualsOnly>(term); }));
  ASSERT_TRUE(mixed->least_squares()->can_linearize());
  ASSERT_FALSE(plain->least_squares()->can_linearize());
  const NormalEquations found = mixed->least_squares()->linearize(around(1), steps_, 1);
  Eigen::MatrixXf plus(plain->least_squares()->count(), 7), minus = plus;
  Eigen::VectorXd costs(7);
  plain->least_squares()->evaluate(around(1), plus, costs);
  plain->least_squares()->evaluate(around(-1), minus, costs);
  const Eigen::MatrixXd j =
      (plus - minus).rightCols(6).cast<double>() * (0.5 * steps_.cwiseInverse()).asDiagonal();
  const Eigen::VectorXd g = j.transpose() * plus.col(0).cast<double>();
  const Eigen::MatrixXd a = j.transpose() * j;
  // In units that make metres and radians alike.
  const auto unit = steps_.asDiagonal();
  EXPECT_LT((unit * (found.g - g)).norm(), 0.05 * (unit * g).norm())
      << (unit * found.g).transpose() << "\n\n"
      << (unit * g).transpose();
  EXPECT_LT((unit * (found.a - a) * unit).norm(), 0.05 * (unit * a * unit).norm())
      << unit * found.a * unit << "\n\n"
      << unit * a * unit;
}

}  // namespace
}  // namespace hypotrack::stereo_color
