#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "cost/cost.hpp"
#include "hypotrack/api/renderer.hpp"
#include "rgbd_depth.hpp"
#include "test_models.hpp"

namespace hypotrack::rgbd_depth {
namespace {

constexpr int kSize = 128;

/// A hand before a wall as a depth camera sees it, drawn with OpenGL.
struct RenderedDepth {
  RenderedDepth()
      : scene({{"hand", std::make_shared<const Model>(test::make_test_hand())}}),
        truth(scene.rest_state()) {
    truth.head<7>() << -0.005, 0.085, 0.5, 0, 1, 0, 0;  // the palm to the camera, fingers up
    for (Eigen::Index i = 7; i < truth.size(); ++i) {
      const Parameter& p = scene.parameters()[static_cast<std::size_t>(i)];
      truth[i] = p.rest + 0.3 * (p.upper - p.rest);
    }
    Camera camera;
    camera.width = camera.height = kSize;
    camera.fx = camera.fy = 320;
    camera.cx = camera.cy = kSize / 2.0;
    const RenderedView drawn = Renderer(scene).render(truth, camera, {});
    TileView view;
    view.camera = {kSize, kSize, camera.fx, camera.fy, camera.cx, camera.cy, {}};
    view.camera.camera_from_world.setIdentity();
    view.valid = cv::Mat1b(kSize, kSize, uchar{255});
    view.mask = drawn.label > 0;
    view.depth = drawn.depth.clone();
    view.depth.setTo(0.9, view.mask == 0);
    observation.scene = &scene;
    observation.start = truth;
    observation.views.push_back(view);
  }

  Eigen::VectorXd costs(const Params& params, const Eigen::MatrixXd& states) const {
    const auto cost = make_cost(scene, {{1.0, std::make_shared<RgbdDepth>(params)}},
                                {.backend = Backend::cpu, .threads = 1});
    cost->prepare(observation);
    Eigen::VectorXd out(states.cols());
    cost->evaluate(states, out);
    return out;
  }

  Scene scene;
  Eigen::VectorXd truth;
  Observation observation;
};

/// One position, one rotation axis (about the wrist) or one joint angle; mm or degrees.
Eigen::VectorXd moved(Eigen::VectorXd state, int freedom, double by) {
  if (freedom < 3) {
    state[freedom] += by * kMillimetre;
  } else if (freedom < 6) {
    const Eigen::Quaterniond q(state[3], state[4], state[5], state[6]);
    const Eigen::Quaterniond r =
        Eigen::AngleAxisd(by * kDegree, Eigen::Vector3d::Unit(freedom - 3)) * q;
    state.segment<4>(3) << r.w(), r.x(), r.y(), r.z();
  } else {
    state[freedom + 1] += by * kDegree;
  }
  return state;
}

constexpr double kOffsets[] = {-16, -8, -4, -2, -1, 0, 1, 2, 4, 8, 16};
constexpr Eigen::Index kTruth = 5, kCount = 11;

void expect_best_at_truth(const RenderedDepth& rendered, const Params& params) {
  for (int f = 0; f < 26; ++f) {
    SCOPED_TRACE(f < 6 ? "pose " + std::to_string(f)
                       : rendered.scene.parameters()[static_cast<std::size_t>(f + 1)].name);
    Eigen::MatrixXd states(rendered.truth.size(), kCount);
    for (Eigen::Index i = 0; i < kCount; ++i) {
      states.col(i) = moved(rendered.truth, f, kOffsets[i]);
    }
    const Eigen::VectorXd costs = rendered.costs(params, states);
    EXPECT_LT(costs[kTruth], 0.05) << "two ways of drawing differ by a few pixels only";
    for (Eigen::Index i = 1; i <= kTruth; ++i) {
      EXPECT_LT(costs[kTruth], costs[kTruth - i]) << "off by " << kOffsets[kTruth - i];
      EXPECT_LT(costs[kTruth], costs[kTruth + i]) << "off by " << kOffsets[kTruth + i];
      EXPECT_LT(costs[kTruth - i + 1], costs[kTruth - i] + 0.02) << "a valley on the way";
      EXPECT_LT(costs[kTruth + i - 1], costs[kTruth + i] + 0.02) << "a valley on the way";
    }
  }
}

TEST(Peak, IsAtTheTruthInEveryDegreeOfFreedom) {
  const RenderedDepth rendered;
  Params params;
  params.lambda_k = 0;  // the images alone
  for (const auto foreground : {Foreground::mask, Foreground::depth}) {
    params.foreground = foreground;
    expect_best_at_truth(rendered, params);
  }
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
