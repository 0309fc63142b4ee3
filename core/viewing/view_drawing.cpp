#include "viewing/view_drawing.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/overlay.hpp"

namespace hypotrack {

Camera fitted(Camera camera, cv::Size limit) {
  const double scale = std::min(static_cast<double>(limit.width) / camera.width,
                                static_cast<double>(limit.height) / camera.height);
  camera.width = std::max(1, cvRound(camera.width * scale));
  camera.height = std::max(1, cvRound(camera.height * scale));
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5;
  return camera;
}

cv::Mat joined(const std::vector<cv::Mat>& pictures, ViewLayout layout) {
  const bool row = layout == ViewLayout::row;
  cv::Size size;
  for (const cv::Mat& picture : pictures) {
    size.width = row ? size.width + picture.cols : std::max(size.width, picture.cols);
    size.height = row ? std::max(size.height, picture.rows) : size.height + picture.rows;
  }
  cv::Mat out = cv::Mat::zeros(size, CV_8UC3);
  cv::Point at;
  for (const cv::Mat& picture : pictures) {
    picture.copyTo(out(cv::Rect(at, picture.size())));
    (row ? at.x : at.y) += row ? picture.cols : picture.rows;
  }
  return out;
}

std::vector<cv::Mat> draw_views(Renderer& renderer, const Scene& scene, const ShownViews& shown,
                                const std::vector<Camera>& cameras) {
  std::vector<cv::Mat> out;
  for (std::size_t i = 0; i < shown.images.size(); ++i) {
    const cv::Size size(cameras[i].width, cameras[i].height);
    const bool enlarges = size.width > shown.images[i].cols;
    cv::Mat image;
    cv::resize(shown.images[i], image, size, 0, 0, enlarges ? cv::INTER_LINEAR : cv::INTER_AREA);
    out.push_back(
        draw_overlay(renderer, scene, image, cameras[i], shown.state, {.hidden = shown.hidden}));
  }
  return out;
}

void yield_to_others() {
  constexpr int kNice = 10;
  // Linux has a nice value per thread, set by the thread's id in place of a process's.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace hypotrack
