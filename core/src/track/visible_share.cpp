#include "track/visible_share.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "evaluate/point_block.hpp"
#include "evaluate/scene_poser.hpp"
#include "geometry/distort.hpp"
#include "geometry/distortion.hpp"

namespace hypotrack {
namespace {

using Mask = Eigen::Array<bool, kBlock, 1>;

struct SeenBy {
  Eigen::Matrix<float, 3, 4> camera_from_first;
  DistortionModel model;
  std::array<float, 8> distortion;
  float fx, fy, cx, cy;
  float right, bottom;  // the image's ends
};

SeenBy seen_by(const Camera& camera, const Eigen::Isometry3d& first_from_world) {
  SeenBy view{};
  const Eigen::Isometry3d camera_from_first = camera.camera_from_world * first_from_world.inverse();
  view.camera_from_first = camera_from_first.matrix().topRows<3>().cast<float>();
  view.model = camera.distortion_model;
  std::ranges::transform(distortion_coefficients(camera), view.distortion.begin(),
                         [](double k) { return static_cast<float>(k); });
  view.fx = static_cast<float>(camera.fx);
  view.fy = static_cast<float>(camera.fy);
  view.cx = static_cast<float>(camera.cx);
  view.cy = static_cast<float>(camera.cy);
  view.right = static_cast<float>(camera.width) - 0.5f;
  view.bottom = static_cast<float>(camera.height) - 0.5f;
  return view;
}

void distort(DistortionModel model, const float* k, BlockArray& x, BlockArray& y) {
  if (model == DistortionModel::none) return;
  if (model == DistortionModel::brown) {
    BlockArray xd;
    BlockArray yd;
    distort_brown(k, x, y, xd, yd);
    x = xd;
    y = yd;
    return;
  }
  const BlockArray r = (x * x + y * y).sqrt();
  const BlockArray factor = r.unaryExpr([k](float one) { return fisheye_factor(k, one); });
  x *= factor;
  y *= factor;
}

/// Leaves the vertices of a block that an image shows; false if any lies behind the camera.
bool keep_shown(const SeenBy& view, const PointBlock& points, Mask& mask) {
  if (!(points.z > 0.0f).all()) return false;
  BlockArray x = points.x / points.z;
  BlockArray y = points.y / points.z;
  distort(view.model, view.distortion.data(), x, y);
  x = x * view.fx + view.cx;
  y = y * view.fy + view.cy;
  if (!(x + y).allFinite()) return false;
  mask = mask && x >= -0.5f && y >= -0.5f && x < view.right && y < view.bottom;
  return true;
}

}  // namespace

struct VisibleShare::Impl {
  Impl(const Scene& scene, std::span<const Camera> cameras)
      : plan(scene), poser(plan), first_from_world(cameras[0].camera_from_world) {
    for (const Camera& camera : cameras) views.push_back(seen_by(camera, first_from_world));
  }

  ScenePlan plan;
  ScenePoser poser;
  Eigen::Isometry3d first_from_world;
  std::vector<SeenBy> views;
};

VisibleShare::VisibleShare(const Scene& scene, std::span<const Camera> cameras)
    : impl_(std::make_unique<Impl>(scene, cameras)) {}
VisibleShare::~VisibleShare() = default;

double VisibleShare::of(const Eigen::VectorXd& state) {
  Impl& self = *impl_;
  self.poser.pose({state.data(), static_cast<std::size_t>(state.size())}, self.first_from_world);
  Eigen::Index visible = 0;
  Eigen::Index all = 0;
  for (const ScenePlan::Part& part : self.plan.parts) {
    for (std::size_t i = 0; i < part.vertex_count; i += kBlock) {
      Mask mask = Mask::Constant(true);
      for (const SeenBy& view : self.views) {
        const auto points = point_block(self.poser, part.first_vertex + i, view.camera_from_first);
        if (!keep_shown(view, points, mask)) return 0;  // no tile can be cut around this state
      }
      const auto filled =
          std::min<Eigen::Index>(kBlock, static_cast<Eigen::Index>(part.vertex_count - i));
      visible += mask.head(filled).count();
      all += filled;
    }
  }
  return all == 0 ? 0 : static_cast<double>(visible) / static_cast<double>(all);
}

}  // namespace hypotrack
