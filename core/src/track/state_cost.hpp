#pragma once

#include <Eigen/Core>
#include <memory>

#include "cost/evaluator.hpp"
#include "hypotrack/optimizer.hpp"
#include "track/search_space.hpp"

namespace hypotrack {

/// Costs of search points: points become states, states are evaluated.
class StateCost final : public CostFunction, public ResidualCost {
 public:
  /// Everything given must outlive the cost.
  StateCost(const SearchSpace& space, const Eigen::VectorXd& prior, Evaluator& evaluator)
      : space_(space), prior_(prior), evaluator_(evaluator) {}

  // CostFunction
  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  cuda::DeviceCost* device() override;
  ResidualCost* residuals() override { return evaluator_.has_residuals() ? this : nullptr; }

  // ResidualCost
  Eigen::Index count() const override { return evaluator_.residual_count(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override;
  std::unique_ptr<ResidualDifferences> differences() override;
  bool can_linearize() const override { return evaluator_.can_linearize(); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override;

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  Evaluator& evaluator_;
};

}  // namespace hypotrack
