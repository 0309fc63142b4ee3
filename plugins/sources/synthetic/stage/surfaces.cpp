#include "stage/surfaces.hpp"

#include <opencv2/imgproc.hpp>
#include <utility>

namespace hypotrack::synthetic {

Mesh make_wall(const Eigen::AlignedBox2d& box, double distance, cv::Mat texture) {
  Mesh mesh;
  const auto [x0, y0] = std::pair(box.min().x(), box.min().y());
  const auto [x1, y1] = std::pair(box.max().x(), box.max().y());
  Eigen::Matrix<double, 3, 4> corners;
  corners << x0, x0, x1, x1, y0, y1, y1, y0, distance, distance, distance, distance;
  mesh.vertices = corners.cast<float>();
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  mesh.uv.resize(2, 4);
  mesh.uv << 0, 0, 1, 1, 1, 0, 0, 1;
  mesh.uv_triangles = mesh.triangles;
  mesh.texture = std::move(texture);
  return mesh;
}

/// Makes every octave half as coarse as the one before, and weaker.
cv::Mat make_pattern(cv::RNG& random, int size) {
  constexpr int kCoarsest = 4;
  constexpr double kFirst = 38, kDecay = 0.72, kTint = 0.4;
  const double middle = random.uniform(75., 165.);
  const auto level = [&] { return middle + random.uniform(-35., 35.); };
  cv::Mat sum(kCoarsest, kCoarsest, CV_32FC3, cv::Scalar(level(), level(), level()));
  for (double amplitude = kFirst;; amplitude *= kDecay) {
    cv::Mat tint(sum.size(), CV_32FC3), light(sum.size(), CV_32FC1), gray;
    random.fill(tint, cv::RNG::UNIFORM, -kTint * amplitude, kTint * amplitude);
    random.fill(light, cv::RNG::UNIFORM, -amplitude, amplitude);
    cv::cvtColor(light, gray, cv::COLOR_GRAY2BGR);
    sum += tint + gray;
    if (sum.cols >= size) break;
    cv::resize(sum, sum, {}, 2, 2, cv::INTER_CUBIC);
  }
  cv::Mat pattern;
  sum.convertTo(pattern, CV_8UC3);
  return pattern;
}

Mesh make_clutter_box(cv::RNG& random, const Eigen::Vector3d& center) {
  const auto uniform = [&](double low, double high) { return random.uniform(low, high); };
  const Eigen::Vector3d half(uniform(0.03, 0.14), uniform(0.03, 0.14), uniform(0.03, 0.10));
  const double turn_x = uniform(-0.7, 0.7), turn_y = uniform(-0.7, 0.7),
               turn_z = uniform(-1.5, 1.5);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(turn_z, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(turn_y, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(turn_x, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.vertices.col(i) = (center + turn * half.cwiseProduct(corner)).cast<float>();
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles.transpose() << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7,
      3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  mesh.uv.resize(2, 4);
  mesh.uv << 0, 1, 1, 0, 0, 0, 1, 1;
  mesh.uv_triangles.resize(3, 12);
  for (int i = 0; i < 12; i += 2) {
    mesh.uv_triangles.col(i) << 0, 1, 2;
    mesh.uv_triangles.col(i + 1) << 0, 2, 3;
  }
  mesh.texture = make_pattern(random, 256);
  return mesh;
}

}  // namespace hypotrack::synthetic
