#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cost/cost.hpp"
#include "device.hpp"
#include "every_target.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "observations.hpp"
#include "probes.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::covered_probe;
using test::mark_probe;
using test::seen_probe;

Scene two_hands() {
  return Scene({{"right", std::make_shared<Model>(test::make_test_hand())},
                {"left", std::make_shared<Model>(mirrored(test::make_test_hand()))}});
}

/// Joints that turn, slide and follow others, beside a hand.
Scene hand_and_cabinet() {
  return Scene({{"hand", std::make_shared<Model>(test::make_test_hand())},
                {"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
}

/// More vertices than shared memory holds.
Scene fine_mesh() {
  ModelData ball = test::make_test_box({0.1, 0.1, 0.1});
  for (int round = 0; round < 6; ++round) {  // every triangle into four, 49,152 in the end
    Mesh fine = ball.mesh;
    const Eigen::Index count = ball.mesh.triangles.cols();
    fine.vertices.resize(3, 6 * count);
    fine.triangles.resize(3, 4 * count);
    for (Eigen::Index t = 0; t < count; ++t) {
      const auto corner = [&](int k) { return ball.mesh.vertices.col(ball.mesh.triangles(k, t)); };
      const int first = static_cast<int>(6 * t);
      for (int k = 0; k < 3; ++k) {
        fine.vertices.col(first + k) = corner(k);
        fine.vertices.col(first + 3 + k) = (corner(k) + corner((k + 1) % 3)) / 2;
      }
      const int all[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
      for (int k = 0; k < 4; ++k) {
        fine.triangles.col(4 * t + k) =
            Eigen::Vector3i(first + all[k][0], first + all[k][1], first + all[k][2]);
      }
    }
    fine.bone_indices = Eigen::Matrix4Xi::Zero(4, fine.vertices.cols());
    fine.bone_weights = Eigen::Matrix4Xf::Zero(4, fine.vertices.cols());
    fine.bone_weights.row(0).setOnes();
    ball.mesh = fine;
  }
  return Scene({{"ball", std::make_shared<Model>(ball)}});
}

Eigen::MatrixXd random_states(const Scene& scene, int count) {
  std::mt19937_64 random(7);
  Eigen::MatrixXd states(scene.dimension(), count);
  for (int i = 0; i < count; ++i) states.col(i) = test::random_state(scene, random);
  return states;
}

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const std::shared_ptr<Objective>& objective,
                         const Eigen::MatrixXd& states) {
  const auto cost = make_cost(scene, {{1, objective}}, {.backend = backend});
  cost->prepare(observation);
  Eigen::VectorXd costs(states.cols());
  cost->evaluate(states, costs);
  return costs;
}

void expect_like_the_cpu(const Scene& scene, const Observation& observation,
                         const std::shared_ptr<Objective>& objective, int count) {
  const Eigen::MatrixXd states = random_states(scene, count);
  const Eigen::VectorXd cpu = costs_on(Backend::cpu, scene, observation, objective, states);
  const Eigen::VectorXd gpu = costs_on(Backend::cuda, scene, observation, objective, states);
  ASSERT_GT(cpu.mean(), 300);  // pixels: something is drawn
  const Eigen::ArrayXd difference = (gpu - cpu).array().abs();
  // Probes map pixels on the host without fused operations, and a CPU that has none moves vertices
  // by some 1e-5 pixels, so that rarely one pixel is covered, or seen, on one side
  // only: once in either direction, at less than 1.5 each.
  EXPECT_TRUE((difference < (1e-3 * cpu.array()).max(3)).all()) << difference.maxCoeff();
  EXPECT_LT((difference / cpu.array().max(1000)).mean(), 5e-5);
  const Eigen::VectorXd again = costs_on(Backend::cuda, scene, observation, objective, states);
  EXPECT_EQ(gpu, again);
}

class CudaCostTest : public testing::TestWithParam<int> {  // hypotheses in a batch
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_P(CudaCostTest, CoversTheCpusPixelsInEveryView) {
  for (const Scene& scene :
       {test::hand_scene(), test::hand_and_box_scene(), two_hands(), hand_and_cabinet()}) {
    expect_like_the_cpu(scene, test::rectified_pair(scene), covered_probe(), GetParam());
    expect_like_the_cpu(scene, test::general_pair(scene), covered_probe(), GetParam());
  }
}

TEST_P(CudaCostTest, DrawsForAnObjectiveThatOnlyScoresWhatIsDrawn) {
  const Scene scene = test::hand_and_box_scene();
  const Eigen::MatrixXd states = random_states(scene, GetParam());
  for (const Observation& o : {test::rectified_pair(scene), test::general_pair(scene)}) {
    const Eigen::VectorXd cpu = costs_on(Backend::cpu, scene, o, test::edge_probe(), states);
    const Eigen::VectorXd gpu = costs_on(Backend::cuda, scene, o, test::edge_probe(), states);
    EXPECT_GT(cpu.maxCoeff(), 100);
    EXPECT_LE((gpu - cpu).cwiseAbs().maxCoeff(), 4);  // a pixel that rounding covers has two edges
  }
}

TEST_P(CudaCostTest, DrawsTheCpusPixelsToTheLastBit) {
  if (!test::fuses_products_and_sums()) GTEST_SKIP() << "this CPU has no fused multiply-add";
  for (const Scene& scene :
       {test::hand_scene(), test::hand_and_box_scene(), two_hands(), hand_and_cabinet()}) {
    const Eigen::MatrixXd states = random_states(scene, GetParam());
    for (const Observation& o : {test::rectified_pair(scene), test::general_pair(scene)}) {
      EXPECT_EQ(costs_on(Backend::cuda, scene, o, mark_probe(), states),
                costs_on(Backend::cpu, scene, o, mark_probe(), states));
    }
  }
}

TEST_P(CudaCostTest, SeesWhatTheCpuSeesInARectifiedPair) {
  for (const Scene& scene :
       {test::hand_scene(), test::hand_and_box_scene(), two_hands(), hand_and_cabinet()}) {
    for (const int size : {61, 128, 300}) {
      const Observation observation = test::rectified_pair(scene, size);
      expect_like_the_cpu(scene, observation, seen_probe(false), GetParam());
      expect_like_the_cpu(scene, observation, seen_probe(true), GetParam());
    }
  }
}

TEST_P(CudaCostTest, SeesWhatTheCpuSeesInAGeneralPair) {
  for (const Scene& scene :
       {test::hand_scene(), test::hand_and_box_scene(), two_hands(), hand_and_cabinet()}) {
    const Observation observation = test::general_pair(scene);
    expect_like_the_cpu(scene, observation, seen_probe(false), GetParam());
    expect_like_the_cpu(scene, observation, seen_probe(true), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(BatchSizes, CudaCostTest, testing::Values(1, 5, 33, 150, 1000));

TEST(CudaCost, DrawsMeshesThatDoNotFitIntoSharedMemory) {
  SKIP_WITHOUT_DEVICE();
  const Scene scene = fine_mesh();
  expect_like_the_cpu(scene, test::rectified_pair(scene), seen_probe(false), 7);
  expect_like_the_cpu(scene, test::general_pair(scene), seen_probe(false), 7);
  expect_like_the_cpu(scene, test::general_pair(scene), covered_probe(), 7);
}

TEST(CudaCost, DrawsLargeTilesInPieces) {
  SKIP_WITHOUT_DEVICE();
  const Scene scene = test::hand_and_box_scene();
  expect_like_the_cpu(scene, test::rectified_pair(scene, 1024), seen_probe(false), 3);
  expect_like_the_cpu(scene, test::rectified_pair(scene, 1024), seen_probe(false), 200);
}

TEST(CudaCost, LeavesOutWhatCannotBeDrawn) {
  SKIP_WITHOUT_DEVICE();
  const Scene scene = test::hand_and_box_scene();
  const Observation observation = test::rectified_pair(scene);
  Eigen::MatrixXd states = random_states(scene, 6);
  states(2, 0) = -0.5;                                      // behind the cameras
  states(0, 1) = 1e7;                                       // beyond what makes sense
  states(9, 2) = std::numeric_limits<double>::quiet_NaN();  // an angle of the hand
  states(27, 3) = std::numeric_limits<double>::infinity();  // the box's position
  states(2, 4) = 0.02;                                      // through the image plane
  states.col(5).segment<4>(3).setZero();                    // no rotation at all
  const auto cpu = costs_on(Backend::cpu, scene, observation, seen_probe(false), states);
  const auto gpu = costs_on(Backend::cuda, scene, observation, seen_probe(false), states);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(gpu[i], cpu[i], 1e-3 * cpu[i] + 1e-9) << i;
}

TEST(CudaCost, TakesFramesThatNobodySearchesAndEmptyBatches) {
  SKIP_WITHOUT_DEVICE();
  const Scene scene = test::hand_scene();
  const Observation small = test::rectified_pair(scene, 64), large = test::rectified_pair(scene);
  const Eigen::MatrixXd states = random_states(scene, 3);
  const auto cost = make_cost(scene, {{1, covered_probe()}}, {.backend = Backend::cuda});
  cost->prepare(small);
  cost->prepare(large);
  Eigen::VectorXd costs(3), none(0);
  cost->evaluate(Eigen::MatrixXd(scene.dimension(), 0), none);
  cost->evaluate(states, costs);
  EXPECT_EQ(costs, costs_on(Backend::cuda, scene, large, covered_probe(), states));
}

TEST(CudaCost, AddsTermsUpWithTheirWeights) {
  SKIP_WITHOUT_DEVICE();
  const Scene scene = test::hand_scene();
  const Observation observation = test::rectified_pair(scene);
  const Eigen::MatrixXd states = random_states(scene, 40);
  const auto costs = [&](std::vector<ObjectiveTerm> terms) {
    const auto cost = make_cost(scene, std::move(terms), {.backend = Backend::cuda});
    cost->prepare(observation);
    Eigen::VectorXd out(states.cols());
    cost->evaluate(states, out);
    return out;
  };
  const Eigen::VectorXd both =
      costs({{2, covered_probe()}, {0, seen_probe(true)}, {0.5, seen_probe(false)}});
  const Eigen::VectorXd a = costs({{1, covered_probe()}}), b = costs({{1, seen_probe(false)}});
  EXPECT_TRUE(both.isApprox(2 * a + 0.5 * b, 1e-6));  // pixels are added in another order
}

TEST(CudaCost, SaysWhichTermIsNotForTheGpu) {
  SKIP_WITHOUT_DEVICE();
  class OnlyCpu final : public Objective {
    void do_prepare(const Observation&) override {}
    double do_cost(const RenderedHypothesis&) const override { return 0; }
  };
  const Scene scene = test::hand_scene();
  const std::string message = test::message_of<DeviceError>([&] {
    make_cost(scene, {{1, std::make_shared<OnlyCpu>(), "prior"}}, {.backend = Backend::cuda});
  });
  EXPECT_THAT(message, testing::HasSubstr("objective prior has no device capability"));
  EXPECT_THAT(message, testing::HasSubstr("backend: cpu"));
}

TEST(CudaCost, WithoutADeviceTheErrorSaysWhyAndWhatToWrite) {
  if (cuda::why_no_device().empty()) GTEST_SKIP() << "there is a GPU";
  const Scene scene = test::hand_scene();
  const std::string message = test::message_of<DeviceError>([&] {
    make_cost(scene, {{1, covered_probe()}}, {.backend = Backend::cuda});
  });
  EXPECT_THAT(message, testing::StartsWith("evaluate.backend: cuda: "));
  EXPECT_THAT(message, testing::HasSubstr(cuda::why_no_device()));
  EXPECT_THAT(message, testing::HasSubstr("`backend: cpu`"));
}

}  // namespace
}  // namespace hypotrack
