#include "box_pictures.hpp"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack::contour {
namespace {

constexpr int kSize = 160;

Camera camera(int view) {
  Camera out;
  out.width = out.height = kSize;
  out.fx = out.fy = 420;
  out.cx = (kSize - 1) / 2.0 + (view == 0 ? -25 : 25);
  out.cy = (kSize - 1) / 2.0;
  out.camera_from_world.translation().x() = view == 0 ? 0.03 : -0.03;
  return out;
}

/// Returns a blue picture with many spots of other colours.
cv::Mat3b ground(int view) {
  cv::RNG random(3 + static_cast<std::uint64_t>(view));
  cv::Mat3b out(kSize, kSize, cv::Vec3b(170, 110, 60));
  for (int i = 0; i < 60; ++i)
    cv::circle(
        out, {random.uniform(0, kSize), random.uniform(0, kSize)}, random.uniform(3, 12),
        {random.uniform(90.0, 220.0), random.uniform(60.0, 160.0), random.uniform(20.0, 90.0)},
        cv::FILLED, cv::LINE_AA);
  return out;
}

Scene make_scene() {
  ModelData box = test::make_test_box();
  box.mesh.color = {0.6f, 0.6f, 0.62f};
  return Scene({{"box", std::make_shared<Model>(std::move(box))}});
}

}  // namespace

BoxPictures::BoxPictures() : scene_(make_scene()), renderer_(scene_) {}

Eigen::VectorXd BoxPictures::state() const { return displaced({0, 0, 0}, {0, 0, 0}); }

Eigen::VectorXd BoxPictures::displaced(const Eigen::Vector3d& metres,
                                       const Eigen::Vector3d& turn) const {
  Eigen::Quaterniond q(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 0.4, 0.3).normalized()));
  if (turn.norm() > 0) q = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * q;
  Eigen::VectorXd out(7);
  out << metres + Eigen::Vector3d(0, 0, 0.5), q.w(), q.vec();
  return out;
}

Observation BoxPictures::seen(const Eigen::VectorXd& state, const Eigen::VectorXd& start) {
  Observation out;
  out.scene = &scene_;
  out.start = start;
  const RenderStyle style{.ambient = 0.7, .diffuse = 0.3};
  for (int view = 0; view < 2; ++view) {
    const Camera from = camera(view);
    TileView tile;
    tile.camera = {from.width, from.height,           from.fx, from.fy, from.cx,
                   from.cy,    from.camera_from_world};
    const RenderedView drawn = renderer_.render(state, from, style, ground(view));
    tile.color = drawn.color;
    tile.depth = drawn.depth;
    tile.valid = cv::Mat1b(kSize, kSize, uchar{255});
    out.views.push_back(tile);
  }
  return out;
}

std::unique_ptr<Contour> BoxPictures::objective(double depth_sigma) const {
  Params params;
  params.cache = cache_.path();
  params.views.subdivisions = 3;
  params.depth_sigma = depth_sigma;
  return std::make_unique<Contour>(params, scene_);
}

BoxPictures& box_pictures() {
  static BoxPictures pictures;
  return pictures;
}

double corner_distance_mm(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::Isometry3d to_a = world_from_model({a.data(), 7});
  const Eigen::Isometry3d to_b = world_from_model({b.data(), 7});
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? 0.03 : -0.03, (i & 2) != 0 ? 0.02 : -0.02,
                                 (i & 4) != 0 ? 0.06 : -0.06);
    sum += (to_a * corner - to_b * corner).norm();
  }
  return 1000 * sum / 8;
}

}  // namespace hypotrack::contour
