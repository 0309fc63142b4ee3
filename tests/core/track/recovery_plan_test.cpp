#include "track/loop/recovery_plan.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "judges.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using Flags = std::vector<bool>;

/// Scores nothing, but would look at pictures.
class Drawn final : public Objective {
 public:
 private:
  bool do_needs_rendering() const override { return true; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis&) const override { return 0; }
};

/// Returns the start.
class Staying final : public Optimizer {
 public:
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction&, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    return {region.start, 0, 1};
  }
};

/// Plans for two boxes.
class RecoveryPlanTest : public testing::Test {
 protected:
  LoopState& make(bool is_given, RecoveryRun run = RecoveryRun::frame) {
    TrackerParts parts;
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts.cameras = {camera, camera};
    parts.cameras[1].camera_from_world.translation().x() = -0.06;
    parts.optimizer = std::make_unique<Staying>();
    parts.objective = {{1.0, std::make_shared<Drawn>()}};
    parts.begins_by_looking = !is_given;
    parts.judge = std::make_shared<test::SameForAll>(0);
    parts.status.recovery.run = run;
    loop_ = std::make_unique<LoopState>(scene_, parts, scene_.rest_state(), 1);
    return *loop_;
  }
  /// Makes a tracker that knows both models and has them where they were given.
  LoopState& make_known(RecoveryRun run = RecoveryRun::frame) {
    LoopState& loop = make(true, run);
    for (ModelTrack& track : loop.tracks) {
      track.judge({.cost = 0, .probability = 0.9, .visible = 1});
      track.learn();
    }
    return loop;
  }
  /// Returns a candidate by the probabilities of its models; negative: without the model.
  Candidate candidate(double first, double second) const {
    return {.found = {scene_.rest_state(), first < 0 && second < 0 ? kNever : 0, 0},
            .probabilities = {first, second},
            .shown = {first >= 0, second >= 0},
            .in_view = {true, true},
            .confirmed = {false, false},
            .reproduced = {false, false},
            .unseen = {kNever, kNever}};
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  std::shared_ptr<Model> box_ = std::make_shared<Model>(test::make_test_box());
  Scene scene_{{{"one", box_}, {"other", box_}}};
  std::unique_ptr<LoopState> loop_;
  RecoveryPlan plan_;
  Frame frame_;
};

TEST_F(RecoveryPlanTest, SeeksNoModelThatIsExpectedAtTheStart) {
  const RecoveryRequest request = plan_.next(make(true), frame_, candidate(-1, 0.2));
  EXPECT_FALSE(request.lost || any(request.sought));
}

TEST_F(RecoveryPlanTest, SeeksModelsThatWereNeverSeenAnywhere) {
  const RecoveryRequest request = plan_.next(make(false), frame_, candidate(-1, -1));
  EXPECT_TRUE(request.lost);
  EXPECT_EQ(request.sought, (Flags{true, true}));
  EXPECT_EQ(request.thorough, (Flags{true, true}));
  EXPECT_EQ(request.seconds, (std::vector<double>{kNever, kNever}));
  EXPECT_EQ(request.together.size(), 0);
  EXPECT_EQ(plan_.next(*loop_, frame_, candidate(-1, -1)).thorough, (Flags{false, false}));
}

TEST_F(RecoveryPlanTest, LooksEverMoreSeldomElsewhereForAModelInADoubtfulFirstPose) {
  LoopState& loop = make(false);
  std::vector<int> times;
  for (int i = 1; i <= 9; ++i)
    if (plan_.next(loop, frame_, candidate(0.99, 0.3)).lost) times.push_back(i);
  EXPECT_EQ(times, (std::vector<int>{1, 2, 4, 8}));
  plan_.restart();
  EXPECT_TRUE(plan_.next(loop, frame_, candidate(0.99, 0.3)).lost);
}

TEST_F(RecoveryPlanTest, SeeksALostModelInEveryFrame) {
  LoopState& loop = make_known();
  for (int i = 0; i < 5; ++i) {
    const RecoveryRequest request = plan_.next(loop, frame_, candidate(0.99, 0.1));
    EXPECT_EQ(request.sought, (Flags{false, true}));
    EXPECT_TRUE(request.lost);
    EXPECT_FALSE(request.near_only);
  }
}

TEST_F(RecoveryPlanTest, SeeksAModelWithAPoorPoseAtFirstThenEveryFourthFrame) {
  LoopState& loop = make_known();
  std::vector<int> times;
  for (int i = 1; i <= 13; ++i) {
    const RecoveryRequest request = plan_.next(loop, frame_, candidate(0.99, 0.3));
    if (!any(request.sought)) continue;
    EXPECT_EQ(request.sought, (Flags{false, true}));
    EXPECT_TRUE(request.lost);
    times.push_back(i);
  }
  EXPECT_EQ(times, (std::vector<int>{1, 2, 3, 4, 8, 12}));
}

TEST_F(RecoveryPlanTest, SeeksAllPoorModelsInTheBackgroundWhileOneIsLost) {
  LoopState& loop = make_known(RecoveryRun::background);
  for (int i = 0; i < 5; ++i) plan_.next(loop, frame_, candidate(0.99, 0.3));
  const Candidate best = candidate(0.1, 0.3);
  const RecoveryRequest request = plan_.next(loop, frame_, best);
  EXPECT_EQ(request.sought, (Flags{true, true}));
  EXPECT_TRUE(RecoveryPlan::is_for_background(loop, request, best));
}

TEST_F(RecoveryPlanTest, SeeksAModelAnewWhosePoseWasGoodForAMoment) {
  LoopState& loop = make_known();
  for (int i = 0; i < 9; ++i) plan_.next(loop, frame_, candidate(0.99, 0.3));
  for (int i = 0; i < 4; ++i) plan_.next(loop, frame_, candidate(0.99, 0.99));
  EXPECT_TRUE(any(plan_.next(loop, frame_, candidate(0.99, 0.3)).sought));
}

TEST_F(RecoveryPlanTest, ComparesADoubtfulPoseWithOthersEverMoreSeldom) {
  LoopState& loop = make_known();
  std::vector<int> times;
  for (int i = 1; i <= 9; ++i) {
    const RecoveryRequest request = plan_.next(loop, frame_, candidate(0.7, 0.99));
    EXPECT_TRUE(request.near_only && !request.lost);
    EXPECT_LT(request.effort.hypotheses, loop.settings.recovery.hypotheses);
    if (!any(request.sought)) continue;
    EXPECT_EQ(request.sought, (Flags{true, false}));
    times.push_back(i);
  }
  EXPECT_EQ(times, (std::vector<int>{1, 2, 4, 8}));
}

TEST_F(RecoveryPlanTest, ComparesAnyPoseWithOthersJustAfterALoss) {
  LoopState& loop = make_known();
  loop.tracks[1].take(false, scene_.rest_state(), {}, 0);
  EXPECT_EQ(plan_.next(loop, frame_, candidate(0.99, 0.99)).sought, (Flags{false, true}));
  for (int i = 0; i < 4; ++i) loop.tracks[1].take(true, scene_.rest_state(), {}, 0);
  EXPECT_FALSE(any(plan_.next(loop, frame_, candidate(0.99, 0.99)).sought));
}

TEST_F(RecoveryPlanTest, SearchesInTheBackgroundWhileNoModelIsFollowed) {
  LoopState& loop = make_known(RecoveryRun::background);
  const auto in_background = [&](const Candidate& best) {
    return RecoveryPlan::is_for_background(loop, plan_.next(loop, frame_, best), best);
  };
  EXPECT_TRUE(in_background(candidate(-1, -1)));
  EXPECT_TRUE(in_background(candidate(0.1, -1)));
  EXPECT_FALSE(in_background(candidate(0.99, -1)));
  EXPECT_FALSE(any(plan_.next(loop, frame_, candidate(0.7, 0.7)).sought)) << "only for lost ones";
  make_known();
  const Candidate none = candidate(-1, -1);
  EXPECT_FALSE(RecoveryPlan::is_for_background(*loop_, plan_.next(*loop_, frame_, none), none));
}

}  // namespace
}  // namespace hypotrack
