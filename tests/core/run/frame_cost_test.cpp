#include "hypotrack/api/frame_cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kTwoTerms = R"(models: [{name: box, type: rigid_box, size_mm: [60, 90, 40]}]
source:
  type: synthetic
  frames: 2
  cameras: {width: 320, height: 240, focal_px: 300, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 500], rotation_deg: [10, 20, 0]}}}
    - {frame: 1, pose: {box: {position_mm: [10, 5, 510], rotation_deg: [10, 25, 0]}}}
objective: [{type: stereo_color, weight: 0.5}, {type: stereo_patch, weight: 2}]
optimizer: {type: pso, particles: 16, generations: 8}
tile: {size: 64}
)";

class FrameCostTest : public ::testing::Test {
 protected:
  FrameCostTest() {
    PluginLoader plugins;
    const OpenedScene opened = open_source(ConfigNode::parse(kTwoTerms, "scene"), {}, plugins);
    cameras_ = opened.source->cameras();
    while (auto frame = opened.source->next()) frames_.push_back(*std::move(frame));
  }
  FrameCost cost(std::vector<std::string> set = {}) {
    return Session(ConfigNode::parse(kTwoTerms, "scene"), {.set = std::move(set)})
        .frame_cost(cameras_);
  }
  const Eigen::VectorXd& truth(std::size_t i) const { return frames_[i].truth->state; }
  /// The true state of the first frame and states beside it.
  Eigen::MatrixXd states() const {
    Eigen::MatrixXd states = truth(0).replicate(1, 4);
    states(0, 1) += 0.01;
    states(2, 2) -= 0.03;
    states(4, 3) += 0.2;
    return states;
  }

  std::vector<Camera> cameras_;
  std::vector<Frame> frames_;
};

TEST_F(FrameCostTest, IsLeastAtTheTruth) {
  FrameCost cost = this->cost();
  cost.look(frames_[0], truth(0));
  const Eigen::VectorXd costs = cost.costs(states());
  Eigen::Index best = -1;
  costs.minCoeff(&best);
  EXPECT_EQ(best, 0) << costs.transpose();
}

TEST_F(FrameCostTest, IsTheWeightedSumOfItsTerms) {
  FrameCost cost = this->cost();
  cost.look(frames_[0], truth(0));
  const Eigen::VectorXd before = cost.costs(states());
  const Eigen::MatrixXd terms = cost.terms(states());
  EXPECT_THAT(cost.term_names(), ElementsAre("stereo_color", "stereo_patch"));
  EXPECT_THAT(cost.weights(), ElementsAre(0.5, 2));
  const Eigen::VectorXd sum = 0.5 * terms.row(0) + 2 * terms.row(1);
  EXPECT_LT((sum - before).norm(), 1e-6 * before.norm());
  EXPECT_EQ(cost.costs(states()), before) << "terms() changes nothing";
}

TEST_F(FrameCostTest, OfAFrameDoesNotDependOnTheOnesBefore) {
  FrameCost cost = this->cost(), other = this->cost();
  cost.look(frames_[1], truth(1));
  cost.terms(truth(1));
  cost.look(frames_[0], truth(0));
  other.look(frames_[0], truth(0));
  EXPECT_EQ(cost.costs(states()), other.costs(states()));
  EXPECT_EQ(cost.terms(states()), other.terms(states()));
}

TEST_F(FrameCostTest, LinearisesItsResiduals) {
  FrameCost cost = this->cost({"objective={type: stereo_color}", "search.rotation_as=tangent"});
  cost.look(frames_[0], truth(0));
  ASSERT_TRUE(cost.least_squares());
  const Eigen::MatrixXf residuals = cost.residuals(states());
  ASSERT_TRUE(residuals.allFinite());
  EXPECT_GT(residuals.col(1).squaredNorm(), residuals.col(0).squaredNorm());
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(7);
  steps.head<3>().setConstant(0.002);
  const Eigen::VectorXd beside = states().col(1);
  const Eigen::MatrixXf jacobian = cost.jacobian(beside, steps);
  ASSERT_EQ(jacobian.rows(), residuals.rows());
  EXPECT_EQ(jacobian.rightCols<4>().norm(), 0) << "their steps are 0";
  Eigen::MatrixXd ends = beside.replicate(1, 2);
  ends(0, 0) += 0.002;
  ends(0, 1) -= 0.002;
  const Eigen::MatrixXf of_ends = cost.residuals(ends);
  EXPECT_LT((jacobian.col(0) - (of_ends.col(0) - of_ends.col(1)) / 0.004f).norm(),
            1e-4f * jacobian.col(0).norm());
  ASSERT_TRUE(cost.can_linearize());
  const NormalEquations equations = cost.linearize(beside, steps);
  EXPECT_GT(equations.g[0], 0) << "the cost falls towards the truth";
  EXPECT_GT((jacobian.transpose() * residuals.col(1))[0], 0) << "so do differences say";
}

TEST_F(FrameCostTest, RefusesWhatDoesNotFit) {
  FrameCost cost = this->cost();
  EXPECT_THAT(message_of<Error>([&] { cost.costs(truth(0)); }), HasSubstr("no frame is prepared"));
  EXPECT_THAT(message_of<DataError>([&] { cost.look({}, truth(0)); }), HasSubstr("no views"));
  Frame small = frames_[0];
  small.views[1].color = small.views[1].color(cv::Rect(0, 0, 100, 100)).clone();
  EXPECT_THAT(message_of<DataError>([&] { cost.look(small, truth(0)); }), HasSubstr("100"));
  EXPECT_THAT(message_of<ConfigError>([&] { cost.look(frames_[0], Eigen::VectorXd::Zero(3)); }),
              HasSubstr("the state to look around"));
  cost.look(frames_[0], truth(0));
  EXPECT_THAT(message_of<DataError>([&] { cost.look(small, truth(0)); }), HasSubstr("100"));
  EXPECT_THAT(message_of<Error>([&] { cost.costs(truth(0)); }), HasSubstr("no frame is prepared"))
      << "a frame that was refused is none";
  cost.look(frames_[0], truth(0));
  EXPECT_THAT(message_of<Error>([&] { cost.costs(Eigen::MatrixXd::Zero(6, 2)); }),
              HasSubstr("found 6 x 2"));
  Eigen::VectorXd bad = truth(0);
  bad[1] = NAN;
  EXPECT_THAT(message_of<Error>([&] { cost.costs(bad); }), HasSubstr("not finite"));
  EXPECT_THAT(message_of<Error>([&] { cost.costs(Eigen::MatrixXd(7, 0)); }), HasSubstr("7 x 0"));
  std::vector<Camera> wrong = cameras_;
  wrong[0].width = 0;
  Session session(ConfigNode::parse(kTwoTerms, "scene"));
  EXPECT_THAT(message_of<DataError>([&] { session.frame_cost(wrong); }), HasSubstr("camera 0"));
}

}  // namespace
}  // namespace hypotrack
