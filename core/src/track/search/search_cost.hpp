#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/output.hpp"
#include "track/search/evaluation_tally.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The cost that optimizers minimise: converts search points to states, whose costs it returns.
class SearchCost final : public CostFunction, public ResidualCost {
 public:
  /// Points are those around `prior`. `record`, if given, receives what is evaluated, and `tracer`
  /// how the cost falls. All arguments must outlive the search cost.
  SearchCost(Cost& cost, const SearchSpace& space, const Eigen::VectorXd& prior,
             RecordedSearch* record = nullptr, OptimizerTracer* tracer = nullptr)
      : cost_(cost), space_(space), prior_(prior), record_(record) {
    tally_.tracer = tracer;
  }

  /// Returns what was evaluated so far.
  const EvaluationTally& tally() const { return tally_; }

  // CostFunction
  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override;
  cuda::DeviceCost* device() override;
  ResidualCost* residuals() override { return cost_.least_squares() ? this : nullptr; }
  bool is_watched() const override { return record_ || tally_.tracer; }

  // ResidualCost
  Eigen::Index count() const override { return cost_.least_squares()->count(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override;
  std::unique_ptr<ResidualDifferences> differences() override;
  bool can_linearize() const override { return cost_.least_squares()->can_linearize(); }
  bool draws_neighbours() const override { return cost_.least_squares()->draws_neighbours(); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override;
  std::vector<NormalEquations> linearize_each(std::span<const Neighbourhood> points) override;

 private:
  Cost& cost_;
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  RecordedSearch* record_;
  EvaluationTally tally_;
};

}  // namespace internal
}  // namespace hypotrack
