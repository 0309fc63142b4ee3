// Analytic Jacobians on the GPU: normal equations of several terms at once.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "device.hpp"
#include "device_scores.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "plausible_motion.hpp"
#include "rgbd_depth.hpp"
#include "skin.hpp"
#include "stereo_color.hpp"
#include "stereo_patch.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

std::shared_ptr<Objective> colors_with_slopes(stereo_color::Direction direction) {
  stereo_color::Params params;
  params.beta = 2;  // the made-up views are not that alike
  params.direction = direction;
  return std::make_shared<stereo_color::StereoColor>(params);
}

/// Terms of both views, of one view and of the state.
std::vector<ObjectiveTerm> terms_with_slopes(const Scene& scene) {
  return {{1, colors_with_slopes(stereo_color::Direction::both), "stereo_color"},
          {0, colors_with_slopes(stereo_color::Direction::left_to_right), "unused"},
          {0.04,
           std::make_shared<plausible_motion::PlausibleMotion>(
               plausible_motion::PlausibleMotionParams{}, scene),
           "plausible_motion"},
          {0.3, std::make_shared<skin::Skin>(skin::Params{}), "skin"},
          {2, std::make_shared<stereo_patch::StereoPatch>(stereo_patch::Params{}), "stereo_patch"}};
}

NormalEquations linearize(Cost& cost, const Scene& scene, const Eigen::VectorXd& state,
                          const Eigen::VectorXd& steps) {
  Eigen::MatrixXd states(state.size(), steps.size() + 1);
  states.col(0) = state;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    states.col(i + 1) = moved(scene, state, steps[i] * Eigen::VectorXd::Unit(steps.size(), i));
  }
  return cost.least_squares()->linearize(states, steps, 1.5);
}

/// Steps of a fraction of a pixel: metres, then radians, of every model.
Eigen::VectorXd steps_of(const Scene& scene) {
  const auto models = static_cast<Eigen::Index>(scene.items().size());
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(scene.dimension() - models, 2e-3);
  for (Eigen::Index i = 0; i < models; ++i) {
    const Scene::Item& item = scene.items()[static_cast<std::size_t>(i)];
    steps.segment<3>(item.offset - i).setConstant(3e-4);
  }
  return steps;
}

/// Expects two matrices to be equal up to a share of the roots of the diagonal's products.
void expect_near(const NormalEquations& found, const NormalEquations& expected, double share) {
  const Eigen::VectorXd root = expected.a.diagonal().cwiseSqrt();
  EXPECT_LT(((found.a - expected.a).array() / (root * root.transpose()).array().max(1e-12))
                .abs()
                .maxCoeff(),
            share);
  EXPECT_LT((found.g - expected.g).cwiseAbs().cwiseQuotient(root.cwiseMax(1e-6)).maxCoeff(),
            share * expected.g.cwiseQuotient(root.cwiseMax(1e-6)).cwiseAbs().maxCoeff());
}

class DeviceLinearizer : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }

  /// Compares the GPU's normal equations of some states with the CPU's.
  static void compare(const Scene& scene, Observation frame, std::vector<ObjectiveTerm> terms,
                      std::vector<ObjectiveTerm> again, const Eigen::VectorXd& steps) {
    const Eigen::MatrixXd states = test::scored_states(scene);
    frame.start = states.col(0);
    const auto cpu = make_cost(scene, std::move(terms), {.backend = Backend::cpu, .threads = 2},
                               {.least_squares = true});
    const auto gpu =
        make_cost(scene, std::move(again), {.backend = Backend::cuda}, {.least_squares = true});
    cpu->prepare(frame);
    gpu->prepare(frame);
    ASSERT_TRUE(gpu->least_squares()->can_linearize());
    for (const Eigen::Index i : {0, 3, 7}) {
      SCOPED_TRACE(i);
      const NormalEquations expected = linearize(*cpu, scene, states.col(i), steps);
      const NormalEquations found = linearize(*gpu, scene, states.col(i), steps);
      EXPECT_GT(expected.a.diagonal().maxCoeff(), 0);
      expect_near(found, expected, 0.01);
      const NormalEquations repeated = linearize(*gpu, scene, states.col(i), steps);
      EXPECT_EQ(repeated.a, found.a);
      EXPECT_EQ(repeated.g, found.g);
    }
  }
};

TEST_F(DeviceLinearizer, GivesTheNormalEquationsOfTheCpu) {
  const Scene scene = test::hand_scene();
  for (const Observation& frame :
       {test::rectified_pair(scene, 128), test::general_pair(scene, 128)}) {
    compare(scene, test::colored(frame), terms_with_slopes(scene), terms_with_slopes(scene),
            steps_of(scene));
  }
}

TEST_F(DeviceLinearizer, TakesMoreColumnsThanAWarpHasThreads) {
  const Scene scene = test::hand_and_box_scene();
  ASSERT_GT(steps_of(scene).size(), 31);
  compare(scene, test::colored(test::rectified_pair(scene, 192)), terms_with_slopes(scene),
          terms_with_slopes(scene), steps_of(scene));
}

TEST_F(DeviceLinearizer, LeavesOutWhatDoesNotMove) {
  const Scene scene = test::hand_scene();
  Eigen::VectorXd steps = steps_of(scene);
  steps.head(10).setZero();
  steps[15] = 0;
  compare(scene, test::colored(test::rectified_pair(scene, 128)), terms_with_slopes(scene),
          terms_with_slopes(scene), steps);
}

TEST_F(DeviceLinearizer, TakesTermsOfTheStateAlone) {
  const Scene scene = test::hand_scene();
  const auto terms = [&] {
    return std::vector<ObjectiveTerm>{{0.04,
                                       std::make_shared<plausible_motion::PlausibleMotion>(
                                           plausible_motion::PlausibleMotionParams{}, scene),
                                       "plausible_motion"}};
  };
  compare(scene, test::colored(test::rectified_pair(scene, 128)), terms(), terms(),
          steps_of(scene));
}

TEST_F(DeviceLinearizer, AddsTermsThatStayOnTheCpu) {
  const Scene scene = test::hand_scene();
  const auto terms = [&] {
    std::vector<ObjectiveTerm> all = terms_with_slopes(scene);
    all.push_back({300, std::make_shared<test::Position>(), "position"});
    return all;
  };
  compare(scene, test::colored(test::rectified_pair(scene, 128)), terms(), terms(),
          steps_of(scene));
}

TEST_F(DeviceLinearizer, AddsTermsWithoutSlopesByDrawingTheNeighbours) {
  const Scene scene = test::hand_scene();
  const auto terms = [&] {
    std::vector<ObjectiveTerm> all = terms_with_slopes(scene);
    all.insert(all.begin() + 3,
               {0.5, std::make_shared<rgbd_depth::RgbdDepth>(rgbd_depth::Params{}), "rgbd_depth"});
    return all;
  };
  const Observation frame = test::with_depth(test::colored(test::rectified_pair(scene, 128)));
  compare(scene, frame, terms(), terms(), steps_of(scene));
  const auto gpu = make_cost(scene, terms(), {.backend = Backend::cuda},
                             {.least_squares = true, .jacobian = Linearization::needed});
  EXPECT_TRUE(gpu->least_squares()->draws_neighbours());
}

TEST_F(DeviceLinearizer, LinearizesManyPointsAsIfEachWereAlone) {
  const Scene scene = test::hand_scene();
  std::vector<ObjectiveTerm> terms = terms_with_slopes(scene);
  terms.push_back(
      {0.5, std::make_shared<rgbd_depth::RgbdDepth>(rgbd_depth::Params{}), "rgbd_depth"});
  Observation frame = test::with_depth(test::colored(test::rectified_pair(scene, 96)));
  frame.start = test::scored_states(scene).col(0);
  const auto gpu =
      make_cost(scene, std::move(terms), {.backend = Backend::cuda}, {.least_squares = true});
  gpu->prepare(frame);
  const Eigen::VectorXd steps = steps_of(scene);
  std::vector<Neighbourhood> points;
  for (Eigen::Index i = 0; i < 11; ++i)  // more than are linearised together
    points.push_back(
        {test::moved_states(scene, test::scored_states(scene).col(i), steps), steps, 1.5});
  const std::vector<NormalEquations> all = gpu->least_squares()->linearize_each(points);
  ASSERT_EQ(all.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    SCOPED_TRACE(i);
    const NormalEquations alone = gpu->least_squares()->linearize_each({&points[i], 1}).front();
    expect_near(all[i], alone, 1e-4);
  }
}

/// Work that comes again is launched as a graph, of arguments that must still hold.
TEST_F(DeviceLinearizer, RepeatsWorkOfChangingBatchesAndFrames) {
  constexpr int kRounds = 4;  // the second of a batch makes its graph
  const Scene scene = test::hand_scene();
  const Eigen::VectorXd steps = steps_of(scene);
  const auto make_gpu = [&] {
    return make_cost(scene, terms_with_slopes(scene), {.backend = Backend::cuda},
                     {.least_squares = true});
  };
  const auto kept = make_gpu();
  const Eigen::MatrixXd states = test::scored_states(scene);
  for (const int size : {96, 96, 128, 96}) {
    Observation frame = test::colored(test::rectified_pair(scene, size));
    frame.start = states.col(0);
    kept->prepare(frame);
    for (int round = 0; round < kRounds; ++round)
      for (const Eigen::Index count : {1, 3, 8, 2}) {
        SCOPED_TRACE(testing::Message() << size << " " << round << " " << count);
        const auto fresh = make_gpu();
        fresh->prepare(frame);
        const Eigen::MatrixXd batch = states.middleCols(round, count);
        Eigen::VectorXd found(count), expected(count);
        kept->evaluate(batch, found);
        fresh->evaluate(batch, expected);
        EXPECT_EQ(found, expected);
        const NormalEquations again = linearize(*kept, scene, batch.col(0), steps);
        const NormalEquations once = linearize(*fresh, scene, batch.col(0), steps);
        EXPECT_EQ(again.a, once.a);
        EXPECT_EQ(again.g, once.g);
      }
  }
}

/// The shared memory that a kernel may use is the same for all trackers of the process.
TEST_F(DeviceLinearizer, LinearizesScenesOfAllSizesAtTheSameTime) {
  constexpr int kRounds = 300;
  const Scene small = test::hand_scene(), large = test::hand_and_box_scene();
  std::vector<std::jthread> threads;
  for (const Scene* scene : {&small, &large, &small, &large})
    threads.emplace_back([scene] {
      const auto linearize_often = [&] {
        const auto gpu = make_cost(*scene, terms_with_slopes(*scene), {.backend = Backend::cuda},
                                   {.least_squares = true});
        Observation frame = test::colored(test::rectified_pair(*scene, 96));
        frame.start = test::scored_states(*scene).col(0);
        gpu->prepare(frame);
        for (int i = 0; i < kRounds; ++i) linearize(*gpu, *scene, frame.start, steps_of(*scene));
      };
      EXPECT_NO_THROW(linearize_often());
    });
}

TEST_F(DeviceLinearizer, SeesNothingOfAHandBesideThePictures) {
  const Scene scene = test::hand_scene();
  Observation frame = test::colored(test::rectified_pair(scene, 128));
  frame.start = test::scored_states(scene).col(0);
  const auto gpu =
      make_cost(scene, {{1, colors_with_slopes(stereo_color::Direction::both), "stereo_color"}},
                {.backend = Backend::cuda}, {.least_squares = true});
  gpu->prepare(frame);
  Eigen::VectorXd state = frame.start;
  state[0] = 30;
  const NormalEquations found = linearize(*gpu, scene, state, steps_of(scene));
  EXPECT_EQ(found.a.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(found.g.cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace hypotrack
