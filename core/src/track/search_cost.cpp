#include "track/search_cost.hpp"

#include <utility>

namespace hypotrack {
namespace {

/// Residual differences of search points; the residuals stay where the cost of states has them.
class SearchDifferences final : public ResidualDifferences {
 public:
  SearchDifferences(std::unique_ptr<ResidualDifferences> of_states, const SearchSpace& space,
                    const Eigen::VectorXd& prior)
      : of_states_(std::move(of_states)), space_(space), prior_(prior) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    of_states_->evaluate(space_.states(points, prior_), costs);
  }
  void move_to(Eigen::Index i) override { of_states_->move_to(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    return of_states_->normal_equations(space_.states(points, prior_), scale, costs);
  }

 private:
  std::unique_ptr<ResidualDifferences> of_states_;
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
};

}  // namespace

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  cost_.evaluate(space_.states(points, prior_), costs);
}

cuda::DeviceCost* SearchCost::device() {
  return cost_.device(space_.rotation_vectors() ? &prior_ : nullptr);
}

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  cost_.least_squares()->evaluate(space_.states(points, prior_), residuals, costs);
}

std::unique_ptr<ResidualDifferences> SearchCost::differences() {
  return std::make_unique<SearchDifferences>(cost_.least_squares()->differences(), space_, prior_);
}

NormalEquations SearchCost::linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                      const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) {
  return cost_.least_squares()->linearize(space_.states(points, prior_), steps, blur);
}

}  // namespace hypotrack
