// Residuals on the GPU: of several terms at once, in goes, and of terms that have none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "device.hpp"
#include "device_scores.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "interpenetration.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "plausible_motion.hpp"
#include "probes.hpp"
#include "rgbd_depth.hpp"
#include "skin.hpp"
#include "stereo_color.hpp"
#include "stereo_patch.hpp"

namespace hypotrack {
namespace {

std::shared_ptr<Objective> colors(stereo_color::Direction direction,
                                  stereo_color::Params params = {}) {
  params.beta = 2;  // the made-up views are not that alike
  params.direction = direction;
  params.lookup = stereo_color::Lookup::bilinear;
  return std::make_shared<stereo_color::StereoColor>(params);
}

/// Terms over pixels of both kinds and of the state; one with weight 0 between them.
std::vector<ObjectiveTerm> many_terms(const Scene& scene) {
  return {{1, colors(stereo_color::Direction::both), "stereo_color"},
          {0, colors(stereo_color::Direction::left_to_right), "unused"},
          {0.04,
           std::make_shared<plausible_motion::PlausibleMotion>(
               plausible_motion::PlausibleMotionParams{}, scene),
           "plausible_motion"},
          {0.3, std::make_shared<skin::Skin>(skin::Params{}), "skin"},
          {0.001,
           std::make_shared<interpenetration::Interpenetration>(
               interpenetration::InterpenetrationParams{}, scene),
           "interpenetration"},
          {2, std::make_shared<stereo_patch::StereoPatch>(stereo_patch::Params{}), "stereo_patch"}};
}

Observation frame_of(const Scene& scene, int size) {
  Observation observation = test::colored(test::rectified_pair(scene, size));
  observation.start = test::scored_states(scene).col(0);
  return observation;
}

class DeviceResiduals : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(DeviceResiduals, OfSeveralTermsAreThoseOfTheCpu) {
  for (const Scene& scene : {test::hand_scene(), test::hand_and_box_scene()}) {
    test::expect_residuals_like_the_cpu(scene, frame_of(scene, 256), many_terms(scene),
                                        many_terms(scene), test::scored_states(scene).leftCols(29));
  }
}

TEST_F(DeviceResiduals, OfTermsOnTheCpuStandBesideThoseOfTheGpu) {
  const Scene scene = test::hand_scene();
  const auto terms = [&] {
    std::vector<ObjectiveTerm> all = many_terms(scene);
    all.push_back({0.7, std::make_shared<test::Position>(), "position"});
    return all;
  };
  test::expect_residuals_like_the_cpu(scene, frame_of(scene, 256), terms(), terms(),
                                      test::scored_states(scene).leftCols(29));
  const auto gpu = make_cost(scene, terms(), {.backend = Backend::cuda}, {.least_squares = true});
  EXPECT_THAT(gpu->backend(), testing::MatchesRegex("cuda \\(.*\\); on the CPU: position"));
}

TEST_F(DeviceResiduals, OfTermsOnTheCpuLeaveNoSearchOnTheGpu) {
  const Scene scene = test::hand_scene();
  const std::vector<ObjectiveTerm> terms = {
      {1, colors(stereo_color::Direction::both), "stereo_color"},
      {1, std::make_shared<test::Position>(), "position"}};
  const Requirements device{
      .device = true, .device_by = "pso_cuda", .instead_of_device = "write `type: pso`"};
  EXPECT_EQ(test::message_of<DeviceError>(
                [&] { make_cost(scene, terms, {.backend = Backend::cuda}, device); }),
            "pso_cuda searches on the GPU, and these terms are evaluated on the CPU: position. "
            "Leave them out, or write `type: pso`");
}

TEST_F(DeviceResiduals, WithACoveragePenaltyAreThoseOfTheCpu) {
  const Scene scene = test::hand_scene();
  stereo_color::Params params;
  params.falloff = stereo_color::Falloff::gaussian;
  params.coverage_penalty = 0.1;
  const std::vector<ObjectiveTerm> terms = {
      {1, colors(stereo_color::Direction::both, params), "stereo_color"}};
  const std::vector<ObjectiveTerm> again = {
      {1, colors(stereo_color::Direction::both, params), "stereo_color"}};
  test::expect_residuals_like_the_cpu(scene, frame_of(scene, 256), terms, again,
                                      test::scored_states(scene).leftCols(29));
}

TEST_F(DeviceResiduals, SquaredAddUpToTheCostAndAConstantOfTheFrame) {
  const Scene scene = test::hand_scene();
  const auto gpu = make_cost(scene, {{4, colors(stereo_color::Direction::both)}},
                             {.backend = Backend::cuda}, {.least_squares = true});
  gpu->prepare(frame_of(scene, 128));
  Eigen::MatrixXd states = test::scored_states(scene).leftCols(20);
  states(0, 0) = 30;  // beside the tiles
  const test::Residuals found = test::residuals_of(*gpu, states);
  EXPECT_EQ(found.costs[0], 0);
  const Eigen::VectorXd squares = found.values.cast<double>().colwise().squaredNorm();
  const Eigen::VectorXd constant = squares - found.costs;
  EXPECT_LT((constant.array() - squares[0]).abs().maxCoeff(), 1e-4 * squares[0]);
  EXPECT_LT(found.costs.minCoeff(), -1);
}

TEST_F(DeviceResiduals, AreTheSameWhateverTheBatch) {
  const Scene scene = test::hand_scene();
  // 2 MiB a hypothesis: they come down in two goes.
  const Observation frame = frame_of(scene, 512);
  const auto gpu =
      make_cost(scene, many_terms(scene), {.backend = Backend::cuda}, {.least_squares = true});
  gpu->prepare(frame);
  const Eigen::MatrixXd states = test::scored_states(scene).leftCols(40);
  const test::Residuals all = test::residuals_of(*gpu, states);
  for (const Eigen::Index i : {0, 17, 31, 32, 39}) {
    const test::Residuals one = test::residuals_of(*gpu, states.col(i));
    EXPECT_TRUE(one.values.isApprox(all.values.col(i), 1e-6f)) << i;
    EXPECT_NEAR(one.costs[0], all.costs[i], 1e-5 * std::abs(all.costs[i])) << i;
  }
  ASSERT_GT(gpu->least_squares()->count() * 40 * 4, Eigen::Index{1} << 26);
}

TEST_F(DeviceResiduals, SayWhichOfThemLookAtThePoseOnly) {
  const Scene scene = test::hand_scene();
  const Observation frame = frame_of(scene, 128);
  const auto rows = [&](Backend backend) {
    const auto cost =
        make_cost(scene, many_terms(scene), {.backend = backend}, {.least_squares = true});
    cost->prepare(frame);
    std::vector<Eigen::Index> out;
    for (const ResidualRows& r : cost->least_squares()->pose_only()) {
      out.insert(out.end(), {r.first, r.count});
    }
    return out;
  };
  EXPECT_EQ(rows(Backend::cuda).size(), 4u);
  EXPECT_EQ(rows(Backend::cuda), rows(Backend::cpu));
}

TEST_F(DeviceResiduals, AreThereWithoutBeingAnnounced) {
  const Scene scene = test::hand_scene();
  const auto has = [&](std::vector<ObjectiveTerm> terms) {
    const auto gpu = make_cost(scene, std::move(terms), {.backend = Backend::cuda});
    return gpu->least_squares() != nullptr;
  };
  EXPECT_TRUE(has(many_terms(scene)));
  EXPECT_FALSE(has({{1, colors(stereo_color::Direction::both)}, {1, test::covered_probe()}}));
  EXPECT_TRUE(has({{1, colors(stereo_color::Direction::both)}, {0, test::covered_probe()}}));
}

TEST_F(DeviceResiduals, OfATermThatHasThemOnTheCpuOnlyAreRefusedByItsName) {
  class CpuResiduals final : public Objective, public ResidualTerm {
   public:
   private:
    bool do_needs_rendering() const override { return probe_->needs_rendering(); }
    void do_prepare(const Observation&) override {}
    double do_cost(const RenderedHypothesis&) const override { return 0; }
    std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
      return probe_->on_device();
    }
    const ResidualTerm* do_residual_term() const override { return this; }
    std::int64_t do_residual_count() const override { return 0; }
    void do_write_residuals(const RenderedHypothesis&, std::span<float>) const override {}

    std::shared_ptr<Objective> probe_ = test::covered_probe();
  };
  const Scene scene = test::hand_scene();
  const std::vector<ObjectiveTerm> terms = {{1, colors(stereo_color::Direction::both)},
                                            {1, std::make_shared<CpuResiduals>(), "prior"}};
  EXPECT_EQ(test::message_of<DeviceError>([&] {
              make_cost(scene, terms, {.backend = Backend::cuda}, {.least_squares = true});
            }),
            "evaluate.backend: cuda: the optimizer needs residuals, and objective prior has them "
            "on the CPU only. Write `backend: cpu`, or `auto` to take what there is");
  const auto automatic = make_cost(scene, terms, {}, {.least_squares = true});
  EXPECT_THAT(automatic->backend(), testing::HasSubstr("objective prior has them on the CPU only"));
}

TEST_F(DeviceResiduals, AreTakenOnTheGpuByAutomatic) {
  const Scene scene = test::hand_scene();
  const auto backend = [&](std::vector<ObjectiveTerm> terms, Linearization linearization) {
    return make_cost(scene, std::move(terms), {},
                     {.least_squares = true, .jacobian = linearization})
        ->backend();
  };
  const std::vector<ObjectiveTerm> sloped = {{1, colors(stereo_color::Direction::both)}};
  const std::vector<ObjectiveTerm> plain = {
      {1, std::make_shared<rgbd_depth::RgbdDepth>(rgbd_depth::Params{})}};
  EXPECT_THAT(backend(sloped, Linearization::unused), testing::StartsWith("cuda"));
  EXPECT_THAT(backend(sloped, Linearization::welcome), testing::StartsWith("cuda"));
  EXPECT_THAT(backend(sloped, Linearization::needed), testing::StartsWith("cuda"));
  EXPECT_THAT(backend(plain, Linearization::welcome), testing::StartsWith("cuda"));
}

TEST_F(DeviceResiduals, ThatDoNotFitIntoMemoryAreRefusedAndFewerStillWork) {
  const Scene scene = test::hand_scene();
  const auto gpu = make_cost(scene, {{1, colors(stereo_color::Direction::both)}},
                             {.backend = Backend::cuda}, {.least_squares = true});
  gpu->prepare(frame_of(scene, 1024));  // 8 MiB a hypothesis
  const std::size_t free = cuda::free_memory().value();
  const auto many = static_cast<Eigen::Index>(free / (std::size_t{8} << 20)) + 1000;
  const Eigen::MatrixXd states = test::scored_states(scene);
  Eigen::VectorXd costs(many);
  EXPECT_THAT(test::message_of<DeviceError>([&] {
                gpu->least_squares()->differences()->evaluate(states.col(0).replicate(1, many),
                                                              costs);
              }),
              testing::AllOf(testing::HasSubstr("out of memory"),
                             testing::HasSubstr("hypotheses at a time")));
  gpu->least_squares()->differences()->evaluate(states.leftCols(3), costs.head(3));
  Eigen::VectorXd expected(3);
  gpu->evaluate(states.leftCols(3), expected);
  EXPECT_TRUE(costs.head(3).isApprox(expected, 1e-6));
}

}  // namespace
}  // namespace hypotrack
