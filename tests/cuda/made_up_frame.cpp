#include "made_up_frame.hpp"

#include <cmath>
#include <random>

namespace hypotrack::test {
namespace {

cv::Vec3b color_at(Texture texture, int x, int y, std::mt19937& random) {
  const auto byte = [](double value) { return cv::saturate_cast<uchar>(value); };
  switch (texture) {
    case Texture::noise:
      return {byte(random() % 256), byte(random() % 256), byte(random() % 256)};
    case Texture::waves:
      return {byte(128 + 90 * std::sin(0.31 * x + 0.11 * y) + random() % 8),
              byte(128 + 90 * std::sin(0.17 * y - 0.05 * x) + random() % 8),
              byte(128 + 90 * std::cos(0.23 * x + 0.07 * x * y / 64.0))};
    case Texture::flat:
      break;
  }
  return {40, 90, 160};
}

void choose_valid(cv::Mat1b& valid, int count, std::mt19937& random) {
  const auto size = static_cast<std::uint32_t>(valid.total());
  if (count < 0) {  // an edge of the image, and holes
    valid = uchar{255};
    valid.colRange(0, valid.cols / 8) = uchar{0};
    for (std::uint32_t i = 0; i < size / 50; ++i) valid.data[random() % size] = 0;
    return;
  }
  valid = uchar{0};
  for (int placed = 0; placed < count;) {
    uchar& pixel = valid.data[random() % size];
    if (pixel == 0) ++placed;
    pixel = 255;
  }
}

/// A pixel as layout.hpp has it.
std::uint32_t packed(const TileView& view, int y, int x) {
  std::uint32_t word = 0;
  if (view.valid.at<uchar>(y, x) != 0) {
    word |= cuda::kValidFlag;
    if (!view.mask.empty() && view.mask.at<uchar>(y, x) != 0) word |= cuda::kForegroundFlag;
  }
  if (view.color.empty()) return word;
  const auto& p = view.color.at<cv::Vec3b>(y, x);
  return word | p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
}

template <class T>
const T* upload(cuda::DeviceBuffer<T>& to, const std::vector<T>& from, cuda::Stream stream) {
  to.reserve(from.size());
  cuda::check(cudaMemcpyAsync(to.data(), from.data(), from.size() * sizeof(T),
                              cudaMemcpyHostToDevice, cuda::native(stream)),
              "uploading a tile");
  return to.data();
}

}  // namespace

TileView made_up_view(const ViewOptions& options) {
  std::mt19937 random(options.seed);
  TileView view;
  view.camera.width = options.width;
  view.camera.height = options.height;
  cv::Mat3b color(options.height, options.width);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) color(y, x) = color_at(options.texture, x, y, random);
  }
  view.color = color;
  cv::Mat1b valid(options.height, options.width);
  choose_valid(valid, options.valid_pixels, random);
  view.valid = valid;
  if (options.mask) {
    cv::Mat1b mask(options.height, options.width);
    for (uchar& pixel : mask) pixel = random() % 3 == 0 ? 0 : 255;
    view.mask = mask;
  }
  return view;
}

DeviceFrame::DeviceFrame(const Observation& observation, cuda::Stream stream) {
  observation_.header = &observation;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    const int width = view.camera.width, height = view.camera.height;
    cuda::DeviceTile& tile = observation_.tiles[i];
    std::vector<std::uint32_t> words;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) words.push_back(packed(view, y, x));
    tile.layout = {width, height, upload(pixels_[i], words, stream), nullptr};
    tile.has_color = !view.color.empty();
    tile.has_mask = !view.mask.empty();
    if (view.depth.empty()) continue;
    const auto* first = view.depth.ptr<float>();
    tile.layout.depth =
        upload(depth_[i], std::vector<float>(first, first + view.depth.total()), stream);
  }
  cuda::check(cudaStreamSynchronize(cuda::native(stream)), "uploading a tile");
}

}  // namespace hypotrack::test
