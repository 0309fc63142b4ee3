#include "hypotrack/api/renderer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <thread>

#include "hypotrack/api/error.hpp"
#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A rectangle at depth z that covers [x0, x1] x [y0, y1] in pixels.
Mesh rectangle(const Camera& c, double x0, double y0, double x1, double y1, double z) {
  const Eigen::Vector3d center = point_at(c, (x0 + x1) / 2, (y0 + y1) / 2, z);
  const Eigen::Vector3d right = point_at(c, x1, (y0 + y1) / 2, z) - center;
  const Eigen::Vector3d down = point_at(c, (x0 + x1) / 2, y1, z) - center;
  return parallelogram(center, right, -down);
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(Renderer, SaysWhatDraws) {
  const Scene scene = scene_of({box({0.1F, 0.1F, 0.1F})});
  EXPECT_THAT(Renderer(scene).device(), HasSubstr("OpenGL"));
}

TEST(Renderer, CoversExactlyThePixelsWhoseCentresAreInside) {
  const Camera camera = camera_at_origin();
  for (const double shift : {-0.02, 0.02}) {
    const Scene scene =
        scene_of({rectangle(camera, 100 + shift, 61 + shift, 140 + shift, 90 + shift, 0.5)});
    const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
    const int first = shift < 0 ? 0 : 1;
    EXPECT_EQ(spot(view.label).box, cv::Rect(100 + first, 61 + first, 40, 29)) << "shift " << shift;
    EXPECT_EQ(cv::countNonZero(view.label), 40 * 29);
  }
}

TEST(Renderer, DrawsAPointWhereProjectSays) {
  Camera camera = camera_at_origin();
  camera.camera_from_world = Eigen::Translation3d(0.02, -0.01, 0.1) *
                             Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, -0.5).normalized());
  const Eigen::Matrix3d axes = camera.camera_from_world.linear().transpose();
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(30.3, 40.8), {160.0, 119.5}, {290.6, 200.2}}) {
    const Eigen::Vector3d point = point_at(camera, pixel.x(), pixel.y(), 0.4);
    ASSERT_LT((project(camera, point) - pixel).norm(), 1e-9);
    // A diamond, so that its edges cross the pixels' rows and columns everywhere.
    const double half = 12.0 / camera.fx * 0.4;
    const Scene scene = scene_of({parallelogram(point, half * (axes.col(0) + 0.9 * axes.col(1)),
                                                half * (axes.col(0) - 1.1 * axes.col(1)))});
    const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
    EXPECT_LT((spot(view.label).centroid - pixel).lpNorm<Eigen::Infinity>(), 0.1);
  }
}

TEST(Renderer, GivesTheDepthOfASlantedPlane) {
  const Camera camera = camera_at_origin();
  const Eigen::Vector3d center(0.01, -0.02, 0.6), u(0.2, 0.02, 0.25), v(0.03, -0.2, 0.1);
  const Scene scene = scene_of({parallelogram(center, u, v)});
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
  const Eigen::Vector3d normal = u.cross(v);
  int seen = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const float depth = view.depth.at<float>(y, x);
      ASSERT_EQ(depth > 0, view.label.at<unsigned char>(y, x) == 1);
      if (depth == 0) continue;
      const Eigen::Vector3d ray = point_at(camera, x, y, 1);
      const double expected = normal.dot(center) / normal.dot(ray);
      ASSERT_NEAR(depth / expected, 1, 1e-5) << x << ' ' << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 10000);
}

TEST(Renderer, ShowsTheNearerModelAndLabelsIt) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({rectangle(camera, 49.5, 49.5, 149.5, 149.5, 0.6),
                                rectangle(camera, 99.5, 99.5, 199.5, 199.5, 0.5)});
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
  EXPECT_EQ(view.label.at<unsigned char>(60, 60), 1);
  EXPECT_EQ(view.label.at<unsigned char>(120, 120), 2);
  EXPECT_EQ(view.label.at<unsigned char>(30, 30), 0);
  EXPECT_NEAR(view.depth.at<float>(120, 120), 0.5, 1e-5);
  EXPECT_EQ(spot(view.label, 2).box, cv::Rect(100, 100, 100, 100));
}

TEST(Renderer, LeavesHiddenModelsOut) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of(
      {rectangle(camera, 100, 60, 140, 90, 0.5), rectangle(camera, 120, 60, 160, 90, 0.6)});
  Renderer renderer(scene);
  const auto pixels = [&](const std::vector<bool>& hidden, int label) {
    const RenderedView view = renderer.render(scene.rest_state(), camera, {.hidden = hidden});
    return cv::countNonZero(view.label == label);
  };
  EXPECT_NEAR(pixels({}, 2), 20 * 30, 60);
  EXPECT_NEAR(pixels({true, false}, 2), 40 * 30, 75) << "nothing is before it";
  EXPECT_EQ(pixels({true, false}, 1), 0);
  EXPECT_EQ(pixels({true, true}, 0), camera.width * camera.height);
  EXPECT_NEAR(pixels({}, 1), 40 * 30, 75);
}

TEST(Renderer, MovesAModelWithItsState) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({box({0.02F, 0.02F, 0.02F})});
  Renderer renderer(scene);
  Eigen::VectorXd state = scene.rest_state();
  state.head<3>() = point_at(camera, 250, 60, 0.8);
  const RenderedView far = renderer.render(state, camera, {});
  EXPECT_LT((spot(far.label).centroid - Eigen::Vector2d(250, 60)).norm(), 1.0);
  state.head<3>() = point_at(camera, 50, 160, 0.4);
  const RenderedView near = renderer.render(state, camera, {});
  EXPECT_LT((spot(near.label).centroid - Eigen::Vector2d(50, 160)).norm(), 2.0);
  EXPECT_GT(cv::countNonZero(near.label), 3 * cv::countNonZero(far.label));
}

TEST(Renderer, DrawsTheSamePictureWhateverPartOfItIsInSight) {
  const Camera whole = camera_at_origin();
  Camera part = whole;
  part.width = 150;
  part.height = 100;
  part.cx -= 90;
  part.cy -= 70;
  const Scene scene = scene_of({box({0.1F, 0.06F, 0.05F})});
  Eigen::VectorXd state = scene.rest_state();
  state << 0.02, 0.01, 0.5, 0.9, 0.3, 0.2, 0.1;
  Renderer renderer(scene);
  const RenderedView a = renderer.render(state, whole, {});
  const RenderedView b = renderer.render(state, part, {});
  const cv::Rect roi(90, 70, 150, 100);
  EXPECT_GT(cv::countNonZero(b.label), 5000);
  EXPECT_TRUE(same(a.label(roi).clone(), b.label));
  double difference = cv::norm(a.depth(roi), b.depth, cv::NORM_INF);
  EXPECT_LT(difference, 1e-5);
}

TEST(Renderer, LeavesTheBackgroundWhereNothingIs) {
  const Camera camera = camera_at_origin();
  cv::Mat background(camera.height, camera.width, CV_8UC3, cv::Scalar(10, 120, 240));
  const Scene scene = scene_of({box({0.02F, 0.02F, 0.02F})});
  Renderer renderer(scene);
  for (const Eigen::Vector3d& position : {Eigen::Vector3d(0, 0, -0.5), {5, 0, 0.5}}) {
    Eigen::VectorXd state = scene.rest_state();
    state.head<3>() = position;
    const RenderedView view = renderer.render(state, camera, {}, background);
    EXPECT_TRUE(same(view.color, background));
    EXPECT_EQ(cv::countNonZero(view.label), 0);
    EXPECT_EQ(cv::countNonZero(view.depth), 0);
  }
}

TEST(Renderer, CutsAModelThatReachesBehindTheCamera) {
  const Camera camera = camera_at_origin();
  // A floor 5 cm below the camera, from behind it to 2 m before it.
  const Scene scene = scene_of({parallelogram({0, 0.05, 0.5}, {0.3, 0, 0}, {0, 0, 1.5})});
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
  const int y = camera.height - 1;
  EXPECT_NEAR(view.depth.at<float>(y, 160), 0.05 * camera.fy / (y - camera.cy), 1e-5);
  EXPECT_EQ(view.label.at<unsigned char>(static_cast<int>(camera.cy) - 5, 160), 0);
}

struct LensCase {
  const char* name;
  DistortionModel model;
  std::vector<double> coefficients;
};

void PrintTo(const LensCase& lens, std::ostream* out) { *out << lens.name; }

class RendererLens : public ::testing::TestWithParam<LensCase> {};

/// Centre of mass of the polygon that a camera sees.
Eigen::Vector2d projected_centroid(const Camera& camera, const Eigen::Matrix3Xf& outline) {
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    const Eigen::Vector2d a = project(camera, outline.col(i).cast<double>());
    const Eigen::Vector2d b = project(camera, outline.col((i + 1) % outline.cols()).cast<double>());
    const double cross = a.x() * b.y() - a.y() * b.x();
    moment += cross / 3 * (a + b);
    area += cross;
  }
  return moment / area;
}

TEST_P(RendererLens, DrawsAPointWhereProjectSays) {
  Camera camera = camera_at_origin(320, 240, 240);
  camera.distortion_model = GetParam().model;
  camera.distortion = GetParam().coefficients;
  Camera pinhole = camera_at_origin(320, 240, 240);
  // Small spots, one model each, all over the picture.
  std::vector<Mesh> meshes;
  std::vector<Eigen::Vector3d> points;
  for (const double x : {40.0, 160.0, 270.0}) {
    for (const double y : {40.0, 120.0, 190.0}) {
      points.push_back(point_at(pinhole, x, y, 0.5 + 1e-3 * x));
      meshes.push_back(disc(points.back(), 0.03));
    }
  }
  const Scene scene = scene_of(meshes);
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
  double largest_shift = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d expected = project(camera, points[i]);
    const Eigen::Vector2d middle = projected_centroid(camera, meshes[i].vertices);
    const Spot found = spot(view.label, static_cast<int>(i) + 1);
    EXPECT_LT((found.centroid - middle).lpNorm<Eigen::Infinity>(), 0.2) << "point " << i;
    const cv::Point pixel(cvRound(expected.x()), cvRound(expected.y()));
    EXPECT_NEAR(view.depth.at<float>(pixel), points[i].z(), 1e-5);
    largest_shift = std::max(largest_shift, (project(pinhole, points[i]) - expected).norm());
  }
  EXPECT_GT(largest_shift, 3) << "the case distorts too little to show anything";
}

INSTANTIATE_TEST_SUITE_P(
    EveryModel, RendererLens,
    ::testing::Values(
        LensCase{"brown4", DistortionModel::brown, {-0.25, 0.08, 0.004, -0.006}},
        LensCase{"brown5", DistortionModel::brown, {0.2, -0.05, 0.002, 0.003, 0.02}},
        LensCase{"brown8", DistortionModel::brown, {0.5, 0.1, 1e-3, -2e-3, 0.01, 0.8, 0.2, 0.02}},
        LensCase{"fisheye", DistortionModel::fisheye, {-0.02, 0.01, -0.004, 0.001}}),
    [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(Renderer, KeepsColoursThroughALens) {
  Camera camera = camera_at_origin();
  camera.distortion_model = DistortionModel::brown;
  camera.distortion = {-0.2, 0.05, 0, 0};
  Mesh wall = rectangle(camera_at_origin(), 80, 60, 240, 180, 0.5);
  wall.color = {1.0F, 0.2F, 0.4F};
  const Scene scene = scene_of({wall});
  const cv::Mat background(camera.height, camera.width, CV_8UC3, cv::Scalar(9, 8, 7));
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {}, background);
  EXPECT_EQ(view.color.at<cv::Vec3b>(120, 160), cv::Vec3b(102, 51, 255));
  EXPECT_EQ(view.color.at<cv::Vec3b>(5, 5), cv::Vec3b(9, 8, 7));
}

TEST(Renderer, RepeatsItselfToTheByte) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({box({0.1F, 0.06F, 0.05F})});
  Eigen::VectorXd state = scene.rest_state();
  state << 0.02, 0.01, 0.5, 0.9, 0.3, 0.2, 0.1;
  const RenderStyle style{.ambient = 0.4, .diffuse = 0.6, .specular = 0.2};
  const RenderedView a = Renderer(scene).render(state, camera, style);
  const RenderedView b = Renderer(scene).render(state, camera, style);
  EXPECT_TRUE(same(a.color, b.color));
  EXPECT_TRUE(same(a.depth, b.depth));
}

TEST(Renderer, CanBeHandedFromThreadToThread) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({rectangle(camera, 99.5, 99.5, 119.5, 119.5, 0.5)});
  Renderer renderer(scene);
  const auto count = [&](Renderer& r) {
    return cv::countNonZero(r.render(scene.rest_state(), camera, {}).label);
  };
  EXPECT_EQ(count(renderer), 400);
  int other = 0, own = 0;
  std::thread([&] { other = count(renderer); }).join();
  std::thread second([&] {
    Renderer mine(scene);
    own = count(mine);
  });
  EXPECT_EQ(count(renderer), 400);
  second.join();
  EXPECT_EQ(other, 400);
  EXPECT_EQ(own, 400);
}

template <class F>
std::string message_of(F&& f) {
  try {
    f();
  } catch (const DataError& error) {
    return error.what();
  }
  return "no DataError";
}

TEST(Renderer, RefusesWhatItCannotDraw) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({box({0.1F, 0.1F, 0.1F})});
  Renderer renderer(scene);
  const Eigen::VectorXd state = scene.rest_state();
  EXPECT_THAT(message_of([&] { renderer.render(state.head(5), camera, {}); }),
              AllOf(HasSubstr("5 numbers"), HasSubstr("7 parameters")));
  EXPECT_THAT(message_of([&] { renderer.render(state * NAN, camera, {}); }),
              HasSubstr("not finite"));
  EXPECT_THAT(
      message_of([&] { renderer.render(state, camera, {}, cv::Mat::zeros(9, 8, CV_8UC3)); }),
      AllOf(HasSubstr("8x9"), HasSubstr("320x240")));
  EXPECT_THAT(message_of([&] { renderer.render(state, {}, {}); }),
              HasSubstr("the camera to render for"));
}

}  // namespace
}  // namespace hypotrack::test
