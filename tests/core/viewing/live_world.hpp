#pragma once

#include <memory>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "test_models.hpp"
#include "viewing/live_frame.hpp"

namespace hypotrack::test {

/// A hand half a metre before two cameras, and frames of it on grey pictures.
class LiveWorld {
 public:
  LiveWorld() {
    Camera camera;
    camera.width = 320;
    camera.height = 240;
    camera.fx = camera.fy = 300;
    camera.cx = 159.5;
    camera.cy = 119.5;
    cameras = {camera, camera};
    cameras[1].camera_from_world.translation().x() = -0.1;
  }

  Frame frame(int index) const {
    Frame out{.index = index, .time = index / 30.0, .views = {}, .truth = {}, .problem = {}};
    for (const Camera& camera : cameras)
      out.views.push_back(
          {.color = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(90))});
    return out;
  }

  Solution solution(int index, Status status, double probability) const {
    Solution out;
    out.frame = index;
    out.time = index / 30.0;
    out.status = status;
    out.models = {status};
    out.state = scene.rest_state();
    out.state.head<3>() << 0.03, 0.05, 0.5;
    out.probabilities = {probability};
    return out;
  }

  LiveFrame live(int index, Status status = Status::tracked, double probability = 1) const {
    LiveFrame out;
    out.solution = solution(index, status, probability);
    out.sigmas = model_sigmas(scene, out.solution);
    out.views = std::make_shared<const ShownViews>(shown_views(frame(index), out.solution));
    return out;
  }

  Scene scene{{{"hand", std::make_shared<Model>(make_test_hand())}}};
  std::vector<Camera> cameras;
};

}  // namespace hypotrack::test
