#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_models.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Distance of the model from a point; fails in some frames as a device does.
class OnFailingDevice final : public Objective {
 public:
  int fails_in = 2;
  mutable int failures = 1;

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation& observation) override { frame_ = observation.frame; }
  double do_cost(const RenderedHypothesis& h) const override {
    if (frame_ == fails_in && failures > 0) {
      --failures;
      throw DeviceError("the device is lost");
    }
    return std::hypot(h.state[0] - 0.001 * frame_, h.state[1], h.state[2] - 0.5);
  }

  int frame_ = 0;
};

/// Takes the best of a line of points.
class OfALine final : public Optimizer {
 public:
  explicit OfALine(bool needs_device) : needs_device_(needs_device) {}
  Requirements requirements() const override {
    return {.device = needs_device_,
            .device_by = "scene.yaml:9:3: of_a_line",
            .instead_of_device = "`type: pso`"};
  }
  std::int64_t default_evaluations() const override { return 11; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    Eigen::MatrixXd points = region.start.replicate(1, 11);
    points.row(0) += Eigen::RowVectorXd::LinSpaced(11, 0, 0.01);
    Eigen::VectorXd costs(11);
    cost.evaluate(points, costs);
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    return {points.col(best), lowest, 11};
  }

 private:
  bool needs_device_;
};

struct Lossy {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  std::shared_ptr<OnFailingDevice> objective = std::make_shared<OnFailingDevice>();
  EvaluateSettings evaluate;
  bool needs_device = false;

  std::unique_ptr<SceneTracker> make() const {
    TrackerParts parts;
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts.cameras = {camera};
    parts.optimizer = std::make_unique<OfALine>(needs_device);
    parts.objective = {{1.0, objective}};
    parts.evaluate = evaluate;
    parts.evaluate.threads = 1;
    Eigen::VectorXd start = scene.rest_state();
    start[2] = 0.5;
    return std::make_unique<SceneTracker>(scene, std::move(parts), start, 1);
  }
};

Frame grey_picture(int index) {
  Frame frame;
  frame.index = index;
  frame.time = index / 30.0;
  frame.views.resize(1);
  frame.views[0].color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
  return frame;
}

TEST(DeviceLoss, StopsUnlessItIsToldOtherwise) {
  const Lossy lossy;
  const auto tracker = lossy.make();
  for (int i = 0; i < 2; ++i) tracker->track(grey_picture(i));
  EXPECT_THAT(test::message_of<DeviceError>([&] { tracker->track(grey_picture(2)); }),
              AllOf(HasSubstr("frame 2"), HasSubstr("the device is lost")));
  EXPECT_EQ(tracker->device_error(), "");
}

TEST(DeviceLoss, SearchesTheFrameAgainOnTheCpuAndGoesOn) {
  Lossy lossy, whole;
  lossy.evaluate.on_device_loss = OnDeviceLoss::cpu;
  whole.objective->failures = 0;
  const auto tracker = lossy.make(), other = whole.make();
  for (int i = 0; i < 5; ++i) {
    const Solution solution = tracker->track(grey_picture(i)),
                   expected = other->track(grey_picture(i));
    EXPECT_EQ(solution.state, expected.state) << "frame " << i;
    EXPECT_EQ(solution.evaluations, expected.evaluations) << "frame " << i;
    EXPECT_EQ(tracker->device_error().empty(), i < 2) << "frame " << i;
  }
  EXPECT_THAT(tracker->device_error(), HasSubstr("the device is lost"));
  EXPECT_THAT(tracker->backend(), HasSubstr("cpu ("));
}

TEST(DeviceLoss, ASecondFailureEndsTheRun) {
  Lossy lossy;
  lossy.evaluate.on_device_loss = OnDeviceLoss::cpu;
  lossy.objective->failures = 2;
  const auto tracker = lossy.make();
  for (int i = 0; i < 2; ++i) tracker->track(grey_picture(i));
  EXPECT_THROW(tracker->track(grey_picture(2)), DeviceError);
}

TEST(DeviceLoss, IsNoLossWhereTheCpuWasAskedFor) {
  Lossy lossy;
  lossy.evaluate.on_device_loss = OnDeviceLoss::cpu;
  lossy.evaluate.backend = Backend::cpu;
  const auto tracker = lossy.make();
  for (int i = 0; i < 2; ++i) tracker->track(grey_picture(i));
  EXPECT_THROW(tracker->track(grey_picture(2)), DeviceError);
}

TEST(DeviceLoss, CannotGoOnWithASearchThatNeedsTheDevice) {
  Lossy lossy;
  lossy.evaluate.on_device_loss = OnDeviceLoss::cpu;
  lossy.needs_device = true;
  EXPECT_THAT(test::message_of<ConfigError>([&] { lossy.make(); }),
              AllOf(HasSubstr("scene.yaml:9:3: of_a_line searches on the GPU only"),
                    HasSubstr("write `stop`, or `type: pso`")));
}

}  // namespace
}  // namespace hypotrack
