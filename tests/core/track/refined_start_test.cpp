// An objective that refines the start of a search.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_models.hpp"
#include "track/search/frame_search.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;

/// Costs nothing anywhere, and starts 7 mm to the side of every start.
class Aside final : public Objective {
 public:
  Eigen::VectorXd answer;
  bool says_nothing = false;

 private:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override { return {.color = false, .mask = false, .depth = false}; }
  void do_prepare(const Observation& observation) override { start_ = observation.start; }
  double do_cost(const RenderedHypothesis&) const override { return 0; }
  Eigen::VectorXd do_refined_start() const override {
    if (answer.size() > 0 || says_nothing) return answer;
    Eigen::VectorXd out = start_;
    for (Eigen::Index i = 0; i < out.size(); i += 7) out[i] += 0.007;
    return out;
  }

  Eigen::VectorXd start_;
};

class Costless final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis&) const override { return 0; }
};

/// Answers with the start.
class StartKeeping final : public Optimizer {
 public:
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    Eigen::VectorXd costs(1);
    cost.evaluate(region.start, costs);
    return {region.start, costs[0], 1};
  }
};

/// A search for two boxes before one camera.
class RefinedStart : public testing::Test {
 protected:
  FrameSearch search() const {
    TrackerParts parts;
    parts.cameras = {{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}}};
    parts.cameras[0].camera_from_world = Eigen::Isometry3d::Identity();
    parts.optimizer = std::make_unique<StartKeeping>();
    parts.objective = {{1.0, std::make_shared<Costless>()}, {1.0, objective_}};
    parts.evaluate.threads = 1;
    return {scene_, parts};
  }
  Eigen::VectorXd start() const {
    Eigen::VectorXd state = scene_.rest_state();
    state[2] = state[9] = 0.5;
    return state;
  }
  static Eigen::VectorXd from(FrameSearch& search, const Eigen::VectorXd& prior) {
    return search.from(prior, {.evaluations = 1}, std::nullopt, 1).state;
  }

  std::shared_ptr<Aside> objective_ = std::make_shared<Aside>();
  const Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box())},
                      {"other", std::make_shared<Model>(test::make_test_box())}}};
  const Frame frame_ = [] {
    Frame frame;
    frame.views.resize(1);
    frame.views[0].color = cv::Mat3b(480, 640, cv::Vec3b(90, 90, 90));
    return frame;
  }();
};

TEST_F(RefinedStart, IsWhereTheFirstSearchOfAFrameBegins) {
  FrameSearch finder = search();
  finder.look(frame_, start(), false);
  EXPECT_NEAR(from(finder, start())[0], 0.007, 1e-12);
  EXPECT_EQ(from(finder, start())[0], 0);  // the second one begins where it is told to
  finder.look(frame_, start(), false);
  EXPECT_NEAR(from(finder, start())[7], 0.007, 1e-12);
}

TEST_F(RefinedStart, LeavesModelsThatDoNotMove) {
  FrameSearch finder = search();
  finder.show({true, true}, {false, true});
  finder.look(frame_, start(), false);
  const Eigen::VectorXd found = from(finder, start());
  EXPECT_EQ(found[0], 0);
  EXPECT_NEAR(found[7], 0.007, 1e-12);
  finder.show({true, false});
  finder.look(frame_, start(), false);
  EXPECT_EQ(from(finder, start())[7], 0);
}

TEST_F(RefinedStart, MayBeUnknown) {
  objective_->says_nothing = true;
  FrameSearch finder = search();
  finder.look(frame_, start(), false);
  EXPECT_EQ(from(finder, start())[0], 0);
}

TEST_F(RefinedStart, PassesTheCheckOfObjectives) {
  Observation observation;
  observation.start = start();
  Aside refining;
  refining.prepare(observation);
  EXPECT_NEAR(refining.refined_start()[0], 0.007, 1e-12);
  Costless plain;
  plain.prepare(observation);
  EXPECT_EQ(plain.refined_start().size(), 0);
}

TEST_F(RefinedStart, OfTheWrongSizeOrNotFiniteIsNamed) {
  for (const Eigen::VectorXd& wrong :
       {Eigen::VectorXd(Eigen::VectorXd::Zero(3)),
        Eigen::VectorXd(Eigen::VectorXd::Constant(14, std::numeric_limits<double>::quiet_NaN()))}) {
    Aside objective;
    objective.answer = wrong;
    objective.set_label("scene.yaml:3:3: aside");
    Observation observation;
    observation.start = start();
    objective.prepare(observation);
    EXPECT_THAT(
        test::message_of<PluginError>([&] { objective.refined_start(); }),
        testing::AllOf(HasSubstr("scene.yaml:3:3: aside"), HasSubstr("expected 14 finite")));
  }
}

}  // namespace
}  // namespace hypotrack
