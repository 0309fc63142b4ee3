#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/random.hpp"

namespace hypotrack::test {

/// A non-negative cost, and residuals whose squares sum to it.
class Problem {
 public:
  using Residuals = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

  explicit Problem(Residuals residuals) : residuals_(std::move(residuals)) {}
  /// Makes a problem from any cost; its only residual is the square root.
  template <class Cost>
  requires std::convertible_to < std::invoke_result_t<Cost&, const Eigen::VectorXd&>,
  double > Problem(Cost cost) : cost_(std::move(cost)) {}

  double operator()(const Eigen::VectorXd& point) const {
    return cost_ ? cost_(point) : residuals_(point).squaredNorm();
  }
  Eigen::VectorXd residuals(const Eigen::VectorXd& point) const {
    if (residuals_) return residuals_(point);
    return Eigen::VectorXd::Constant(1, std::sqrt(cost_(point)));
  }

 private:
  std::function<double(const Eigen::VectorXd&)> cost_;
  Residuals residuals_;
};

/// A cost function that records all its evaluations.
class RecordingCost final : public CostFunction, public ResidualCost {
 public:
  using Function = Problem;
  RecordingCost(int dimension, Function function)
      : dimension_(dimension), function_(std::move(function)) {}

  int dimension() const override { return dimension_; }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& batch,
                Eigen::Ref<Eigen::VectorXd> batch_costs) override {
    batches.push_back(static_cast<int>(batch.cols()));
    for (Eigen::Index i = 0; i < batch.cols(); ++i) {
      points.push_back(batch.col(i));
      batch_costs[i] = function_(points.back());
      costs.push_back(batch_costs[i]);
    }
  }

  ResidualCost* residuals() override { return has_residuals ? this : nullptr; }
  Eigen::Index count() const override {
    return function_.residuals(Eigen::VectorXd::Zero(dimension_)).size();
  }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& batch,
                Eigen::Ref<Eigen::MatrixXf> batch_residuals,
                Eigen::Ref<Eigen::VectorXd> batch_costs) override {
    evaluate(batch, batch_costs);
    for (Eigen::Index i = 0; i < batch.cols(); ++i) {
      batch_residuals.col(i) = function_.residuals(batch.col(i)).cast<float>();
    }
  }

  /// Linearises by differences, which is exact for linear residuals.
  bool can_linearize() const override { return linearizes; }
  bool draws_neighbours() const override { return draws; }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& beside,
                            const Eigen::Ref<const Eigen::VectorXd>& offsets,
                            double blur) override {
    blurs.push_back(blur);
    steps.push_back(offsets);
    const Eigen::VectorXd r = function_.residuals(beside.col(0));
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(r.size(), offsets.size());
    for (Eigen::Index i = 0; i < offsets.size(); ++i) {
      if (offsets[i] != 0) j.col(i) = (function_.residuals(beside.col(i + 1)) - r) / offsets[i];
    }
    return {j.transpose() * j, j.transpose() * r};
  }

  bool has_residuals = true;
  bool linearizes = false;
  bool draws = false;         ///< linearize() also takes the neighbours
  std::vector<double> blurs;  ///< of every linearisation
  /// Returns what was evaluated, linearisations included.
  std::int64_t evaluations() const {
    return std::ssize(points) + std::ssize(blurs) * linearize_price(dimension_);
  }
  std::vector<Eigen::VectorXd> steps;  ///< likewise
  std::vector<Eigen::VectorXd> points;
  std::vector<double> costs;
  std::vector<int> batches;

 private:
  int dimension_;
  Function function_;
};

/// Returns a search region like a tracker's: three unbounded positions, four quaternion components
/// within -1 .. 1, the rest angles with the start anywhere within anatomical bounds. The first
/// seven dimensions are a pose, every further four a limb.
inline SearchRegion tracking_region(int dimension) {
  SearchRegion region{Eigen::VectorXd(dimension), Eigen::VectorXd(dimension),
                      Eigen::VectorXd(dimension), Eigen::VectorXd(dimension)};
  for (int d = 0; d < dimension; ++d) {
    const double u = uniform4(7, {static_cast<std::uint32_t>(d), 0, 0, 9})[0];
    if (d < 3) {
      region.lower[d] = -std::numeric_limits<double>::infinity();
      region.upper[d] = -region.lower[d];
      region.start[d] = d == 2 ? 0.5 : 0.1 * (u - 0.5);
      region.spread[d] = 0.04;
    } else if (d < 7) {
      region.lower[d] = -1;
      region.upper[d] = 1;
      region.start[d] = d == 3 ? 1 : 0;
      region.spread[d] = 0.087;
    } else {
      region.lower[d] = -0.3;
      region.upper[d] = 1.6;
      region.start[d] = -0.3 + 1.9 * u;
      region.spread[d] = 0.175;
    }
    const bool pose = d < 7;
    if (d == 0 || (!pose && (d - 7) % 4 == 0)) {
      region.groups.push_back({pose ? SearchGroup::Kind::pose : SearchGroup::Kind::limb, {}});
    }
    region.groups.back().dimensions.push_back(d);
  }
  return region;
}

/// Returns a minimum to find: about half a spread from the start in every dimension, within the
/// bounds.
inline Eigen::VectorXd hidden_target(const SearchRegion& region, std::uint64_t seed) {
  Eigen::VectorXd target = region.start;
  for (Eigen::Index d = 0; d < target.size(); ++d) {
    target[d] += 0.5 * region.spread[d] * normal(seed, {static_cast<std::uint32_t>(d), 0, 0, 8});
  }
  return target.cwiseMax(region.lower).cwiseMin(region.upper);
}

/// Returns the offsets from the target in spreads.
inline Eigen::VectorXd offsets(const SearchRegion& region, const Eigen::VectorXd& target,
                               const Eigen::VectorXd& point) {
  return (point - target).cwiseQuotient(region.spread);
}

/// Returns the mean of squared offsets: 0 at the target, about 0.25 at the start.
inline Problem sphere(SearchRegion region, Eigen::VectorXd target) {
  return Problem([region = std::move(region),
                  target = std::move(target)](const Eigen::VectorXd& point) -> Eigen::VectorXd {
    return offsets(region, target, point) / std::sqrt(static_cast<double>(point.size()));
  });
}

/// Returns the sphere with squared axes stretched from 1 to 100.
inline Problem ellipsoid(SearchRegion region, Eigen::VectorXd target) {
  return Problem([region = std::move(region),
                  target = std::move(target)](const Eigen::VectorXd& point) -> Eigen::VectorXd {
    Eigen::VectorXd u = offsets(region, target, point);
    for (Eigen::Index d = 0; d < u.size(); ++d) {
      const double share = u.size() > 1 ? static_cast<double>(d) / (u.size() - 1) : 0;
      u[d] *= std::pow(10.0, share);
    }
    return u / std::sqrt(static_cast<double>(u.size()));
  });
}

/// Returns Rosenbrock's function with its minimum 0 at the target.
inline Problem rosenbrock(SearchRegion region, Eigen::VectorXd target) {
  return Problem([region = std::move(region),
                  target = std::move(target)](const Eigen::VectorXd& point) -> Eigen::VectorXd {
    const Eigen::VectorXd u = offsets(region, target, point).array() + 1.0;
    const Eigen::Index valleys = u.size() - 1;
    Eigen::VectorXd r = Eigen::VectorXd::Zero(std::max<Eigen::Index>(2 * valleys, 1));
    for (Eigen::Index d = 0; d < valleys; ++d) {
      r[2 * d] = 10 * (u[d + 1] - u[d] * u[d]);
      r[2 * d + 1] = 1 - u[d];
    }
    return r / std::sqrt(static_cast<double>(u.size()));
  });
}

}  // namespace hypotrack::test
