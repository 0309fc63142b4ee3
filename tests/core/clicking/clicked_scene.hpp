#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clicking/clicker.hpp"
#include "test_models.hpp"

namespace hypotrack::test {

/// A hand whose wrist and tips are clear.
class ClearHand final : public Model {
 public:
  ClearHand() : Model(make_test_hand()) {}

 private:
  std::vector<std::string> do_clear_landmarks() const override {
    return {"wrist", "index_tip", "no_landmark", "thumb_tip", "middle_tip", "ring_tip"};
  }
};

/// A hand half a metre before two cameras, and clicks on it.
class ClickedScene {
 public:
  ClickedScene() {
    Camera camera;
    camera.width = 640;
    camera.height = 480;
    camera.fx = camera.fy = 600;
    camera.cx = 319.5;
    camera.cy = 239.5;
    cameras = {camera, camera};
    cameras[1].camera_from_world.translation().x() = -0.1;
    state = scene.rest_state();
    state.head<3>() << 0.03, 0.05, 0.5;
    state.segment<4>(3) << 0, 1, 0, 0;
  }

  /// Returns the pixel of a landmark in a view.
  Eigen::Vector2d pixel(const std::string& name, std::size_t view) const {
    const auto& landmarks = scene.items()[0].model->data().landmarks;
    for (std::size_t i = 0; i < landmarks.size(); ++i)
      if (landmarks[i].name == name)
        return project(cameras[view], scene.landmarks(state).col(static_cast<Eigen::Index>(i)));
    throw std::out_of_range(name);
  }

  /// Clicks the landmark that is asked for in both views.
  void click(clicking::Clicker& clicker) const {
    const std::string name = clicker.asked();
    for (const std::size_t view : {0, 1}) clicker.click(view, pixel(name, view));
  }

  Scene scene{{{"hand", std::make_shared<ClearHand>()}}};
  std::vector<Camera> cameras;
  Eigen::VectorXd state;
};

}  // namespace hypotrack::test
