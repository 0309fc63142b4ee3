#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "track/tangent.hpp"

namespace hypotrack::test {

/// A made-up residual per pixel of both views, smooth in the depth of what is drawn there.
class DepthPattern : public Objective, public ResidualTerm {
 public:
  DepthPattern(float per_inverse_depth, float uncovered)
      : factor_(per_inverse_depth), uncovered_(uncovered) {}

 protected:
  void do_prepare(const Observation& observation) override {
    count_ = 0;
    for (const TileView& view : observation.views) {
      count_ += std::int64_t{view.camera.width} * view.camera.height;
    }
  }
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    double sum = 0;
    for (const DepthTile& tile : hypothesis.views) {
      for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
          const double r = residual(tile, x, y);
          sum += r * r;
        }
      }
    }
    return sum;
  }

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return count_; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    std::size_t i = 0;
    for (const DepthTile& tile : hypothesis.views) {
      for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) residuals[i++] = residual(tile, x, y);
      }
    }
  }
  bool do_has_slopes() const override { return true; }
  std::span<const int> do_pixel_views() const override { return kViews; }
  void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                       std::span<float> residuals, std::span<float> slopes) const override {
    const DepthTile& tile = hypothesis.views[i];
    std::size_t at = 0;
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x, ++at) {
        residuals[at] = residual(tile, x, y);
        slopes[at] = tile.inverse_depth[y * tile.stride + x] > 0 ? factor_ : 0;
      }
    }
  }

 private:
  static constexpr std::array<int, 2> kViews{0, 1};

  float residual(const DepthTile& tile, int x, int y) const {
    const float w = tile.inverse_depth[y * tile.stride + x];
    if (w == 0) return uncovered_;
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
    return 0.5f + 0.4f * std::sin(0.05f * fx + 0.02f * fy - 4.2f) + factor_ * (w - 2);
  }

  float factor_, uncovered_;
  std::int64_t count_ = 0;
};

/// Residuals that are the first three numbers of a state.
class Position : public Objective, public ResidualTerm {
 public:
 protected:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    return h.state[0] * h.state[0] + h.state[1] * h.state[1] + h.state[2] * h.state[2];
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 3; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    for (std::size_t i = 0; i < 3; ++i) residuals[i] = static_cast<float>(h.state[i]);
  }
};

/// A state moved along each dimension of a difference in turn.
inline Eigen::MatrixXd moved_states(const Scene& scene, const Eigen::VectorXd& state,
                                    const Eigen::VectorXd& steps) {
  Eigen::MatrixXd states(state.size(), steps.size() + 1);
  states.col(0) = state;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    states.col(i + 1) = moved(scene, state, steps[i] * Eigen::VectorXd::Unit(steps.size(), i));
  }
  return states;
}

/// Returns a state of hand_scene() in front of the pairs' cameras.
inline Eigen::VectorXd hand_state(const Scene& scene) {
  Eigen::VectorXd state = scene.rest_state();
  state[0] = 0.01;
  state[2] = 0.5;
  state.segment<4>(3) << 0.05, 0.99, 0.1, 0.05;
  for (Eigen::Index i = 7; i < state.size(); ++i) {
    const Parameter& p = scene.parameters()[static_cast<std::size_t>(i)];
    state[i] = 0.7 * p.lower + 0.3 * p.upper;
  }
  scene.normalize(state);
  return state;
}

/// Returns steps of a model's pose and joints.
inline Eigen::VectorXd metres_and_radians(Eigen::Index size, double metres, double radians) {
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(size, radians);
  steps.head<3>().setConstant(metres);
  return steps;
}

}  // namespace hypotrack::test
