#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "painted_box.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
namespace {

/// Distance of the model from its place, as if pictures had told that.
class AtItsPlace final : public Objective {
 public:
  explicit AtItsPlace(Eigen::VectorXd state) : state_(std::move(state)) {}

 private:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override { return {.mask = false, .depth = false}; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& h) const override {
    return std::hypot(h.state[0] - state_[0], h.state[1] - state_[1], h.state[2] - state_[2]);
  }

  Eigen::VectorXd state_;
};

/// Stays at the start.
class Stays final : public Optimizer {
 public:
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    Eigen::VectorXd costs(1);
    cost.evaluate(region.start, costs);
    return {region.start, costs[0], 1};
  }
};

/// Trusts all poses, more or less by what was learned: looks, colours and what is usual.
class ByWhatWasLearned final : public Judge {
 protected:
  double do_log_odds(const Measures& measures) const override {
    const double likeness = std::isnan(measures.likeness) ? 0 : measures.likeness;
    return 4 + measures[Measures::kInside] - 0.1 * measures[Measures::kDifference] + likeness +
           measures.usual[Measures::kTexture];
  }
};

class LearningTest : public testing::Test {
 protected:
  std::unique_ptr<SceneTracker> tracker(int threads) const {
    TrackerParts parts;
    parts.cameras = box_.cameras;
    parts.optimizer = std::make_unique<Stays>();
    parts.objective = {{1.0, std::make_shared<AtItsPlace>(box_.state())}};
    parts.judge = std::make_shared<ByWhatWasLearned>();
    parts.evaluate.threads = threads;
    parts.status.check_pictures = false;  // they stand still
    parts.status.recovery.first_restarts = 1;
    return std::make_unique<SceneTracker>(box_.scene, std::move(parts), box_.state(), 1);
  }
  /// Returns a frame in which the second camera's gain has changed a little.
  Frame frame(int index) const {
    Frame out = box_.frame(1 + 0.01 * (index % 5), index % 3);
    out.index = index;
    out.time = index / 30.0;
    return out;
  }

  test::PaintedBox box_;
};

TEST_F(LearningTest, IsTheSameWithAnyNumberOfThreadsWhateverBecomesOfPictures) {
  constexpr int kFrames = 24;
  const auto solutions = [&](int threads) {
    const auto tracker = this->tracker(threads);
    std::vector<Solution> out;
    for (int i = 0; i < kFrames; ++i) {
      Frame frame = this->frame(i);
      out.push_back(tracker->track(frame));
      for (View& view : frame.views) view.color.setTo(cv::Scalar(0, 255, 90));
    }
    return out;
  };
  const std::vector<Solution> one = solutions(1), several = solutions(4);
  for (int i = 0; i < kFrames; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(one[at].status, Status::tracked) << i;
    EXPECT_EQ(one[at].state, several[at].state) << i;
    EXPECT_EQ(one[at].probabilities, several[at].probabilities) << i;
  }
  EXPECT_NE(one.front().probabilities, one.back().probabilities);
}

TEST_F(LearningTest, EndsWithTheTrackerOrASearchAnew) {
  constexpr int kTimes = 4;
  for (int i = 0; i < kTimes; ++i) {
    const auto tracker = this->tracker(3);
    tracker->track(frame(0));
    tracker->track(frame(1));
    if (i % 2 == 0) continue;
    tracker->search_anew();
    EXPECT_NE(tracker->track(frame(2)).status, Status::missing);
  }
}

}  // namespace
}  // namespace hypotrack
