// Outlines and surfaces: the sphere of views, tracing, drawing, points.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contour_views.hpp"
#include "model_contours.hpp"
#include "terms.hpp"
#include "test_models.hpp"

namespace hypotrack::contour {
namespace {

TEST(ContourViews, LookFromEverywhereAboutEvenly) {
  for (const int subdivisions : {0, 1, 2, 3}) {
    const Eigen::Matrix3Xf directions = sphere_directions(subdivisions);
    ASSERT_EQ(directions.cols(), 10 * std::pow(4, subdivisions) + 2);
    for (Eigen::Index i = 0; i < directions.cols(); ++i) {
      EXPECT_NEAR(directions.col(i).norm(), 1, 1e-5);
      Eigen::VectorXf cosines = directions.transpose() * directions.col(i);
      cosines[i] = -1;
      const double spacing = std::acos(double{cosines.maxCoeff()});
      const double even = std::sqrt(4 * std::numbers::pi / static_cast<double>(directions.cols()));
      EXPECT_GT(spacing, 0.7 * even);
      EXPECT_LT(spacing, 1.3 * even);
    }
  }
}

TEST(ContourViews, AreThoseNextToTheCamera) {
  std::vector<std::uint32_t> first;
  std::vector<ContourPoint> points;
  const Eigen::Matrix3Xf directions = sphere_directions(1);
  const Eigen::Vector3f centre(0.1f, 0, 0);
  for (Eigen::Index i = 0; i <= directions.cols(); ++i) first.push_back(static_cast<unsigned>(i));
  for (const Eigen::Vector3f direction : directions.colwise())
    points.push_back({direction, direction, {0, 0, 0}, {0, 0, 0}, 1, 1});
  const ContourViews views(centre, directions, first, points);
  for (const Eigen::Vector3f direction : directions.colwise()) {
    Eigen::Isometry3f model_from_camera = Eigen::Isometry3f::Identity();
    model_from_camera.translation() = centre + 0.5f * direction + Eigen::Vector3f(0.02f, 0, 0);
    const auto seen = views.seen_by(model_from_camera.inverse());
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(seen[0].position, direction);
  }
}

TEST(TracedOutline, LiesOnTheEdgeOfADiscToATenthOfAPixel) {
  constexpr float kRadius = 60.3f;
  const Eigen::Vector2f centre(101.2f, 97.9f);
  cv::Mat1f depth(200, 200, 0.0f);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (std::hypot(static_cast<float>(x) - centre.x(), static_cast<float>(y) - centre.y()) <
          kRadius)
        depth(y, x) = 0.5f;
  const auto points = trace_contour(depth, 150);
  EXPECT_GT(points.size(), 130u);
  float off = 0;
  for (const TracedPoint& point : points) {
    const Eigen::Vector2f from_centre = point.position - centre;
    EXPECT_NEAR(from_centre.norm(), kRadius, 0.6);
    off += from_centre.norm() - kRadius;
    EXPECT_GT(point.normal.dot(from_centre.normalized()), 0.97f);
    EXPECT_EQ(point.depth, 0.5f);
    EXPECT_NEAR(point.inside, 2 * kRadius, 6);
    EXPECT_TRUE(std::isinf(point.outside));
  }
  EXPECT_NEAR(off / static_cast<float>(points.size()), 0, 0.1);
}

TEST(TracedOutline, HasHolesAndNoCorners) {
  cv::Mat1f depth(200, 200, 0.0f);
  depth(cv::Rect(40, 50, 120, 100)).setTo(0.5);
  depth(cv::Rect(80, 80, 40, 40)).setTo(0);
  const Eigen::Vector2f middle(99.5f, 99.5f);  // of the hole
  int of_hole = 0, of_outside = 0;
  for (const TracedPoint& point : trace_contour(depth, 300)) {
    EXPECT_GT(point.normal.cwiseAbs().maxCoeff(), 0.97f);  // along an axis
    const Eigen::Vector2f off = point.position - middle;
    if (off.cwiseAbs().maxCoeff() > 30) {
      ++of_outside;
      continue;
    }
    ++of_hole;
    EXPECT_NEAR(point.outside, 40, 2);
    EXPECT_LT(point.normal.dot(off), 0);  // into the hole
    EXPECT_NEAR(off.cwiseAbs().maxCoeff(), 20, 0.4);
  }
  EXPECT_GT(of_hole, 50);
  EXPECT_GT(of_outside, 150);
}

TEST(TracedOutline, OfNothingIsEmpty) {
  EXPECT_TRUE(trace_contour(cv::Mat1f(50, 50, 0.0f), 100).empty());
}

TEST(TracedOutline, LeavesOutSpecks) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(2, 2)}) {
    cv::Mat1f depth(50, 50, 0.0f);
    depth(cv::Rect(cv::Point(20, 20), size)) = 0.5f;
    EXPECT_TRUE(trace_contour(depth, 100).empty()) << size;
  }
}

TEST(DrawnOutline, OfABoxLiesOnItsEdgesAndKnowsTheirSides) {
  const Eigen::Vector3f half(0.03f, 0.02f, 0.06f);
  const ContourViews views =
      draw_contours(std::make_shared<Model>(test::make_test_box()), {.subdivisions = 1});
  for (std::size_t view = 0; view + 1 < views.first().size(); ++view) {
    const Eigen::Vector3f direction = views.directions().col(static_cast<Eigen::Index>(view));
    EXPECT_GT(views.first()[view + 1] - views.first()[view], 120u);
    for (std::size_t i = views.first()[view]; i < views.first()[view + 1]; ++i) {
      const ContourPoint& point = views.points()[i];
      const Eigen::Array3f beyond = half.array() - point.position.array().abs();
      EXPECT_EQ((beyond.abs() < 1e-5f).count(), 2) << point.position.transpose();  // on an edge
      EXPECT_GE(beyond.minCoeff(), -1e-5f);
      EXPECT_NEAR(point.front.dot(point.back), 0, 1e-5);
      const Eigen::Vector3f to_camera = 5 * half.norm() * direction - point.position;
      EXPECT_GT(point.front.dot(to_camera), 0);
      EXPECT_LT(point.back.dot(to_camera), 0);
      EXPECT_NEAR(point.normal.dot(to_camera.normalized()), 0, 1e-4);
      EXPECT_GT(point.normal.dot(point.front + point.back), 0);
    }
  }
}

TEST(DrawnOutline, OfABallIsWhereItsTangentsAre) {
  constexpr float kRadius = 0.05f;
  const auto ball = std::make_shared<Model>(test::make_test_ball(kRadius));
  const ContourViews views = draw_contours(ball, {.subdivisions = 0, .points = 100});
  ASSERT_EQ(views.directions().cols(), 12);
  ASSERT_GT(views.points().size(), 12u * 80);
  double off = 0;
  for (const ContourPoint& point : views.points()) off += point.position.norm() / kRadius - 1;
  EXPECT_NEAR(off / static_cast<double>(views.points().size()), 0, 0.003);
  for (const ContourPoint& point : views.points()) {
    EXPECT_NEAR(point.position.norm(), kRadius, 0.02 * kRadius);
    EXPECT_GT(point.normal.dot(point.position.normalized()), 0.97f);
  }
}

TEST(DrawnOutline, IsOfRigidModelsOnly) {
  EXPECT_TRUE(is_rigid(Model(test::make_test_box())));
  EXPECT_FALSE(is_rigid(Model(test::make_test_hand())));
}

TEST(SurfacePoints, AreEvenlySpreadAndPointOutwards) {
  const ModelData box = test::make_test_box();  // 60 x 40 x 120 mm
  const std::vector<SurfacePoint> points = spread_points(box.mesh, 2000);
  ASSERT_EQ(points.size(), 2000u);
  Eigen::Vector3i on_axis(0, 0, 0);
  Eigen::Vector3f mean(0, 0, 0);
  for (const SurfacePoint& point : points) {
    Eigen::Index axis = 0;
    EXPECT_NEAR(point.normal.cwiseAbs().maxCoeff(&axis), 1, 1e-5);
    ++on_axis[axis];
    mean += point.position / 2000;
    const float half = axis == 0 ? 0.03f : axis == 1 ? 0.02f : 0.06f;
    EXPECT_NEAR(point.position[axis], half * point.normal[axis], 1e-5);
    EXPECT_TRUE((point.position.array().abs() <= Eigen::Array3f(0.0301f, 0.0201f, 0.0601f)).all());
  }
  const double all = 2 * (40 * 120 + 60 * 120 + 60 * 40);
  EXPECT_NEAR(on_axis[0], 2000 * 2 * 40 * 120 / all, 20);
  EXPECT_NEAR(on_axis[1], 2000 * 2 * 60 * 120 / all, 20);
  EXPECT_NEAR(on_axis[2], 2000 * 2 * 60 * 40 / all, 20);
  EXPECT_LT(mean.norm(), 0.001);
}

TEST(SurfacePoints, PointOutwardsWhereTrianglesFaceInwards) {
  Mesh inverted = test::make_test_box().mesh;
  inverted.triangles.row(0).swap(inverted.triangles.row(1));
  for (const SurfacePoint& point : spread_points(inverted, 100))
    EXPECT_GT(point.position.dot(point.normal), 0);
}

}  // namespace
}  // namespace hypotrack::contour
