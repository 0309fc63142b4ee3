#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Le;

constexpr const char* kDrawnBox = R"(models: [{name: box, type: rigid_box, size_mm: [60, 90, 40]}]
source:
  type: synthetic
  frames: 1
  cameras: {width: 320, height: 240, focal_px: 300, baseline_mm: 100}
  keyframes: [{frame: 0, pose: {box: {position_mm: [0, 0, 500]}}}]
objective: [{type: stereo_color}, {type: area, weight: 2}]
optimizer: {type: pso, particles: 16, generations: 8}
tile: {size: 64}
)";

/// Sums up the inverse depths of all views, one hypothesis at a time.
class Area : public Objective {
 public:
 protected:
  void do_prepare(const Observation& /*observation*/) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    double sum = hypothesis.state[0];
    for (const DepthTile& tile : hypothesis.views)
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) sum += tile.inverse_depth[y * tile.stride + x];
    return sum;
  }
};

/// The same for several at once; remembers how many. `spoil` changes the costs of a call.
class BatchArea final : public Area {
 public:
  using Spoil = void (*)(std::span<double>);
  BatchArea(std::vector<std::size_t>& sizes, Spoil spoil) : sizes_(sizes), spoil_(spoil) {}

 private:
  int do_most_at_once() const override { return 8; }
  void do_costs(std::span<const RenderedHypothesis> all, std::span<double> costs) const override {
    sizes_.push_back(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) costs[i] = do_cost(all[i]);
    if (spoil_) spoil_(costs);
  }

  std::vector<std::size_t>& sizes_;
  Spoil spoil_;
};

class BatchObjectiveTest : public ::testing::Test {
 protected:
  BatchObjectiveTest() {
    PluginLoader plugins;
    const OpenedScene opened = open_source(ConfigNode::parse(kDrawnBox, "scene"), {}, plugins);
    cameras_ = opened.source->cameras();
    frame_ = *opened.source->next();
    states_ = frame_.truth->state.replicate(1, 19);
    for (Eigen::Index k = 0; k < states_.cols(); ++k)
      states_(2, k) += 0.002 * static_cast<double>(k);
  }
  FrameCost cost(bool batched, BatchArea::Spoil spoil = nullptr) {
    SessionOptions options;
    options.plugins = {program_plugin<Objective>(
        "area", [this, batched, spoil](PluginContext&) -> std::unique_ptr<Objective> {
          if (!batched) return std::make_unique<Area>();
          return std::make_unique<BatchArea>(sizes_, spoil);
        })};
    Session session(ConfigNode::parse(kDrawnBox, "scene"), options);
    FrameCost cost = session.frame_cost(cameras_);
    cost.look(frame_, frame_.truth->state);
    return cost;
  }

  std::vector<Camera> cameras_;
  Frame frame_;
  Eigen::MatrixXd states_;
  std::vector<std::size_t> sizes_;
};

TEST_F(BatchObjectiveTest, HasTheCostsOfOneAtATime) {
  FrameCost one = cost(false), batch = cost(true);
  EXPECT_EQ(batch.costs(states_), one.costs(states_));
  EXPECT_EQ(batch.terms(states_), one.terms(states_));
  EXPECT_EQ(batch.costs(states_.col(3)), one.costs(states_.col(3)));
  EXPECT_THAT(sizes_, Each(Le(8U)));
  EXPECT_EQ(sizes_.front(), 8U);
  EXPECT_EQ(*std::min_element(sizes_.begin(), sizes_.end()), 1U);
}

TEST_F(BatchObjectiveTest, IsHeldToTheContractOfCosts) {
  FrameCost nan = cost(true, [](std::span<double> costs) { costs.back() = NAN; });
  EXPECT_THAT(message_of<Error>([&] { nan.costs(states_); }),
              AllOf(HasSubstr("area"), HasSubstr("is nan")));
  FrameCost minus = cost(
      true, [](std::span<double> costs) { costs[0] = -std::numeric_limits<double>::infinity(); });
  EXPECT_THAT(message_of<PluginError>([&] { minus.costs(states_); }), HasSubstr("-inf"));
  FrameCost infeasible = cost(
      true, [](std::span<double> costs) { costs[0] = std::numeric_limits<double>::infinity(); });
  EXPECT_TRUE(std::isinf(infeasible.costs(states_)[8]));
}

}  // namespace
}  // namespace hypotrack
