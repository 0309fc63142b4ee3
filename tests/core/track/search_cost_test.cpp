#include "track/search/search_cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// Half the squared distance of the position from the origin, with an analytic Jacobian.
class SquaredDistance final : public Cost, public StateResiduals {
 public:
  explicit SquaredDistance(const Scene& scene) : Cost(scene, {}) { prepare(Observation()); }

  bool draws = false;  ///< linearize() takes neighbours, too

  std::string backend() const override { return "none"; }
  StateResiduals* least_squares() override { return this; }

  Eigen::Index count() const override { return 3; }
  using Cost::evaluate;
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override {
    residuals = states.topRows(3).cast<float>();
    evaluate_normalized(states, costs);
  }
  std::vector<ResidualRows> pose_only() const override { return {}; }
  bool can_linearize() const override { return true; }
  bool draws_neighbours() const override { return draws; }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double) override {
    return {Eigen::MatrixXd::Identity(steps.size(), steps.size()),
            states(0, 0) * Eigen::VectorXd::Unit(steps.size(), 0)};
  }

 private:
  void prepare_observation(const Observation&) override {}
  void evaluate_normalized(const Eigen::MatrixXd& states,
                           Eigen::Ref<Eigen::VectorXd> costs) override {
    costs = states.topRows(3).colwise().squaredNorm().transpose() / 2;
  }
};

struct SearchCostTest : ::testing::Test {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  SquaredDistance cost{scene};
  SearchSpace space{scene, tangent()};
  Eigen::VectorXd prior = scene.rest_state();

  static SearchSettings tangent() {
    SearchSettings out;
    out.rotation_as = RotationCoordinates::tangent;
    return out;
  }
  /// Returns the prior as a search point, `x` metres along the first axis.
  Eigen::VectorXd point(double x) const {
    Eigen::VectorXd out = space.region(prior).start;
    out[0] = x;
    return out;
  }
  Neighbourhood around(const Eigen::VectorXd& at) const {
    Eigen::MatrixXd points = at.replicate(1, at.size() + 1);
    points.rightCols(at.size()).diagonal().array() += 0.01;
    return {points, Eigen::VectorXd::Constant(at.size(), 0.01)};
  }
};

TEST_F(SearchCostTest, CountsEveryJacobianAsAnEvaluation) {
  SearchCost search(cost, space, prior);
  const Neighbourhood at = around(point(0.1));
  search.linearize(at.points, at.steps, 1);
  EXPECT_EQ(search.tally().evaluations, 1);
  const std::vector<Neighbourhood> two{at, around(point(0.2))};
  search.linearize_each(two);
  EXPECT_EQ(search.tally().evaluations, 3);
}

TEST_F(SearchCostTest, CountsTheNeighboursThatAJacobianTakes) {
  cost.draws = true;
  SearchCost search(cost, space, prior);
  const Neighbourhood at = around(point(0.1));
  search.linearize(at.points, at.steps, 1);
  const std::int64_t each = 1 + space.dimension();
  EXPECT_EQ(search.tally().evaluations, each);
  const std::vector<Neighbourhood> two{at, at};
  search.linearize_each(two);
  EXPECT_EQ(search.tally().evaluations, 3 * each);
}

}  // namespace
}  // namespace hypotrack
