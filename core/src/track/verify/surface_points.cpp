#include "track/verify/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hypotrack::internal {
namespace {

double fraction(double x) { return x - std::floor(x); }

double area_of(const Eigen::Vector3d& ab, const Eigen::Vector3d& ac) {
  return ab.cross(ac).norm() / 2;
}

/// Returns how many pixels of the texture's side are as long as a metre of the surface, on average.
double pixels_per_metre(const Mesh& mesh) {
  double surface = 0, texture = 0;
  const Eigen::Vector3d size(mesh.texture.cols, mesh.texture.rows, 0);
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices.col(mesh.triangles(k, i)).cast<double>();
    };
    const auto pixel = [&](int k) -> Eigen::Vector3d {
      const Eigen::Vector2d uv = mesh.uv.col(mesh.uv_triangles(k, i)).cast<double>();
      return Eigen::Vector3d(uv.x(), uv.y(), 0).cwiseProduct(size);
    };
    surface += area_of(corner(1) - corner(0), corner(2) - corner(0));
    texture += area_of(pixel(1) - pixel(0), pixel(2) - pixel(0));
  }
  return surface > 0 ? std::sqrt(texture / surface) : 0;
}

}  // namespace

SurfacePoints spread_points(const Mesh& mesh, Eigen::Index count) {
  std::vector<double> area_up_to;  // and with each triangle
  double area = 0;
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(triangle[0]);
    const Eigen::Vector3f ab = mesh.vertices.col(triangle[1]) - a;
    const Eigen::Vector3f ac = mesh.vertices.col(triangle[2]) - a;
    area += double{ab.cross(ac).norm()};
    area_up_to.push_back(area);
  }
  SurfacePoints out;
  if (!(area > 0)) return out;
  out.area = area / 2;
  out.corners.resize(3, count);
  out.weights.resize(3, count);
  out.triangles.resize(count);
  // Steps of the generalised golden ratio fill a square evenly (Roberts, "The unreasonable
  // effectiveness of quasirandom sequences", 2018).
  constexpr double kStep1 = 0.7548776662466927, kStep2 = 0.5698402909980532;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double at = area * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const auto triangle = std::ranges::lower_bound(area_up_to, at) - area_up_to.begin();
    out.triangles[i] = static_cast<int>(triangle);
    out.corners.col(i) = mesh.triangles.col(triangle).template cast<int>();
    double u = fraction(kStep1 * static_cast<double>(i)),
           v = fraction(kStep2 * static_cast<double>(i));
    if (u + v > 1) u = 1 - u, v = 1 - v;
    out.weights.col(i) = Eigen::Vector3d(1 - u - v, u, v).cast<float>();
  }
  return out;
}

Mesh take_corners(const Mesh& mesh, SurfacePoints& points) {
  std::vector<int> kept;
  std::vector<int> number(static_cast<std::size_t>(mesh.vertices.cols()), -1);
  for (int& corner : points.corners.reshaped()) {
    int& own = number[static_cast<std::size_t>(corner)];
    if (own < 0) {
      own = static_cast<int>(kept.size());
      kept.push_back(corner);
    }
    corner = own;
  }
  Mesh out;
  out.vertices = mesh.vertices(Eigen::all, kept);
  out.bone_indices = mesh.bone_indices(Eigen::all, kept);
  out.bone_weights = mesh.bone_weights(Eigen::all, kept);
  return out;
}

Eigen::Matrix3Xf positions(const SurfacePoints& points, const Eigen::Matrix3Xf& vertices) {
  Eigen::Matrix3Xf out(3, points.count());
  for (Eigen::Index i = 0; i < points.count(); ++i)
    out.col(i) = vertices(Eigen::all, points.corners.col(i)) * points.weights.col(i);
  return out;
}

std::vector<cv::Vec3f> texture_colors(const Mesh& mesh, const SurfacePoints& points, double side) {
  std::vector<cv::Vec3f> out;
  if (mesh.texture.empty() || mesh.uv_triangles.cols() == 0) return out;
  const int window = std::max(1, cvRound(side * pixels_per_metre(mesh)));
  cv::Mat3b texture;
  cv::blur(mesh.texture, texture, {window, window}, {-1, -1}, cv::BORDER_REPLICATE);
  for (Eigen::Index i = 0; i < points.count(); ++i) {
    const Eigen::Vector2f uv =
        mesh.uv(Eigen::all, mesh.uv_triangles.col(points.triangles[i])) * points.weights.col(i);
    const auto at = [](float share, int size) {
      return std::clamp(static_cast<int>(share * static_cast<float>(size)), 0, size - 1);
    };
    out.push_back(texture(at(1 - uv.y(), texture.rows), at(uv.x(), texture.cols)));
  }
  return out;
}

}  // namespace hypotrack::internal
