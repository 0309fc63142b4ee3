#include "scene/visible_share.hpp"

#include <algorithm>
#include <cmath>

#include "camera/lens/distort.hpp"
#include "camera/lens/distortion.hpp"
#include "scene/point_block.hpp"

namespace hypotrack::internal {
namespace {

void distort(const Camera& camera, const float* k, BlockArray& x, BlockArray& y) {
  if (camera.distortion_model == DistortionModel::none) return;
  if (camera.distortion_model == DistortionModel::brown) {
    BlockArray xd;
    BlockArray yd;
    if (has_prisms_or_tilt(camera))
      distort_full(k, x, y, xd, yd);
    else
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

}  // namespace

VisibleShare::VisibleShare(std::span<const Camera> cameras, const IdealRig& rig) {
  const Eigen::Isometry3d world_from_first = rig.ideal_from_world.at(0).inverse();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& camera = cameras[i];
    SeenBy& view = views_.emplace_back();
    view.camera = camera;
    view.camera_from_ideal = rig.camera_from_ideal.at(i);
    view.camera_from_first =
        (camera.camera_from_world * world_from_first).matrix().topRows<3>().cast<float>();
    std::ranges::transform(distortion_coefficients(camera), view.distortion.begin(),
                           [](double k) { return static_cast<float>(k); });
    view.fx = static_cast<float>(camera.fx);
    view.fy = static_cast<float>(camera.fy);
    view.cx = static_cast<float>(camera.cx);
    view.cy = static_cast<float>(camera.cy);
    view.right = static_cast<float>(camera.width) - 0.5f;
    view.bottom = static_cast<float>(camera.height) - 0.5f;
  }
}

/// Clears the mask of a block's vertices that an image does not show. Returns false if any lies
/// behind the camera.
bool VisibleShare::keep_shown(const SeenBy& view, const ScenePoser& vertices, std::size_t first,
                              Eigen::Array<bool, kBlock, 1>& mask) {
  const PointBlock points = point_block(vertices, first, view.camera_from_first);
  if (!(points.z > 0.0f).all()) return false;
  BlockArray x = points.x / points.z;
  BlockArray y = points.y / points.z;
  distort(view.camera, view.distortion.data(), x, y);
  x = x * view.fx + view.cx;
  y = y * view.fy + view.cy;
  if (!(x + y).allFinite()) return false;
  mask = mask && x >= -0.5f && y >= -0.5f && x < view.right && y < view.bottom;
  return true;
}

/// Returns true only if every vertex is surely shown; in most frames this saves the count.
bool VisibleShare::shown_entirely(const PosedScene& scene) const {
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!surely_shown(views_[i].camera, views_[i].camera_from_ideal, scene.bounds()[i]))
      return false;
  }
  return true;
}

double VisibleShare::of(const PosedScene& scene) const {
  if (!scene.in_front()) return 0;  // no tile exists for this state
  if (shown_entirely(scene)) return 1;
  Eigen::Index visible = 0;
  Eigen::Index all = 0;
  for (const ScenePlan::Part& part : scene.plan().parts) {
    if (scene.leaves_out(part)) continue;
    for (std::size_t i = 0; i < part.vertex_count; i += kBlock) {
      Eigen::Array<bool, kBlock, 1> mask = Eigen::Array<bool, kBlock, 1>::Constant(true);
      for (const SeenBy& view : views_) {
        if (!keep_shown(view, scene.vertices(), part.first_vertex + i, mask)) return 0;
      }
      const auto filled =
          std::min<Eigen::Index>(kBlock, static_cast<Eigen::Index>(part.vertex_count - i));
      visible += mask.head(filled).count();
      all += filled;
    }
  }
  return all == 0 ? 0 : static_cast<double>(visible) / static_cast<double>(all);
}

}  // namespace hypotrack::internal
