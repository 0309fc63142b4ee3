#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "cost/cost.hpp"
#include "hypotrack/api/error.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::DepthPattern;
using test::hand_state;
using test::metres_and_radians;
using test::moved_states;
using test::Position;

/// Derivatives of half a cost by central differences.
Eigen::VectorXd half_gradient(Cost& cost, const Scene& scene, const Eigen::VectorXd& state,
                              const Eigen::VectorXd& steps) {
  const Eigen::MatrixXd forth = moved_states(scene, state, steps);
  const Eigen::MatrixXd back = moved_states(scene, state, -steps);
  Eigen::VectorXd plus(forth.cols()), minus(back.cols());
  cost.evaluate(forth, plus);
  cost.evaluate(back, minus);
  return (plus - minus).tail(steps.size()).cwiseQuotient(4 * steps);
}

/// A cost of one pattern, prepared for a frame, which must outlive it.
std::unique_ptr<Cost> pattern_cost(const Scene& scene, const Observation& frame) {
  auto cost = make_cost(scene, {{1, std::make_shared<DepthPattern>(0.2f, 0.5f)}},
                        {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
  cost->prepare(frame);
  return cost;
}

NormalEquations linearize(Cost& cost, const Scene& scene, const Eigen::VectorXd& state,
                          double blur = 1) {
  const Eigen::VectorXd steps = metres_and_radians(state.size() - 1, 2e-4, 2e-3);
  return cost.least_squares()->linearize(moved_states(scene, state, steps), steps, blur);
}

TEST(HostLinearizer, MakesAutomaticTakeTheCpuForTermsWithoutSlopesOnAGpu) {
  const Scene scene = test::hand_scene();
  for (const auto linearization : {Linearization::needed, Linearization::welcome}) {
    const auto cost = make_cost(scene, {{1, std::make_shared<DepthPattern>(0.2f, 0.5f), "pattern"}},
                                {}, {.least_squares = true, .jacobian = linearization});
    EXPECT_THAT(cost->backend(),
                testing::AllOf(testing::StartsWith("cpu"), testing::HasSubstr("not on a GPU: ")));
  }
}

class Linearize : public testing::TestWithParam<bool> {
 protected:
  Observation observation(const Scene& scene) const {
    return GetParam() ? test::rectified_pair(scene) : test::general_pair(scene);
  }
};

TEST_P(Linearize, IsTheNumericalJacobianWhereNoSilhouetteIsInSight) {
  const Scene wall({{"wall", std::make_shared<Model>(test::make_test_box({0.8, 0.8, 0.1}))}});
  Eigen::VectorXd state = wall.rest_state();
  state[2] = 0.6;
  state.segment<4>(3) << 0.98, 0.1, -0.15, 0.05;
  wall.normalize(state);
  const auto cost = make_cost(wall, {{1, std::make_shared<DepthPattern>(0.5f, 0.5f)}},
                              {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
  const Observation frame = observation(wall);
  cost->prepare(frame);
  ASSERT_TRUE(cost->least_squares()->can_linearize());
  const NormalEquations found = linearize(*cost, wall, state);

  const Eigen::VectorXd steps = metres_and_radians(6, 1e-3, 2e-3);
  const Eigen::MatrixXd forth = moved_states(wall, state, steps);
  const Eigen::MatrixXd back = moved_states(wall, state, -steps);
  Eigen::MatrixXf plus(cost->least_squares()->count(), 7), minus = plus;
  Eigen::VectorXd costs(7);
  cost->least_squares()->evaluate(forth, plus, costs);
  cost->least_squares()->evaluate(back, minus, costs);
  const Eigen::MatrixXd j =
      (plus - minus).rightCols(6).cast<double>() * (0.5 * steps.cwiseInverse()).asDiagonal();
  const Eigen::VectorXd r = plus.col(0).cast<double>();
  EXPECT_TRUE(found.a.isApprox(j.transpose() * j, 1e-2)) << found.a << "\n\n" << j.transpose() * j;
  EXPECT_TRUE(found.g.isApprox(j.transpose() * r, 1e-2)) << found.g << "\n\n" << j.transpose() * r;
}

TEST_P(Linearize, KnowsWhatMovingSilhouettesChange) {
  const Scene scene = test::hand_scene();
  // Without slopes there is nothing else.
  for (const float slope : {0.0f, 0.2f}) {
    const auto cost = make_cost(scene, {{1, std::make_shared<DepthPattern>(slope, 0.5f)}},
                                {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
    const Observation frame = observation(scene);
    cost->prepare(frame);
    // Means over how the silhouette lies on the grid of pixels, and over lengths of differences.
    const Eigen::VectorXd middle = hand_state(scene);
    const Eigen::Index size = middle.size() - 1;
    Eigen::VectorXd found = Eigen::VectorXd::Zero(size), expected = found;
    for (int i = 0; i < 8; ++i) {
      Eigen::VectorXd state = middle;
      state[0] += 0.7e-3 * i;
      state[1] += 1.1e-3 * (i % 3);
      found += linearize(*cost, scene, state).g;
      const double length = 0.8 + 0.2 * i;
      expected += half_gradient(*cost, scene, state,
                                metres_and_radians(size, length * 1e-3, length * 0.015));
    }
    // Numbers in units that make them alike.
    const Eigen::VectorXd unit = metres_and_radians(size, 0.02, 0.2);
    const double error = (found - expected).cwiseProduct(unit).norm();
    EXPECT_LT(error, 0.08 * expected.cwiseProduct(unit).norm())
        << slope << "\n"
        << found.cwiseProduct(unit).transpose() << "\n"
        << expected.cwiseProduct(unit).transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Pairs, Linearize, testing::Bool(),
                         [](const auto& pair) { return pair.param ? "Rectified" : "General"; });

TEST(HostLinearizer, FeelsSilhouettesLessFirmlyTheMoreTheyAreBlurred) {
  const Scene scene = test::hand_scene();
  const auto cost = make_cost(scene, {{1, std::make_shared<DepthPattern>(0.0f, 0.5f)}},
                              {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
  const Observation frame = test::rectified_pair(scene);
  cost->prepare(frame);
  const NormalEquations sharp = linearize(*cost, scene, hand_state(scene), 1);
  const NormalEquations soft = linearize(*cost, scene, hand_state(scene), 2);
  EXPECT_TRUE(soft.g.isApprox(sharp.g, 1e-5));
  EXPECT_TRUE((2 * soft.a).isApprox(sharp.a, 1e-5));
}

TEST(HostLinearizer, AddsTermsUpWithTheirWeights) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene);
  const auto of = [&](const std::vector<ObjectiveTerm>& terms) {
    const auto cost =
        make_cost(scene, terms, {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
    cost->prepare(frame);
    return linearize(*cost, scene, hand_state(scene));
  };
  const auto pattern = std::make_shared<DepthPattern>(0.2f, 0.5f);
  const auto other = std::make_shared<DepthPattern>(0.5f, 0.7f);
  const auto position = std::make_shared<Position>();
  const NormalEquations p = of({{1, pattern}}), o = of({{1, other}}), x = of({{1, position}});
  const NormalEquations all = of({{4, pattern}, {0.5, other}, {3, position}, {0, position}});
  EXPECT_TRUE(all.a.isApprox(4 * p.a + 0.5 * o.a + 3 * x.a, 1e-5));
  EXPECT_TRUE(all.g.isApprox(4 * p.g + 0.5 * o.g + 3 * x.g, 1e-5));
  Eigen::MatrixXd identity = Eigen::MatrixXd::Zero(x.a.rows(), x.a.cols());
  identity.topLeftCorner<3, 3>().setIdentity();
  EXPECT_TRUE(x.a.isApprox(identity, 1e-3));
}

TEST(HostLinearizer, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene);
  NormalEquations expected;
  for (const int threads : {1, 2, 5}) {
    const auto cost =
        make_cost(scene, {{1, std::make_shared<DepthPattern>(0.2f, 0.5f)}},
                  {.backend = Backend::cpu, .threads = threads}, {.least_squares = true});
    cost->prepare(frame);
    const NormalEquations found = linearize(*cost, scene, hand_state(scene));
    if (threads == 1) expected = found;
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.g, expected.g);
  }
}

TEST(HostLinearizer, OfABatchIsThatOfEachStateWithAnyNumberOfThreads) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene);
  const Eigen::VectorXd steps = metres_and_radians(scene.dimension() - 1, 2e-4, 2e-3);
  std::vector<Neighbourhood> batch;
  for (int i = 0; i < 9; ++i) {
    Eigen::VectorXd state = hand_state(scene);
    state[0] += 2e-3 * i;
    batch.push_back({moved_states(scene, state, steps), steps, 1});
  }
  std::vector<NormalEquations> expected;
  for (const int threads : {1, 3}) {
    const auto cost = make_cost(
        scene, {{1, std::make_shared<DepthPattern>(0.2f, 0.5f)}, {2, std::make_shared<Position>()}},
        {.backend = Backend::cpu, .threads = threads}, {.least_squares = true});
    cost->prepare(frame);
    const auto found = cost->least_squares()->linearize_each(batch);
    ASSERT_EQ(found.size(), batch.size());
    if (threads == 1) expected = found;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const NormalEquations one = cost->least_squares()->linearize(batch[i].points, steps, 1);
      EXPECT_TRUE(found[i].a.isApprox(one.a, 1e-4));
      EXPECT_TRUE(found[i].g.isApprox(one.g, 1e-4));
      EXPECT_EQ(found[i].a, expected[i].a);
      EXPECT_EQ(found[i].g, expected[i].g);
    }
  }
}

TEST(HostLinearizer, OfABatchFollowsTheFrameThatIsPrepared) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene), other = test::general_pair(scene);
  const auto cost = pattern_cost(scene, frame);
  const Eigen::VectorXd steps = metres_and_radians(scene.dimension() - 1, 2e-4, 2e-3);
  const std::vector<Neighbourhood> batch{{moved_states(scene, hand_state(scene), steps), steps, 1}};
  cost->least_squares()->linearize_each(batch);
  cost->prepare(other);
  const NormalEquations found = cost->least_squares()->linearize_each(batch).front();
  const NormalEquations expected = linearize(*cost, scene, hand_state(scene));
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4));
}

TEST(HostLinearizer, LeavesOutWhatHasNoRoomToMove) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene);
  const auto cost = pattern_cost(scene, frame);
  const Eigen::VectorXd state = hand_state(scene);
  Eigen::VectorXd steps = metres_and_radians(state.size() - 1, 2e-4, 2e-3);
  const NormalEquations all = linearize(*cost, scene, state);
  steps[1] = 0;
  const NormalEquations some =
      cost->least_squares()->linearize(moved_states(scene, state, steps), steps, 1);
  EXPECT_EQ(some.a.col(1).norm() + some.a.row(1).norm() + some.g[1], 0);
  EXPECT_EQ(some.g[2], all.g[2]);
}

TEST(HostLinearizer, OfOneFingerIsThatPartOfTheWhole) {
  const Scene scene = test::hand_scene();
  const Observation frame = test::rectified_pair(scene);
  const auto cost = pattern_cost(scene, frame);
  const Eigen::VectorXd state = hand_state(scene);
  const NormalEquations all = linearize(*cost, scene, state);
  Eigen::VectorXd steps = metres_and_radians(state.size() - 1, 2e-4, 2e-3);
  steps.head(6).setZero();
  steps.tail(steps.size() - 10).setZero();
  const NormalEquations finger =
      cost->least_squares()->linearize(moved_states(scene, state, steps), steps, 1);
  EXPECT_GT(finger.a.diagonal().segment(6, 4).minCoeff(), 0);
  EXPECT_TRUE(finger.a.block(6, 6, 4, 4).isApprox(all.a.block(6, 6, 4, 4), 1e-3));
  EXPECT_TRUE(finger.g.segment(6, 4).isApprox(all.g.segment(6, 4), 1e-3));
  Eigen::MatrixXd beside = finger.a;
  beside.block(6, 6, 4, 4).setZero();
  EXPECT_EQ(beside.norm(), 0);
}

/// A hand's residuals at a state and at its neighbours, with a term that looks at the state.
class Differences : public testing::Test {
 protected:
  std::unique_ptr<Cost> make(int threads = 1) {
    auto cost = make_cost(
        scene_,
        {{0.3, std::make_shared<DepthPattern>(0.2f, 0.5f)}, {2, std::make_shared<Position>()}},
        {.backend = Backend::cpu, .threads = threads}, {.least_squares = true});
    cost->prepare(frame_);
    return cost;
  }

  /// Normal equations of the residuals that a cost returns, in double precision.
  NormalEquations dense(Cost& cost, const Eigen::MatrixXd& states) {
    Eigen::MatrixXf r(cost.least_squares()->count(), states.cols());
    Eigen::VectorXd costs(states.cols());
    cost.least_squares()->evaluate(states, r, costs);
    const Eigen::VectorXd here = r.col(0).cast<double>();
    const Eigen::MatrixXd j =
        (r.rightCols(steps_.size()).cast<double>().colwise() - here) * scale_.asDiagonal();
    return {j.transpose() * j, j.transpose() * here};
  }

  Scene scene_ = test::hand_scene();
  Observation frame_ = test::rectified_pair(scene_);
  Eigen::VectorXd steps_ = metres_and_radians(scene_.dimension() - 1, 1e-3, 0.03);
  Eigen::VectorXd scale_ = steps_.cwiseInverse();
  Eigen::MatrixXd states_ = moved_states(scene_, hand_state(scene_), steps_);
};

TEST_F(Differences, GiveTheNormalEquationsOfTheResiduals) {
  scale_[4] = 0;
  const auto cost = make();
  const NormalEquations expected = dense(*cost, states_);
  const auto differences = cost->least_squares()->differences();
  Eigen::VectorXd here(1), costs(steps_.size()), plain(steps_.size());
  differences->evaluate(states_.leftCols(1), here);
  differences->move_to(0);
  const Eigen::MatrixXd beside = states_.rightCols(steps_.size());
  const NormalEquations found = differences->normal_equations(beside, scale_, costs);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4));
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-4));
  cost->evaluate(beside, plain);
  EXPECT_TRUE(costs.isApprox(plain, 1e-6));
}

TEST_F(Differences, DoNotDependOnTheNumberOfThreads) {
  NormalEquations expected;
  for (const int threads : {1, 2, 5}) {
    const auto cost = make(threads);
    const auto differences = cost->least_squares()->differences();
    Eigen::VectorXd here(1), costs(steps_.size());
    differences->evaluate(states_.leftCols(1), here);
    differences->move_to(0);
    const NormalEquations found =
        differences->normal_equations(states_.rightCols(steps_.size()), scale_, costs);
    if (threads == 1) expected = found;
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.g, expected.g);
  }
}

TEST_F(Differences, GoOnFromANeighbour) {
  const auto cost = make();
  const auto differences = cost->least_squares()->differences();
  Eigen::VectorXd here(1), costs(steps_.size());
  differences->evaluate(states_.leftCols(1), here);
  differences->move_to(0);
  const Eigen::MatrixXd beside = states_.rightCols(steps_.size());
  differences->normal_equations(beside, scale_, costs);
  differences->move_to(2);
  const NormalEquations found = differences->normal_equations(beside, scale_, costs);
  states_.col(0) = beside.col(2);
  const NormalEquations expected = dense(*cost, states_);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4));
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-4));
}

}  // namespace
}  // namespace hypotrack
