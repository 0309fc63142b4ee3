#include "lab/live/view_pictures.hpp"

#include <algorithm>

#include "hypotrack/api/media.hpp"
#include "viewing/view_drawing.hpp"

namespace hypotrack::internal {
namespace {

std::string jpeg(const cv::Mat& picture) {
  constexpr int kQuality = 80;
  const auto bytes = encode_image(".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return {bytes.begin(), bytes.end()};
}

}  // namespace

ViewPictures::~ViewPictures() { close(); }

void ViewPictures::begin(const Scene& scene, const std::vector<Camera>& cameras) {
  constexpr int kWidth = 640;
  scene_ = &scene;
  for (const Camera& camera : cameras)
    cameras_.push_back(fitted(camera, {std::min(camera.width, kWidth), camera.height}));
  renderer_ = std::make_unique<Renderer>(scene);
  thread_ = std::thread([this] {
    try {
      yield_to_others();
      draw_all();
    } catch (const std::exception& e) {
      say_(std::string("no more pictures: ") + e.what());
    }
  });
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

void ViewPictures::draw_all() {
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
        views = draw_views(*renderer_, *scene_, **newest.value, cameras_);
        drawn_number = newest.number;
      }
      channels_[i].pictures.put(jpeg(joined(views, layout)));
      sent[i] = newest.number;
    }
    seen = newest.number;
  }
}

}  // namespace hypotrack::internal
