#include "geometry/tiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "geometry/rectification.hpp"
#include "geometry/resample.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/kinematics.hpp"

namespace hypotrack {
namespace {

constexpr float kNearest = 1e-3f;      // metres in front of a camera that everything must be
constexpr double kLargestZoom = 16.0;  // tile pixels per image pixel

/// Bounds of the posed scene on the plane z = 1 of an ideal camera.
struct Bounds {
  float x0 = std::numeric_limits<float>::infinity();
  float x1 = -x0;
  float y0 = x0;
  float y1 = -x0;

  double width() const { return double{x1} - x0; }
  double height() const { return double{y1} - y0; }
};

void extend(Bounds& bounds, const Eigen::Isometry3d& ideal_from_world,
            const Eigen::Matrix3Xf& vertices, std::size_t view, const std::string& model) {
  const Eigen::Matrix3f rotation = ideal_from_world.linear().cast<float>();
  const Eigen::Vector3f translation = ideal_from_world.translation().cast<float>();
  const Eigen::Array3Xf p = ((rotation * vertices).colwise() + translation).array();
  if (!p.allFinite() || p.row(2).minCoeff() < kNearest) {
    throw DataError(
        fmt::format("model '{}' lies at or behind camera {} (nearest vertex at z = {:.3g} m); "
                    "expected a pose in front of every camera",
                    model, view, p.row(2).minCoeff()));
  }
  const Eigen::ArrayXf x = p.row(0) / p.row(2);
  const Eigen::ArrayXf y = p.row(1) / p.row(2);
  bounds.x0 = std::min(bounds.x0, x.minCoeff());
  bounds.x1 = std::max(bounds.x1, x.maxCoeff());
  bounds.y0 = std::min(bounds.y0, y.minCoeff());
  bounds.y1 = std::max(bounds.y1, y.maxCoeff());
}

/// The pinhole camera whose square image is `extent` wide on the plane z = 1 around a centre.
TileCamera tile_camera(int size, double extent, double centre_x, double centre_y,
                       const Eigen::Isometry3d& ideal_from_world) {
  TileCamera camera;
  camera.width = size;
  camera.height = size;
  camera.fx = size / extent;
  camera.fy = camera.fx;
  camera.cx = 0.5 * (size - 1) - camera.fx * centre_x;
  camera.cy = 0.5 * (size - 1) - camera.fy * centre_y;
  camera.camera_from_world = ideal_from_world;
  return camera;
}

void check_image(const cv::Mat& image, int type, const char* what, const char* expected,
                 const Camera& camera, const std::string& where) {
  if (image.cols != camera.width || image.rows != camera.height) {
    throw DataError(
        fmt::format("{}: the {} is {}x{} pixels, its camera {}x{}; expected the same size", where,
                    what, image.cols, image.rows, camera.width, camera.height));
  }
  if (image.type() != type) {
    throw DataError(fmt::format("{}: the {} is of OpenCV type {}; expected {}", where, what,
                                cv::typeToString(image.type()), expected));
  }
}

void check_view(const View& view, const Camera& camera, const Frame& frame, std::size_t index) {
  const std::string where = fmt::format("frame {}, view {}", frame.index, index);
  if (view.color.empty() && view.depth.empty()) {
    throw DataError(where + ": there is neither colour nor depth; expected at least one of them");
  }
  const auto check = [&](const cv::Mat& image, int type, const char* what, const char* expected) {
    if (!image.empty()) check_image(image, type, what, expected, camera, where);
  };
  check(view.color, CV_8UC3, "image", "8-bit BGR");
  check(view.mask, CV_8UC1, "mask", "8 bits and one channel");
  check(view.depth, CV_32FC1, "depth image", "metres as 32-bit floats, one channel");
}

}  // namespace

struct TileMaker::Impl {
  Impl(const Scene& scene_in, std::vector<Camera> cameras_in, const TileSettings& settings_in)
      : scene(scene_in), cameras(std::move(cameras_in)), settings(settings_in) {
    if (cameras.empty()) throw DataError("the source has no cameras; expected at least one");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      validate(cameras[i], fmt::format("camera {}", i));
    }
    rig = make_ideal_rig(cameras);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      resamplers.emplace_back(cameras[i], rig.camera_from_ideal[i]);
    }
  }

  std::vector<Bounds> bounds(const Eigen::VectorXd& state) const;
  std::vector<TileCamera> crop(const Eigen::VectorXd& state) const;

  const Scene& scene;
  std::vector<Camera> cameras;
  TileSettings settings;
  IdealRig rig;
  std::vector<Resampler> resamplers;
};

std::vector<Bounds> TileMaker::Impl::bounds(const Eigen::VectorXd& state) const {
  std::vector<Bounds> all(cameras.size());
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      extend(all[i], rig.ideal_from_world[i], vertices, i, item.name);
    }
  }
  return all;
}

std::vector<TileCamera> TileMaker::Impl::crop(const Eigen::VectorXd& state) const {
  std::vector<Bounds> all = bounds(state);
  std::vector<double> extents;
  for (const Bounds& b : all) extents.push_back(std::max(b.width(), b.height()));
  if (rig.rectified) {
    // y/z agrees in both views up to rounding; the same bounds make rows and scales identical.
    all[0].y0 = all[1].y0 = std::min(all[0].y0, all[1].y0);
    all[0].y1 = all[1].y1 = std::max(all[0].y1, all[1].y1);
    extents[0] = extents[1] = std::max({extents[0], extents[1], all[0].height()});
  }
  double sharpest = 0;
  for (const Camera& camera : cameras) sharpest = std::max({sharpest, camera.fx, camera.fy});
  std::vector<TileCamera> tiles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double extent = std::max(extents[i] * (1 + 2 * settings.padding),
                                   settings.size / (kLargestZoom * sharpest));
    tiles.push_back(tile_camera(settings.size, extent, 0.5 * (double{all[i].x0} + all[i].x1),
                                0.5 * (double{all[i].y0} + all[i].y1), rig.ideal_from_world[i]));
  }
  return tiles;
}

TileMaker::TileMaker(const Scene& scene, std::vector<Camera> cameras, const TileSettings& settings)
    : impl_(std::make_unique<Impl>(scene, std::move(cameras), settings)) {}
TileMaker::~TileMaker() = default;

bool TileMaker::rectifies() const { return impl_->rig.rectified; }

Observation TileMaker::make(const Frame& frame, const Eigen::VectorXd& state) const {
  const Impl& self = *impl_;
  if (frame.views.size() != self.cameras.size()) {
    throw DataError(fmt::format("frame {} has {} views; expected {}, one per camera", frame.index,
                                frame.views.size(), self.cameras.size()));
  }
  for (std::size_t i = 0; i < frame.views.size(); ++i) {
    check_view(frame.views[i], self.cameras[i], frame, i);
  }
  const std::vector<TileCamera> tiles = self.crop(state);
  std::vector<ImageMap> maps;
  for (std::size_t i = 0; i < tiles.size(); ++i) maps.push_back(self.resamplers[i].map(tiles[i]));

  Observation observation;
  observation.frame = frame.index;
  observation.time = frame.time;
  observation.scene = &self.scene;
  observation.start = state;
  observation.rectified = self.rig.rectified;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    // A pair is compared pixel by pixel: both views must be smoothed the same way.
    const double scale =
        self.rig.rectified ? std::sqrt(maps[0].scale * maps[1].scale) : maps[i].scale;
    observation.views.push_back(
        self.resamplers[i].cut(frame.views[i], tiles[i], maps[i], plan_reduction(scale)));
  }
  return observation;
}

}  // namespace hypotrack
