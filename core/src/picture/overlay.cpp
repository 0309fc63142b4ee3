#include "hypotrack/api/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "picture/flat_drawer.hpp"

namespace hypotrack {
namespace {

/// Shading by a light beside the camera, so that the relief is visible from every viewpoint.
RenderStyle shaded_for(const Camera& camera) {
  RenderStyle style;
  style.textured = false;
  style.ambient = 0.35;
  style.diffuse = 0.85;
  style.specular = 0.15;
  style.light_direction =
      camera.camera_from_world.linear().transpose() * Eigen::Vector3d(0.35, 0.45, 1.0);
  return style;
}

/// Outlines one model of a label image; `roi` is its non-empty part.
void draw_contours(const cv::Mat& label, const cv::Rect& roi, int model, int thickness,
                   const cv::Scalar& color, cv::Mat& image) {
  cv::Mat inside;
  cv::compare(label(roi), model + 1, inside, cv::CMP_EQ);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(inside, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE, roi.tl());
  std::erase_if(contours, [](const auto& contour) { return contour.size() < 16; });  // specks
  cv::polylines(image, contours, true, color, thickness, cv::LINE_AA);
}

/// Darkens the rims where a part of a model occludes another part of it.
void draw_rims(const RenderedView& view, const cv::Rect& roi, cv::Mat& image) {
  constexpr float kJump = 0.006F;  // metres from pixel to pixel
  const auto jumps = [&](cv::Point a, cv::Point b) {
    return view.label.at<unsigned char>(a) == view.label.at<unsigned char>(b) &&
           std::abs(view.depth.at<float>(a) - view.depth.at<float>(b)) > kJump;
  };
  for (int y = roi.y; y + 1 < roi.y + roi.height; ++y) {
    for (int x = roi.x; x + 1 < roi.x + roi.width; ++x) {
      const cv::Point here(x, y);
      if (view.label.at<unsigned char>(here) == 0) continue;
      if (jumps(here, {x + 1, y}) || jumps(here, {x, y + 1})) {
        image.at<cv::Vec3b>(here) = image.at<cv::Vec3b>(here) * 0.35;
      }
    }
  }
}

cv::Scalar bgr(const Eigen::Vector3f& rgb, float lighten) {
  const Eigen::Vector3f mixed = 255.0F * (rgb + lighten * (Eigen::Vector3f::Ones() - rgb));
  return {mixed.z(), mixed.y(), mixed.x()};
}

}  // namespace

cv::Mat draw_overlay(Renderer& renderer, const Scene& scene, const cv::Mat& image,
                     const Camera& camera, const Eigen::VectorXd& state,
                     const OverlayStyle& style) {
  RenderStyle shaded = shaded_for(camera);
  shaded.hidden = style.hidden;
  const RenderedView view = renderer.render(state, camera, shaded, image);
  cv::Mat result = image.clone();
  const cv::Rect roi = cv::boundingRect(view.label);
  if (roi.empty()) return result;
  cv::Mat drawn = result(roi);
  cv::addWeighted(view.color(roi), style.opacity, drawn, 1 - style.opacity, 0, drawn);
  if (!style.contours) return result;
  const int thickness = std::max(1, cvRound(std::max(camera.width, camera.height) / 900.0));
  const int models = static_cast<int>(scene.items().size());
  draw_rims(view, roi, result);
  for (int i = 0; i < models; ++i) {  // a dark halo keeps the line readable on bright ground
    draw_contours(view.label, roi, i, thickness + 2, cv::Scalar(20, 20, 20), result);
  }
  for (int i = 0; i < models; ++i) {
    draw_contours(view.label, roi, i, thickness, bgr(flat_color(i), 0.45F), result);
  }
  return result;
}

}  // namespace hypotrack
