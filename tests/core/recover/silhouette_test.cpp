#include "track/recover/silhouette.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

class SilhouetteTest : public testing::Test {
 protected:
  SilhouetteTest() {
    state_.segment<3>(0) << -0.1, 0, 0.5;
    state_.segment<3>(7) << 0.1, 0, 0.5;
  }
  /// Center of what is drawn of some models.
  cv::Point2d center(const std::vector<bool>& models) {
    const cv::Mat1b drawn = silhouettes(scene_, models, state_, camera_, 4);
    EXPECT_EQ(drawn.size(), cv::Size(160, 120));
    const cv::Moments m = cv::moments(drawn, true);
    return m.m00 > 0 ? cv::Point2d(m.m10 / m.m00, m.m01 / m.m00) : cv::Point2d(-1, -1);
  }

  Scene scene_{{{"a", std::make_shared<Model>(test::make_test_box())},
                {"b", std::make_shared<Model>(test::make_test_box())}}};
  Eigen::VectorXd state_ = scene_.rest_state();
  Camera camera_{
      640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, Eigen::Isometry3d::Identity()};
};

TEST_F(SilhouetteTest, LiesWhereTheCameraSeesTheModel) {
  EXPECT_NEAR(center({true, false}).x, (319.5 - 100) / 4, 12);
  EXPECT_NEAR(center({false, true}).x, (319.5 + 100) / 4, 12);
}

TEST_F(SilhouetteTest, TrianglesOfTwoPixelsCoverTheirCorners) {
  state_.segment<3>(0) << -0.05, 0.03, 30;  // metres
  const cv::Mat1b drawn = silhouettes(scene_, {true, false}, state_, camera_, 1);
  cv::Mat1b expected(drawn.size(), std::uint8_t{0});
  const Scene::Item& box = scene_.items()[0];
  const Eigen::Matrix3Xf vertices = posed_vertices(*box.model, scene_.part(box, state_));
  for (const auto& vertex : vertices.colwise()) {
    const Eigen::Vector2d at = project(camera_, vertex.cast<double>());
    expected(cvRound(at.y()), cvRound(at.x())) = 255;
  }
  EXPECT_GT(cv::countNonZero(expected), 1);
  EXPECT_EQ(cv::norm(drawn, expected, cv::NORM_INF), 0);
}

TEST_F(SilhouetteTest, FewerTrianglesStandForManyWhereTheModelHasThem) {
  ModelData ball = test::make_test_ball(0.05f);
  const Scene whole({{"ball", std::make_shared<Model>(ball)}});
  ball.simplified = ball.mesh;
  ball.simplified.vertices *= 0.5f;  // smaller, to be told from the mesh
  const Scene fewer({{"ball", std::make_shared<Model>(ball)}});
  Eigen::VectorXd state = whole.rest_state();
  state.head<3>() << 0, 0, 0.5;
  const auto pixels = [&](const Scene& scene) {
    return cv::countNonZero(silhouettes(scene, {true}, state, camera_, 1));
  };
  EXPECT_NEAR(4.0 * pixels(fewer) / pixels(whole), 1, 0.1);
}

TEST_F(SilhouetteTest, NothingIsDrawnOfModelsThatAreNotAskedForOrBehind) {
  EXPECT_EQ(center({false, false}).x, -1);
  state_[2] = -0.5;
  EXPECT_EQ(center({true, false}).x, -1);
}

}  // namespace
}  // namespace hypotrack
