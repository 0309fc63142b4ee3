#include "background.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/renderer.hpp"

namespace hypotrack::synthetic {
namespace {

void bind_to_one_bone(Mesh& mesh) {
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, mesh.vertices.cols());
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, mesh.vertices.cols());
  mesh.bone_weights.row(0).setOnes();
}

/// The part of the plane z = distance that the cameras may see; lenses bend outwards, hence the
/// margin.
Eigen::AlignedBox2d seen_wall(const std::vector<Camera>& cameras, double distance) {
  constexpr double kMargin = 1.3, kSteepest = 0.05;
  Eigen::AlignedBox2d wall;
  for (const Camera& c : cameras) {
    const Eigen::Isometry3d world_from_camera = c.camera_from_world.inverse();
    const double margin = c.distortion_model == DistortionModel::none ? 1.02 : kMargin;
    for (const double x : {-0.5, c.width - 0.5}) {
      for (const double y : {-0.5, c.height - 0.5}) {
        const Eigen::Vector3d ray =
            world_from_camera.linear() *
            Eigen::Vector3d(margin * (x - c.cx) / c.fx, margin * (y - c.cy) / c.fy, 1);
        const double steps = (distance - world_from_camera.translation().z()) / ray.z();
        if (ray.z() < kSteepest * ray.norm() || steps <= 0) continue;
        wall.extend((world_from_camera.translation() + steps * ray).head<2>());
      }
    }
  }
  if (wall.isEmpty()) {
    throw DataError(
        fmt::format("the background's wall, {:.6g} mm along z, is in front of no camera; "
                    "change background.distance_mm or use `kind: color`",
                    distance / kMillimetre));
  }
  return wall;
}

/// A rectangle in the plane z = `distance` whose texture is upright for the cameras.
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
  bind_to_one_bone(mesh);
  return mesh;
}

/// Smooth noise of all scales in three channels about a colour, 8-bit BGR: every octave is half as
/// coarse and weaker than the one before it.
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

/// A box about `center`, turned, all six faces with the same texture.
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
  bind_to_one_bone(mesh);
  return mesh;
}

std::vector<Mesh> procedural_meshes(const BackgroundParams& params,
                                    const Eigen::AlignedBox2d& wall) {
  cv::RNG random(static_cast<std::uint64_t>(params.seed) * 7919 + 17);
  std::vector<Mesh> meshes;
  meshes.push_back(make_wall(wall, params.distance, make_pattern(random, 1024)));
  for (int i = 0; i < params.clutter; ++i) {
    const double share = random.uniform(0.72, 1.0);  // of the wall's distance
    const Eigen::Vector2d place(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
    const Eigen::Vector2d xy = wall.min() + place.cwiseProduct(wall.sizes());
    meshes.push_back(
        make_clutter_box(random, {share * xy.x(), share * xy.y(), share * params.distance}));
  }
  return meshes;
}

/// The picture on the wall, cropped by the cameras' view rather than stretched.
std::vector<Mesh> image_meshes(const BackgroundParams& params, Eigen::AlignedBox2d wall) {
  if (params.file.empty()) {
    throw ConfigError(
        "a background of the kind image needs `file`: the picture to put on the wall");
  }
  cv::Mat image;
  if (std::filesystem::is_regular_file(params.file)) {
    image = cv::imread(params.file.string(), cv::IMREAD_COLOR);
  }
  if (image.empty()) {
    throw DataError(fmt::format("{}: is no readable image; a background needs a PNG or JPEG file",
                                params.file.string()));
  }
  const double metres_per_pixel =
      std::max(wall.sizes().x() / image.cols, wall.sizes().y() / image.rows);
  const Eigen::Vector2d half = 0.5 * metres_per_pixel * Eigen::Vector2d(image.cols, image.rows);
  const Eigen::Vector2d center = wall.center();
  return {make_wall({center - half, center + half}, params.distance, image)};
}

}  // namespace

std::vector<RenderedView> draw_backgrounds(const BackgroundParams& params,
                                           const std::vector<Camera>& cameras) {
  std::vector<RenderedView> views;
  if (params.kind == BackgroundKind::color) {
    const cv::Scalar bgr(params.color.z(), params.color.y(), params.color.x());
    for (const Camera& c : cameras) {
      const cv::Size size(c.width, c.height);
      views.push_back({cv::Mat(size, CV_8UC3, bgr), cv::Mat::zeros(size, CV_32FC1), {}});
    }
    return views;
  }
  const Eigen::AlignedBox2d wall = seen_wall(cameras, params.distance);
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  for (Mesh& mesh : params.kind == BackgroundKind::image ? image_meshes(params, wall)
                                                         : procedural_meshes(params, wall)) {
    models.emplace_back(fmt::format("background_{}", models.size()),
                        std::make_shared<Model>(rigid_model(std::move(mesh))));
  }
  const Scene scene(std::move(models));
  Renderer renderer(scene);
  for (const Camera& c : cameras) views.push_back(renderer.render(scene.rest_state(), c, {}));
  return views;
}

}  // namespace hypotrack::synthetic
