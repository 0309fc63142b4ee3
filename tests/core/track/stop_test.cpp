#include "hypotrack/api/stop.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "base/stop_scope.hpp"
#include "hypotrack/plugin/start_points.hpp"
#include "judges.hpp"
#include "test_models.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
namespace {

/// Distance of the model from a point.
class Distance final : public Objective {
 public:
  explicit Distance(bool draws) : draws_(draws) {}
  mutable std::atomic<int> costs = 0;

 private:
  bool do_needs_rendering() const override { return draws_; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    ++costs;
    return std::hypot(h.state[0] - 0.01, h.state[1], h.state[2] - 0.5);
  }

  bool draws_;
};

/// Evaluates one batch around the start.
class OneBatch final : public Optimizer {
 public:
  std::int64_t default_evaluations() const override { return points; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    Eigen::MatrixXd batch = region.start.replicate(1, points);
    batch.row(0) += Eigen::RowVectorXd::LinSpaced(points, 0, 0.01);
    Eigen::VectorXd costs(points);
    try {
      cost.evaluate(batch, costs);
    } catch (...) {
      if (!catches_all) throw;
      return {region.start, 0, 0};
    }
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    return {batch.col(best), lowest, points};
  }
  Eigen::Index points = 100;
  bool catches_all = false;
};

/// Looks for the model until it is told to end.
class EndlessStarter final : public Starter {
 public:
  explicit EndlessStarter(std::atomic<int>& begun) : begun_(begun) {}

 private:
  bool do_looks() const override { return true; }
  void do_find(const StarterContext&, std::size_t, const TakePose&) override {
    ++begun_;
    while (true) check_stop();
  }

  std::atomic<int>& begun_;
};

struct Stoppable {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  std::shared_ptr<Distance> distance = std::make_shared<Distance>(false);
  std::atomic<int> begun = 0;  ///< searches of EndlessStarter
  OneBatch* optimizer = nullptr;

  TrackerParts parts() {
    TrackerParts parts;
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts.cameras = {camera, camera};
    parts.cameras[1].camera_from_world.translation().x() = -0.06;
    auto one_batch = std::make_unique<OneBatch>();
    optimizer = one_batch.get();
    parts.optimizer = std::move(one_batch);
    parts.objective = {{1.0, distance}};
    return parts;
  }
  std::unique_ptr<SceneTracker> make(TrackerParts parts) const {
    Eigen::VectorXd start = scene.rest_state();
    start[2] = 0.5;
    return std::make_unique<SceneTracker>(scene, std::move(parts), start, 1);
  }
  /// Makes a tracker that looks for its model in the background, without an end.
  std::unique_ptr<SceneTracker> make_endless() {
    distance = std::make_shared<Distance>(true);
    TrackerParts endless = parts();
    endless.judge = std::make_shared<test::SameForAll>(0);
    endless.status.recovery.run = RecoveryRun::background;
    endless.begins_by_looking = true;
    endless.starters.push_back(std::make_unique<EndlessStarter>(begun));
    return make(std::move(endless));
  }
};

Frame frame_with_views(int index) {
  Frame frame;
  frame.index = index;
  frame.time = index / 30.0;
  frame.views.resize(2);
  for (View& view : frame.views) {
    view.color.create(480, 640, CV_8UC3);
    cv::randu(view.color, 0, 255);
  }
  return frame;
}

TEST(Stop, IsNotWantedOutsideAScope) {
  check_stop();
  const StopTest always = [] { return true; };
  {
    const StopScope scope(always);
    EXPECT_THROW(check_stop(), Stopped);
    const StopScope none(StopTest{});
    EXPECT_THROW(check_stop(), Stopped) << "an empty test leaves the one before";
    EXPECT_NO_THROW(std::thread([] { check_stop(); }).join()) << "is of one thread";
  }
  check_stop();
}

TEST(Stop, EndsTheMakingOfManyPoints) {
  SearchRegion region;
  region.start = Eigen::VectorXd::Zero(2);
  region.upper = region.spread = Eigen::VectorXd::Ones(2);
  region.lower = -region.upper;
  const StartPoints points(region, {}, 1);
  std::atomic<int> asked = 0;
  const StopTest soon = [&] { return ++asked > 2; };
  const StopScope scope(soon);
  EXPECT_THROW(points.points(0, 1 << 20), Stopped);
}

TEST(Stop, EndsAFrameWithinItsBatchAndTheNextFrameIsTracked) {
  Stoppable stoppable;
  const auto tracker = stoppable.make(stoppable.parts());
  const std::atomic<int>& costs = stoppable.distance->costs;
  const StopTest after_ten = [&] { return costs >= 10; };
  {
    const StopScope scope(after_ten);
    EXPECT_THROW(tracker->track(frame_with_views(0)), Stopped);
  }
  EXPECT_LT(costs, 100);
  const Solution next = tracker->track(frame_with_views(1));
  EXPECT_EQ(next.status, Status::tracked);
  EXPECT_NEAR(next.state[0], 0.01, 1e-3);
}

TEST(Stop, EndsAFrameWhoseOptimizerCatchesEverything) {
  Stoppable stoppable;
  const auto tracker = stoppable.make(stoppable.parts());
  stoppable.optimizer->catches_all = true;
  const StopTest after_ten = [&] { return stoppable.distance->costs >= 10; };
  const StopScope scope(after_ten);
  EXPECT_THROW(tracker->track(frame_with_views(0)), Stopped);
}

TEST(Stop, LeavesNoRecordOfAFrameThatItEnded) {
  Stoppable stoppable;
  const auto tracker = stoppable.make(stoppable.parts());
  const StopTest after_ten = [&] { return stoppable.distance->costs >= 10; };
  {
    const StopScope scope(after_ten);
    auto record = std::make_unique<SearchRecord>();
    EXPECT_THROW(tracker->track(frame_with_views(0), record.get()), Stopped);
  }
  EXPECT_EQ(tracker->track(frame_with_views(1)).status, Status::tracked)
      << "does not write to a record that is gone";
}

TEST(Stop, LargeBatchesHaveTheCostsOfSmallOnes) {
  Stoppable stoppable;
  TrackerParts parts = stoppable.parts();
  stoppable.optimizer->points = 40001;
  const Solution solution = stoppable.make(std::move(parts))->track(frame_with_views(0));
  EXPECT_NEAR(solution.cost, 0, 1e-9) << "the last point of the batch";
  EXPECT_EQ(solution.evaluations, 40001);
}

TEST(Stop, ATrackerThatGoesAwayEndsItsSearchInTheBackground) {
  Stoppable stoppable;
  auto tracker = stoppable.make_endless();
  EXPECT_EQ(tracker->track(frame_with_views(0)).status, Status::lost);
  while (stoppable.begun == 0) std::this_thread::yield();
  tracker.reset();
}

TEST(Stop, ASearchAnewEndsTheOneInTheBackground) {
  Stoppable stoppable;
  const auto tracker = stoppable.make_endless();
  tracker->track(frame_with_views(0));
  while (stoppable.begun == 0) std::this_thread::yield();
  tracker->search_anew();
  tracker->track(frame_with_views(1));
  while (stoppable.begun == 1) std::this_thread::yield();
}

}  // namespace
}  // namespace hypotrack
