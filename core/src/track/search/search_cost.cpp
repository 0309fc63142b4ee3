#include "track/search/search_cost.hpp"

#include <algorithm>
#include <utility>

#include "base/profile.hpp"

namespace hypotrack::internal {
namespace {

void add_to(RecordedSearch* record, const Eigen::MatrixXd& states, const Eigen::VectorXd& costs) {
  if (record) record->batches.push_back({states, costs});
}

/// Residual differences of search points; the residuals stay where the cost of states has them.
class PointDifferences final : public ResidualDifferences {
 public:
  PointDifferences(std::unique_ptr<ResidualDifferences> of_states, const SearchSpace& space,
                   const Eigen::VectorXd& prior, RecordedSearch* record, EvaluationTally& tally)
      : of_states_(std::move(of_states)),
        space_(space),
        prior_(prior),
        record_(record),
        tally_(tally) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd states = space_.states(points, prior_);
    const ProfiledPart part("residuals kept");
    tally_.count(states.cols(), [&] { of_states_->evaluate(states, costs); });
    tally_.add(costs);
    add_to(record_, states, costs);
  }
  void move_to(Eigen::Index i) override { of_states_->move_to(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd states = space_.states(points, prior_);
    const ProfiledPart part("normal equations");
    NormalEquations sums = tally_.count(
        states.cols(), [&] { return of_states_->normal_equations(states, scale, costs); });
    tally_.add(costs);
    return sums;
  }

 private:
  std::unique_ptr<ResidualDifferences> of_states_;
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  RecordedSearch* record_;
  EvaluationTally& tally_;
};

}  // namespace

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  const ProfiledPart part("costs");
  constexpr Eigen::Index kMost = 1 << 14;  // points between two looks whether the search has to end
  for (Eigen::Index first = 0; first < points.cols(); first += kMost) {
    const Eigen::Index count = std::min(kMost, points.cols() - first);
    const Eigen::MatrixXd states = space_.states(points.middleCols(first, count), prior_);
    auto own = costs.segment(first, count);
    tally_.count(count, [&] { cost_.evaluate(states, own); });
    tally_.add(own);
    add_to(record_, states, own);
  }
}

cuda::DeviceCost* SearchCost::device() {
  cuda::DeviceCost* device = cost_.device(space_.rotation_vectors() ? &prior_ : nullptr);
  if (record_ && device) record_->on_device = true;
  tally_.on_device = tally_.on_device || device;
  return device;
}

void SearchCost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                          Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::MatrixXd states = space_.states(points, prior_);
  const ProfiledPart part("residuals");
  tally_.count(states.cols(), [&] { cost_.least_squares()->evaluate(states, residuals, costs); });
  tally_.add(costs);
  add_to(record_, states, costs);
}

std::unique_ptr<ResidualDifferences> SearchCost::differences() {
  return std::make_unique<PointDifferences>(cost_.least_squares()->differences(), space_, prior_,
                                            record_, tally_);
}

NormalEquations SearchCost::linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                      const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) {
  const Eigen::MatrixXd states = space_.states(points, prior_);
  const ProfiledPart part("linearize");
  NormalEquations out = tally_.count(linearize_price(steps.size()), [&] {
    return cost_.least_squares()->linearize(states, steps, blur);
  });
  tally_.trace();
  return out;
}

std::vector<NormalEquations> SearchCost::linearize_each(std::span<const Neighbourhood> points) {
  std::vector<Neighbourhood> states;
  for (const Neighbourhood& at : points) {
    states.push_back({space_.states(at.points, prior_), at.steps, at.blur});
  }
  const ProfiledPart part("linearize many");
  std::vector<NormalEquations> out =
      tally_.count(std::ssize(states) * linearize_price(dimension()),
                   [&] { return cost_.least_squares()->linearize_each(states); });
  tally_.trace();
  return out;
}

}  // namespace hypotrack::internal
