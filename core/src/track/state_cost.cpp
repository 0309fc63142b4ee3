#include "track/state_cost.hpp"

namespace hypotrack {
namespace {

/// Residual differences of search points; the residuals stay where the evaluator has them.
class PointDifferences final : public ResidualDifferences {
 public:
  PointDifferences(const SearchSpace& space, const Eigen::VectorXd& prior,
                   ResidualDifferences& of_states)
      : space_(space), prior_(prior), of_states_(of_states) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    of_states_.evaluate(space_.states(points, prior_), costs);
  }
  void move_to(Eigen::Index i) override { of_states_.move_to(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    return of_states_.normal_equations(space_.states(points, prior_), scale, costs);
  }

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  ResidualDifferences& of_states_;
};

}  // namespace

void StateCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                         Eigen::Ref<Eigen::VectorXd> costs) {
  evaluator_.evaluate(space_.states(points, prior_), costs);
}

cuda::DeviceCost* StateCost::device() {
  return evaluator_.device_cost(prior_, space_.rotation_vectors());
}

void StateCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                         Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) {
  evaluator_.evaluate(space_.states(points, prior_), residuals, costs);
}

std::unique_ptr<ResidualDifferences> StateCost::differences() {
  ResidualDifferences* of_states = evaluator_.differences();
  if (!of_states) return ResidualCost::differences();
  return std::make_unique<PointDifferences>(space_, prior_, *of_states);
}

NormalEquations StateCost::linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                     const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) {
  return evaluator_.linearize(space_.states(points, prior_), steps, blur);
}

}  // namespace hypotrack
