#include "lab/live/view_pictures.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "hypotrack/overlay.hpp"
#include "hypotrack/picture.hpp"

namespace hypotrack {
namespace {

/// Scales a camera so that its image is at most `width` wide.
Camera fitted(Camera camera, int width) {
  if (camera.width <= width) return camera;
  const double scale = static_cast<double>(width) / camera.width;
  camera.height = std::max(1, cvRound(camera.height * scale));
  camera.width = width;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5;
  return camera;
}

/// Puts pictures beside or below each other, on black where their sizes differ.
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

std::string jpeg(const cv::Mat& picture) {
  constexpr int kQuality = 80;
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return {bytes.begin(), bytes.end()};
}

}  // namespace

ViewPictures::~ViewPictures() { close(); }

void ViewPictures::begin(const Scene& scene, std::vector<Camera> cameras) {
  scene_ = &scene;
  cameras_ = std::move(cameras);
  renderer_ = std::make_unique<Renderer>(scene);
  thread_ = std::thread([this] {
    try {
      draw_all();
    } catch (const std::exception& e) {
      say_(std::string("no more pictures: ") + e.what());
    }
  });
}

void ViewPictures::show(const Frame& frame, const Solution& solution) {
  if (frame.views.empty()) return;
  Shown shown;
  for (const View& view : frame.views) shown.images.push_back(picture_of(view).clone());
  shown.state = solution.state;
  for (const Status status : solution.models)
    shown.hidden.push_back(status == Status::lost || status == Status::absent);
  newest_.put(std::move(shown));
}

bool ViewPictures::write(const std::filesystem::path& file) {
  const auto newest = newest_.get();
  if (newest.number == 0) return false;
  const cv::Mat picture =
      joined(drawn(*newest.value, std::numeric_limits<int>::max()), ViewLayout::row);
  try {
    return cv::imwrite(file.string(), picture);
  } catch (const cv::Exception&) {
    return false;
  }
}

void ViewPictures::end() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
  renderer_.reset();
}

void ViewPictures::close() {
  end();
  for (PictureChannel& each : channels_) each.pictures.close();
}

std::vector<cv::Mat> ViewPictures::drawn(const Shown& shown, int width) {
  const std::lock_guard lock(drawing_);
  std::vector<cv::Mat> out;
  for (std::size_t i = 0; i < shown.images.size(); ++i) {
    const Camera camera = fitted(cameras_[i], width);
    cv::Mat image;
    cv::resize(shown.images[i], image, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
    out.push_back(
        draw_overlay(*renderer_, *scene_, image, camera, shown.state, {.hidden = shown.hidden}));
  }
  return out;
}

void ViewPictures::draw_all() {
  constexpr int kWidth = 640;
  constexpr std::chrono::milliseconds kPeriod{20};
  std::array<std::uint64_t, 2> sent{};
  std::uint64_t seen = 0;
  std::vector<cv::Mat> views;
  std::uint64_t drawn_number = 0;
  while (!ending_) {
    const auto newest = newest_.wait_after(seen, kPeriod);
    for (const ViewLayout layout : {ViewLayout::row, ViewLayout::column}) {
      const auto i = static_cast<std::size_t>(layout);
      if (newest.number == sent[i] || channels_[i].watchers == 0) continue;
      if (newest.number != drawn_number) {
        views = drawn(*newest.value, kWidth);
        drawn_number = newest.number;
      }
      channels_[i].pictures.put(jpeg(joined(views, layout)));
      sent[i] = newest.number;
    }
    seen = newest.number;
  }
}

}  // namespace hypotrack
