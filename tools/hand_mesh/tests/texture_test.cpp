#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double texture_area(const TextureMap& map, const Triangle& t) {
  const Vector2d a = map.coordinates[t[1]] - map.coordinates[t[0]];
  const Vector2d b = map.coordinates[t[2]] - map.coordinates[t[0]];
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

double surface_area(const TriangleMesh& mesh, const Triangle& t) {
  return 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                   .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                   .norm();
}

cv::Vec3d color_at(const Vector2d& coordinate) {
  const cv::Mat& texture = the_hand().texture;
  const cv::Point texel(static_cast<int>(coordinate.x() * texture.cols),
                        static_cast<int>(coordinate.y() * texture.rows));
  cv::Vec3d sum(0, 0, 0);
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      sum += cv::Vec3d(texture.at<cv::Vec3b>(texel + cv::Point(dx, dy)));
  return sum / 25;
}

TEST(HandTexture, HasCoordinatesForEveryTriangleInsideOfTheImage) {
  const HandAsset& hand = the_hand();
  ASSERT_EQ(hand.texture_map.triangles.size(), hand.mesh.triangles.size());
  for (size_t t = 0; t < hand.mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(hand.texture_map.vertex_of[hand.texture_map.triangles[t][i]],
                hand.mesh.triangles[t][i]);
  for (const Vector2d& c : hand.texture_map.coordinates) {
    ASSERT_GT(c.minCoeff(), 0);
    ASSERT_LT(c.maxCoeff(), 1);
  }
}

TEST(HandTexture, CoversNoTexelTwiceAndLeavesGapsBetweenCharts) {
  const HandAsset& hand = the_hand();
  constexpr int kSize = 2048;
  std::vector<int> owner(kSize * kSize, -1);
  for (size_t t = 0; t < hand.texture_map.triangles.size(); ++t) {
    const Triangle& triangle = hand.texture_map.triangles[t];
    const Vector2d a = kSize * hand.texture_map.coordinates[triangle[0]];
    const Vector2d b = kSize * hand.texture_map.coordinates[triangle[1]];
    const Vector2d c = kSize * hand.texture_map.coordinates[triangle[2]];
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const double det = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    for (int y = static_cast<int>(low.y()); y <= high.y(); ++y)
      for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
        const Vector2d p = Vector2d(x + 0.5, y + 0.5) - a;
        const double u = (p.x() * (c - a).y() - p.y() * (c - a).x()) / det;
        const double v = ((b - a).x() * p.y() - (b - a).y() * p.x()) / det;
        if (u < 1e-9 || v < 1e-9 || u + v > 1 - 1e-9) continue;
        ASSERT_EQ(owner[y * kSize + x], -1) << "texel " << x << " " << y;
        owner[y * kSize + x] = static_cast<int>(t);
      }
  }
  const auto used = owner.size() - std::count(owner.begin(), owner.end(), -1);
  EXPECT_GT(static_cast<double>(used), 0.45 * kSize * kSize);
}

TEST(HandTexture, GivesAllSkinTheSameShare) {
  const HandAsset& hand = the_hand();
  const double scale = hand.texture_map.millimetres * hand.texture_map.millimetres;
  for (size_t t = 0; t < hand.mesh.triangles.size(); ++t) {
    const double ratio = std::abs(texture_area(hand.texture_map, hand.texture_map.triangles[t])) *
                         scale / surface_area(hand.mesh, hand.mesh.triangles[t]);
    ASSERT_GT(ratio, 0.6);
    ASSERT_LT(ratio, 1.6);
  }
}

TEST(HandTexture, ShowsChartsAsSeenFromOutside) {
  for (const Triangle& t : the_hand().texture_map.triangles)
    ASSERT_LT(texture_area(the_hand().texture_map, t), 0) << "v runs downwards";
}

TEST(HandTexture, MatchesAcrossSeams) {
  const TextureMap& map = the_hand().texture_map;
  std::map<int, std::vector<int>> copies;
  for (size_t i = 0; i < map.vertex_of.size(); ++i)
    copies[map.vertex_of[i]].push_back(static_cast<int>(i));
  double worst = 0, sum = 0;
  int seams = 0;
  for (const auto& [vertex, places] : copies)
    for (size_t i = 1; i < places.size(); ++i) {
      const double difference =
          cv::norm(color_at(map.coordinates[places[0]]) - color_at(map.coordinates[places[i]]));
      worst = std::max(worst, difference);
      sum += difference;
      ++seams;
    }
  ASSERT_GT(seams, 100);
  EXPECT_LT(sum / seams, 12) << "grey levels";
  EXPECT_LT(worst, 75) << "grey levels";
}

TEST(HandTexture, HasDetailToMatchEverywhere) {
  // Windows of 5 mm on the skin, seen as by a camera with pixels of 0.7 mm.
  const HandAsset& hand = the_hand();
  const double texels_per_mm = hand.texture.cols / hand.texture_map.millimetres;
  cv::Mat grey, blurred;
  cv::cvtColor(hand.texture, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F);
  cv::GaussianBlur(grey, blurred, {}, 0.35 * texels_per_mm);
  const int half = static_cast<int>(2.5 * texels_per_mm);
  std::vector<double> contrasts;
  for (size_t t = 0; t < hand.mesh.triangles.size(); ++t) {
    Vector2d middle = Vector2d::Zero();
    for (int i : hand.texture_map.triangles[t]) middle += hand.texture_map.coordinates[i] / 3;
    const cv::Point at(static_cast<int>(middle.x() * grey.cols),
                       static_cast<int>(middle.y() * grey.rows));
    const cv::Rect window = cv::Rect(at.x - half, at.y - half, 2 * half, 2 * half) &
                            cv::Rect(0, 0, grey.cols, grey.rows);
    cv::Scalar mean, deviation;
    cv::meanStdDev(blurred(window), mean, deviation);
    contrasts.push_back(deviation[0]);
  }
  std::sort(contrasts.begin(), contrasts.end());
  EXPECT_GT(contrasts.front(), 1.2) << "grey levels";
  EXPECT_GT(contrasts[contrasts.size() / 2], 4.0) << "grey levels";
}

TEST(HandTexture, HasTheColoursOfSkin) {
  const cv::Scalar mean = cv::mean(the_hand().texture);
  EXPECT_GT(mean[2], mean[1] + 20);
  EXPECT_GT(mean[1], mean[0] + 5);
}

}  // namespace
}  // namespace hypotrack::hand_mesh
