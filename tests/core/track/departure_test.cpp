#include "track/loop/departure.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// A hand half a metre before two cameras whose pictures show 0.5 m to either side there.
class DepartureTest : public testing::Test {
 protected:
  DepartureTest() {
    Camera camera;
    camera.fx = camera.fy = 300;
    camera.cx = 299.5;
    camera.cy = 299.5;
    camera.width = camera.height = 600;
    cameras_ = {camera, camera};
    cameras_[1].camera_from_world.translation().x() = -0.1;
  }

  /// Shows the hand in two frames, 30 a second, and says whether it is gone `later` seconds on.
  bool is_gone(double from, double to, double later) const {
    Departure departure(scene_, cameras_);
    departure.remember(at(from), 1, {true});
    departure.remember(at(to), 1 + 1.0 / 30, {true});
    return departure.is_gone(0, 1 + 1.0 / 30 + later);
  }

  Eigen::VectorXd at(double x) const {
    Eigen::VectorXd state = scene_.rest_state();
    state.head<3>() +=
        Eigen::Vector3d(x, 0, 0.5) - scene_.landmarks(scene_.rest_state()).rowwise().mean();
    return state;
  }

  Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};
  std::vector<Camera> cameras_;
};

TEST_F(DepartureTest, OfAHandThatMovesOutOfAllPictures) {
  EXPECT_TRUE(is_gone(0.5, 0.55, 0.1));
  EXPECT_TRUE(is_gone(0.8, 0.8, 0));
}

TEST_F(DepartureTest, NotOfAHandThatRestsOrMovesInside) {
  EXPECT_FALSE(is_gone(0, 0, 10));
  EXPECT_FALSE(is_gone(0.4, 0.35, 0.1));
}

TEST_F(DepartureTest, NotOfAHandThatOnePictureStillShows) { EXPECT_FALSE(is_gone(0.55, 0.55, 1)); }

TEST_F(DepartureTest, NotOfModelsThatWereNeverSeenOrAreForgotten) {
  Departure departure(scene_, cameras_);
  EXPECT_FALSE(departure.is_gone(0, 1));
  departure.remember(at(2), 1, {true});
  EXPECT_TRUE(departure.is_gone(0, 1));
  departure.forget();
  EXPECT_FALSE(departure.is_gone(0, 1));
}

}  // namespace
}  // namespace hypotrack
