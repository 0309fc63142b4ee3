#include "track/occlude/hidden_views.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

bool covers(const HiddenPart& part, const Eigen::Vector3d& world) {
  const Eigen::Vector3d p = part.camera.camera_from_world * world;
  if (!(p.z() > 0)) return false;
  const int x = cvRound(part.camera.fx * p.x() / p.z() + part.camera.cx);
  const int y = cvRound(part.camera.fy * p.y() / p.z() + part.camera.cy);
  return cv::Rect({}, part.mask.size()).contains({x, y}) && part.mask(y, x) != 0;
}

}  // namespace

cv::Mat1b HiddenViews::in_tile(std::size_t view, const TileCamera& tile) const {
  cv::Mat1b out;
  if (view >= parts.size()) return out;
  for (const HiddenPart& part : parts[view]) {
    const TileCamera& from = part.camera;  // the tile's camera with another crop and scale
    const double x = from.fx / tile.fx, y = from.fy / tile.fy;
    const cv::Matx23d map(x, 0, from.cx - x * tile.cx, 0, y, from.cy - y * tile.cy);
    cv::Mat1b mask;
    cv::warpAffine(part.mask, mask, map, {tile.width, tile.height},
                   cv::INTER_NEAREST | cv::WARP_INVERSE_MAP);
    out = out.empty() ? mask : cv::Mat1b(out | mask);
  }
  return !out.empty() && cv::countNonZero(out) > 0 ? out : cv::Mat1b();
}

std::vector<bool> HiddenViews::covers(const Eigen::Matrix3Xd& points) const {
  std::vector<bool> out;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    out.push_back(std::ranges::all_of(parts, [&](const std::vector<HiddenPart>& view) {
      return std::ranges::any_of(
          view, [&](const HiddenPart& part) { return internal::covers(part, points.col(i)); });
    }));
  return out;
}

}  // namespace hypotrack::internal
