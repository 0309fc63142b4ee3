#include "stage/background.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/renderer.hpp"
#include "stage/surfaces.hpp"

namespace hypotrack::synthetic {
namespace {

/// Returns the part of the plane z = distance that the cameras may see, with a margin for lens
/// distortion.
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

/// Puts the picture on the wall, cropped to the cameras' view rather than stretched.
std::vector<Mesh> image_meshes(const BackgroundParams& params, Eigen::AlignedBox2d wall) {
  if (params.file.empty()) {
    throw ConfigError(
        "a background of the kind image needs `file`: the picture to put on the wall");
  }
  cv::Mat image;
  if (std::filesystem::is_regular_file(params.file)) {
    image = read_image(params.file.string(), cv::IMREAD_COLOR);
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

/// Adds dark, flat boards in front of the wall, like a switched-off screen or an open door.
void add_dark_regions(const BackgroundParams& params, const Eigen::AlignedBox2d& wall,
                      std::vector<Mesh>& meshes) {
  cv::RNG random(static_cast<std::uint64_t>(params.seed) * 6961 + 29);
  for (int i = 0; i < params.dark_regions; ++i) {
    const double share = random.uniform(0.90, 0.98);  // of the wall's distance
    const Eigen::Vector2d place(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9));
    const Eigen::Vector2d size(random.uniform(0.15, 0.4), random.uniform(0.25, 0.7));
    const Eigen::Vector2d center = wall.min() + place.cwiseProduct(wall.sizes());
    const Eigen::Vector2d half = 0.5 * size.cwiseProduct(wall.sizes());
    Mesh board = make_wall({share * (center - half), share * (center + half)},
                           share * params.distance, cv::Mat());
    board.color.setConstant(static_cast<float>(random.uniform(8., 20.) / 255));
    meshes.push_back(std::move(board));
  }
}

std::vector<Mesh> surfaces_of(const BackgroundParams& params, const Eigen::AlignedBox2d& wall) {
  std::vector<Mesh> meshes = params.kind == BackgroundKind::image ? image_meshes(params, wall)
                                                                  : procedural_meshes(params, wall);
  add_dark_regions(params, wall, meshes);
  return meshes;
}

/// Draws surfaces over pictures, with their depth.
void draw_over(std::vector<RenderedView>& views, std::vector<Mesh> meshes,
               const std::vector<Camera>& cameras, const RenderStyle& style) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  for (Mesh& mesh : meshes) {
    models.emplace_back(fmt::format("background_{}", models.size()),
                        std::make_shared<Model>(rigid_model(std::move(mesh))));
  }
  const Scene scene(std::move(models));
  Renderer renderer(scene);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    RenderedView drawn = renderer.render(scene.rest_state(), cameras[i], style, views[i].color);
    views[i].depth.copyTo(drawn.depth, drawn.label == 0);
    views[i] = std::move(drawn);
  }
}

}  // namespace

Backgrounds::Backgrounds(const BackgroundParams& params, const std::vector<Camera>& cameras,
                         const RenderStyle& light, const Eigen::Vector3d& skin,
                         const std::string& where)
    : cameras_(cameras) {
  const bool surfaces = params.kind != BackgroundKind::color;
  const cv::Scalar bgr(params.color.z(), params.color.y(), params.color.x());
  for (const Camera& c : cameras) {
    const cv::Size size(c.width, c.height);
    views_.push_back({cv::Mat(size, CV_8UC3, surfaces ? cv::Scalar() : bgr),
                      cv::Mat::zeros(size, CV_32FC1),
                      {}});
  }
  if (surfaces) layers_.push_back({surfaces_of(params, seen_wall(cameras, params.distance)), {}});
  if (!params.person) return;
  if (surfaces && params.person->distance >= params.distance) {
    throw ConfigError(
        fmt::format("{}: background.person.distance_mm is {:.6g}, expected less than that of the "
                    "wall, {:.6g}",
                    where, params.person->distance / kMillimetre, params.distance / kMillimetre));
  }
  layers_.push_back({make_person(*params.person, skin, where), light});
}

const std::vector<RenderedView>& Backgrounds::views() {
  for (; !layers_.empty(); layers_.erase(layers_.begin()))
    draw_over(views_, layers_.front().meshes, cameras_, layers_.front().style);
  return views_;
}

}  // namespace hypotrack::synthetic
