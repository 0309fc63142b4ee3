#include "cuda/device_foreground.hpp"

#include "color_learner.hpp"
#include "cuda/foreground_job.hpp"
#include "rule.hpp"

namespace hypotrack::skin {
namespace {

/// A tile's colours and valid pixels, in host memory.
struct FetchedTile {
  cv::Mat3b color;
  cv::Mat1b valid;
};

FetchedTile fetch(const cuda::TileLayout& tile, cuda::Stream stream) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(tile.width) *
                                   static_cast<std::size_t>(tile.height));
  cuda::check(cudaMemcpyAsync(words.data(), tile.pixels, words.size() * sizeof(std::uint32_t),
                              cudaMemcpyDeviceToHost, cuda::native(stream)),
              "fetching a tile");
  cuda::check(cudaStreamSynchronize(cuda::native(stream)), "fetching a tile");
  FetchedTile out{cv::Mat3b(tile.height, tile.width), cv::Mat1b(tile.height, tile.width)};
  std::size_t i = 0;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x, ++i) {
      out.color(y, x) = {static_cast<uchar>(words[i]), static_cast<uchar>(words[i] >> 8),
                         static_cast<uchar>(words[i] >> 16)};
      out.valid(y, x) = words[i] & cuda::kValidFlag ? 255 : 0;
    }
  }
  return out;
}

}  // namespace

struct DeviceForeground::View {
  explicit View(const Settings& settings) : colors(settings) {}

  void learn(const Observation& header, const TileCamera& camera, const cuda::TileLayout& tile,
             cuda::Stream stream) {
    if (!colors.wants(header)) return;
    const FetchedTile fetched = fetch(tile, stream);
    colors.learn(header, camera, fetched.color, fetched.valid);
    probabilities.reserve(kBins);
    cuda::check(
        cudaMemcpyAsync(probabilities.data(), colors.probabilities().data(), kBins * sizeof(float),
                        cudaMemcpyHostToDevice, cuda::native(stream)),
        "uploading the colours of the foreground");
    if (colors.frequencies().empty()) return;
    frequencies.reserve(kBins);
    cuda::check(cudaMemcpyAsync(frequencies.data(), colors.frequencies().data(),
                                kBins * sizeof(ColorFrequency), cudaMemcpyHostToDevice,
                                cuda::native(stream)),
                "uploading the colours of the foreground");
  }

  /// Uploads what the pixels show without the models; returns null where nothing is known.
  const std::uint32_t* upload(const cv::Mat& known, cuda::Stream stream) {
    if (known.empty()) return nullptr;
    background.reserve(known.total());
    cuda::check(
        cudaMemcpyAsync(background.data(), known.data, known.total() * sizeof(std::uint32_t),
                        cudaMemcpyHostToDevice, cuda::native(stream)),
        "uploading the background");
    return background.data();
  }

  ColorLearner colors;
  cuda::DeviceBuffer<float> probabilities;
  cuda::DeviceBuffer<ColorFrequency> frequencies;
  cuda::DeviceBuffer<std::uint32_t> background;
  cuda::DeviceBuffer<std::uint32_t> pixels;
};

DeviceForeground::DeviceForeground(const Settings& settings) : settings_(settings) {}
DeviceForeground::~DeviceForeground() = default;

void DeviceForeground::enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream) {
  check(observation, settings_.foreground);
  const Observation& header = *observation.header;
  while (views_.size() < header.views.size()) {
    views_.push_back(std::make_unique<View>(settings_));
  }
  sum_.reserve(1);
  pixels_ = {};
  ForegroundJob job{};
  job.sum = sum_.data();
  for (std::size_t i = 0; i < header.views.size(); ++i) {
    const cuda::TileLayout& tile = observation.tiles[i].layout;
    const Rule rule = rule_of(settings_.foreground, observation.tiles[i]);
    if (rule == Rule::none) continue;
    View& view = *views_[i];
    const TileCamera& camera = header.views[i].camera;
    if (rule == Rule::color) view.learn(header, camera, tile, stream);
    view.pixels.reserve(static_cast<std::size_t>(tile.width) *
                        static_cast<std::size_t>(tile.height));
    pixels_[i] = view.pixels.data();
    DepthRange range;
    if (rule == Rule::depth) range = depth_range(header, camera, settings_.range);
    const std::uint32_t* background = view.upload(header.views[i].background, stream);
    job.views[static_cast<std::size_t>(job.view_count++)] = {tile,
                                                             rule,
                                                             range,
                                                             view.probabilities.data(),
                                                             view.frequencies.data(),
                                                             background,
                                                             view.pixels.data()};
  }
  enqueue_foreground(job, stream);
}

}  // namespace hypotrack::skin
