#include "skin_texture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "field.hpp"
#include "skin_color.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Texels that a chart's colours reach beyond it, for filtering and mipmaps.
constexpr int kMargin = 10;

/// How free the surroundings are: the surface's distance, seen from points ever farther outside.
double openness(const HandSurface& surface, const Vector3d& p, const Vector3d& normal) {
  double blocked = 0, total = 0;
  for (double step = 2; step <= 26; step *= 1.6) {
    const double weight = 1 / step;
    blocked += weight * std::clamp(1 - surface(p + step * normal) / step, 0.0, 1.0);
    total += weight;
  }
  return 1 - blocked / total;
}

/// Calls visit(x, y, barycentric) for every texel whose centre lies in a triangle of the map.
template <typename Visit>
void for_each_texel(const std::array<Vector2d, 3>& corners, int size, const Visit& visit) {
  const Vector2d a = corners[0], u = corners[1] - a, v = corners[2] - a;
  const double det = u.x() * v.y() - u.y() * v.x();
  const Vector2d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector2d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  constexpr double kEdge = -1e-9;
  for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min(size - 1.0, high.y()); ++y)
    for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min(size - 1.0, high.x()); ++x) {
      const Vector2d p = Vector2d(x + 0.5, y + 0.5) - a;
      const double s = (p.x() * v.y() - p.y() * v.x()) / det;
      const double t = (u.x() * p.y() - u.y() * p.x()) / det;
      if (s >= kEdge && t >= kEdge && s + t <= 1 - kEdge) visit(x, y, Vector3d(1 - s - t, s, t));
    }
}

/// Pads the charts: every texel near one takes the colour of the nearest texel, breadth first.
void pad(cv::Mat& image, cv::Mat& distance) {
  std::deque<cv::Point> front;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (distance.at<uchar>(y, x) == 1) front.emplace_back(x, y);
  const cv::Rect all(0, 0, image.cols, image.rows);
  while (!front.empty()) {
    const cv::Point p = front.front();
    front.pop_front();
    const uchar reached = distance.at<uchar>(p);
    if (reached > kMargin) continue;
    for (const cv::Point q :
         {p + cv::Point(1, 0), p - cv::Point(1, 0), p + cv::Point(0, 1), p - cv::Point(0, 1)}) {
      if (!all.contains(q) || distance.at<uchar>(q) != 0) continue;
      distance.at<uchar>(q) = reached + 1;
      image.at<cv::Vec3b>(q) = image.at<cv::Vec3b>(p);
      front.push_back(q);
    }
  }
}

cv::Vec3b to_bgr(const Vector3d& rgb) {
  const Vector3d c = (255 * rgb).array().round();
  return {static_cast<uchar>(c[2]), static_cast<uchar>(c[1]), static_cast<uchar>(c[0])};
}

}  // namespace

SkinAttributes skin_attributes(const TriangleMesh& mesh, const HandSurface& surface,
                               const std::vector<VertexWeights>& weights) {
  SkinAttributes attributes;
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vector3d& p = mesh.vertices[v];
    const Vector3d normal = surface.gradient(p).normalized();
    Vector3d facing = Vector3d::Zero();
    for (int i = 0; i < 4; ++i) {
      const int bone = weights[v].bones[i], k = (bone - 1) % kBonesPerDigit;
      const bool free = bone > 0 && k >= (bone < bone_index(1, 0) ? 2 : 1);
      facing += weights[v].weights[i] *
                (free ? Vector3d(surface.skeleton()[bone].hand_from_bone.linear().col(2))
                      : Vector3d(0, 0, 1));
    }
    attributes.normals.push_back(normal);
    attributes.palmar.push_back(smooth_step(-0.45, 0.35, normal.dot(facing.normalized())));
    attributes.openness.push_back(openness(surface, p, normal));
  }
  return attributes;
}

cv::Mat skin_texture(const TriangleMesh& mesh, const SkinAttributes& attributes,
                     const TextureMap& map, const HandSurface& surface, int size) {
  const SkinColor color(surface.skeleton());
  cv::Mat image(size, size, CV_8UC3, to_bgr({0.78, 0.58, 0.49}));
  cv::Mat distance(size, size, CV_8U, cv::Scalar(0));
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    std::array<Vector2d, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = size * map.coordinates[map.triangles[t][i]];
    for_each_texel(corners, size, [&](int x, int y, const Vector3d& b) {
      if (distance.at<uchar>(y, x) != 0) return;
      SkinPoint point{Vector3d::Zero(), 0, 0};
      for (int i = 0; i < 3; ++i) {
        point.position += b[i] * mesh.vertices[triangle[i]];
        point.palmar += b[i] * attributes.palmar[triangle[i]];
        point.openness += b[i] * attributes.openness[triangle[i]];
      }
      image.at<cv::Vec3b>(y, x) = to_bgr(color(point));
      distance.at<uchar>(y, x) = 1;
    });
  }
  pad(image, distance);
  return image;
}

}  // namespace hypotrack::hand_mesh
