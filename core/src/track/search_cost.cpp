#include "track/search_cost.hpp"

#include <utility>

namespace hypotrack {
namespace {

void add_to(RecordedSearch* record, const Eigen::MatrixXd& states, const Eigen::VectorXd& costs) {
  if (record) record->batches.push_back({states, costs});
}

/// Residual differences of search points; the residuals stay where the cost of states has them.
class SearchDifferences final : public ResidualDifferences {
 public:
  SearchDifferences(std::unique_ptr<ResidualDifferences> of_states, const SearchSpace& space,
                    const Eigen::VectorXd& prior, RecordedSearch* record)
      : of_states_(std::move(of_states)), space_(space), prior_(prior), record_(record) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd states = space_.states(points, prior_);
    of_states_->evaluate(states, costs);
    add_to(record_, states, costs);
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
  RecordedSearch* record_;
};

}  // namespace

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::MatrixXd states = space_.states(points, prior_);
  cost_.evaluate(states, costs);
  add_to(record_, states, costs);
}

cuda::DeviceCost* SearchCost::device() {
  cuda::DeviceCost* device = cost_.device(space_.rotation_vectors() ? &prior_ : nullptr);
  if (record_ && device) record_->on_device = true;
  return device;
}

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::MatrixXd states = space_.states(points, prior_);
  cost_.least_squares()->evaluate(states, residuals, costs);
  add_to(record_, states, costs);
}

std::unique_ptr<ResidualDifferences> SearchCost::differences() {
  return std::make_unique<SearchDifferences>(cost_.least_squares()->differences(), space_, prior_,
                                             record_);
}

NormalEquations SearchCost::linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                      const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) {
  return cost_.least_squares()->linearize(space_.states(points, prior_), steps, blur);
}

std::vector<NormalEquations> SearchCost::linearize_each(std::span<const Neighbourhood> points) {
  std::vector<Neighbourhood> states;
  for (const Neighbourhood& at : points) {
    states.push_back({space_.states(at.points, prior_), at.steps, at.blur});
  }
  return cost_.least_squares()->linearize_each(states);
}

}  // namespace hypotrack
