#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cuda/feature_maps.hpp"
#include "device.hpp"
#include "distinctiveness.hpp"
#include "features.hpp"
#include "made_up_frame.hpp"
#include "params.hpp"

namespace hypotrack::stereo_color {
namespace {

using test::DeviceFrame;
using test::download;
using test::made_up_view;
using test::ViewOptions;

// Two views of different sizes and contents.
Observation pair_of(ViewOptions options) {
  Observation observation;
  observation.views.push_back(made_up_view(options));
  options.width = std::max(2, options.width - 3);
  options.height += 2;
  ++options.seed;
  observation.views.push_back(made_up_view(options));
  return observation;
}

std::size_t size_of(const TileView& view) { return view.color.total(); }

std::vector<PackedFeatures> expected_features(const TileView& view, const Params& params) {
  const Features f = make_features(view, params);
  std::vector<PackedFeatures> out;
  for (int y = 0; y < view.color.rows; ++y) {
    for (int x = 0; x < view.color.cols; ++x) {
      out.push_back({f.channels_01.row(y)[x], f.channel_2_weight.row(y)[x]});
    }
  }
  return out;
}

int apart(std::uint32_t a, std::uint32_t b) {
  return std::abs(static_cast<int>(a) - static_cast<int>(b));
}

// The largest differences in units of the 16-bit packing.
struct Difference {
  int channels = 0, weight = 0;
};

Difference difference(const std::vector<PackedFeatures>& a, const std::vector<PackedFeatures>& b,
                      double w_t) {
  Difference out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto [p, q] = std::pair(a[i], b[i]);
    out.channels = std::max({out.channels, apart(p.channels_01 & 0xFFFF, q.channels_01 & 0xFFFF),
                             apart(p.channels_01 >> 16, q.channels_01 >> 16),
                             apart(p.channel_2_weight & 0xFFFF, q.channel_2_weight & 0xFFFF)});
    const std::uint32_t w = p.channel_2_weight >> 16, v = q.channel_2_weight >> 16;
    // Rounding may lift a weight over the threshold.
    const bool at_threshold = std::min(w, v) == 0 && std::max(w, v) - w_t * 65535 <= 1;
    if (!at_threshold) out.weight = std::max(out.weight, apart(w, v));
  }
  return out;
}

class FeatureMapsTest : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_DEVICE();
    device_ = std::make_unique<cuda::Device>(0);
  }

  std::vector<PackedFeatures> on_device(FeatureMaps& maps, const Observation& observation,
                                        int view) {
    const DeviceFrame frame(observation, device_->stream());
    maps.enqueue(frame.observation(), device_->stream());
    return download(maps.of_view(view), size_of(observation.views[view]), device_->stream());
  }

  void expect_like_the_cpu(FeatureMaps& maps, const Observation& observation,
                           const Params& params) {
    for (int i = 0; i < 2; ++i) {
      const TileView& view = observation.views[static_cast<std::size_t>(i)];
      const Difference d =
          difference(on_device(maps, observation, i), expected_features(view, params), params.w_t);
      // 1 is what rounding can do to a channel or weight before packing.
      EXPECT_LE(d.channels, 1) << view.color.cols << "x" << view.color.rows << " view " << i;
      EXPECT_LE(d.weight, 1) << view.color.cols << "x" << view.color.rows << " view " << i;
    }
  }
  void expect_like_the_cpu(const ViewOptions& options, const Params& params = {}) {
    FeatureMaps maps(params);
    expect_like_the_cpu(maps, pair_of(options), params);
  }

  std::unique_ptr<cuda::Device> device_;
};

constexpr std::pair<int, int> kSizes[] = {{2, 2},     {17, 23},   {33, 9},   {128, 128},
                                          {256, 256}, {500, 300}, {1024, 64}};

TEST_F(FeatureMapsTest, AreTheCpusWithEveryGrayWeight) {
  for (const double weight : {0.0, 0.3, 0.5}) {
    Params params;
    params.gray_weight = weight;
    for (const auto& [width, height] : kSizes) {
      expect_like_the_cpu(
          {.width = width, .height = height, .texture = test::Texture::noise, .mask = false},
          params);
    }
  }
}

TEST_F(FeatureMapsTest, AreTheCpusInEveryColorSpace) {
  for (const auto space : {ColorSpace::rgb, ColorSpace::lab, ColorSpace::hsv, ColorSpace::gray}) {
    Params params;
    params.color_space = space;
    for (const auto& [width, height] : kSizes) {
      for (const bool mask : {false, true}) {
        expect_like_the_cpu(
            {.width = width, .height = height, .texture = test::Texture::noise, .mask = mask},
            params);
      }
    }
  }
}

TEST_F(FeatureMapsTest, AreTheCpusWithAndWithoutDistinctiveness) {
  for (const auto d : {Distinctiveness::principal_curvatures, Distinctiveness::none}) {
    Params params;
    params.distinctiveness = d;
    for (const auto& [width, height] : kSizes) {
      for (const bool use_mask : {false, true}) {
        params.use_mask = use_mask;
        expect_like_the_cpu({.width = width, .height = height, .mask = true}, params);
      }
    }
  }
}

TEST_F(FeatureMapsTest, AreTheCpusForAnyThreshold) {
  for (const double w_t : {0.0, 0.25, 1.0}) {
    Params params;
    params.w_t = w_t;
    expect_like_the_cpu({.texture = test::Texture::noise}, params);
  }
}

TEST_F(FeatureMapsTest, AreTheCpusWhereTheImageIsFlat) {
  for (const auto& [width, height] : kSizes) {
    expect_like_the_cpu({.width = width, .height = height, .texture = test::Texture::flat});
  }
}

TEST_F(FeatureMapsTest, AreTheCpusForFewValidPixels) {
  for (const int count : {0, 1, 2, 3, 4, 100, 101}) {
    expect_like_the_cpu({.texture = test::Texture::noise, .valid_pixels = count});
  }
}

TEST_F(FeatureMapsTest, AreTheCpusForTheLargestTiles) {
  for (const auto texture : {test::Texture::waves, test::Texture::flat, test::Texture::noise}) {
    expect_like_the_cpu({.width = 1024, .height = 1022, .texture = texture});
  }
}

TEST_F(FeatureMapsTest, ForgetTheFrameBefore) {
  const Params params;
  FeatureMaps maps(params);
  for (const int size : {64, 300, 16, 128}) {
    expect_like_the_cpu(maps, pair_of({.width = size, .height = size}), params);
    const auto flat = pair_of({.width = size, .height = size, .texture = test::Texture::flat});
    expect_like_the_cpu(maps, flat, params);
  }
}

TEST_F(FeatureMapsTest, AreTheSameEveryTime) {
  const Observation observation = pair_of({.width = 256, .height = 256});
  FeatureMaps maps{Settings{}};
  const auto bits = [&] {
    std::vector<std::uint64_t> out;
    for (const PackedFeatures& f : on_device(maps, observation, 0)) {
      out.push_back(f.channels_01 | std::uint64_t{f.channel_2_weight} << 32);
    }
    return out;
  };
  const auto first = bits();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(bits(), first);
}

// Norms and ratios of the valid pixels, in order.
std::array<std::vector<float>, kQuantities> sorted_quantities(const TileView& view) {
  const int width = view.color.cols, height = view.color.rows;
  const cv::Mat1b valid_image = view.valid;
  const std::vector<std::uint8_t> valid(valid_image.begin(), valid_image.end());
  std::vector<float> grey;
  for (const cv::Vec3b& p : cv::Mat3b(view.color)) grey.push_back(gray_level({p[0], p[1], p[2]}));
  const Curvatures c = principal_curvatures(grey, valid, width, height);
  std::array<std::vector<float>, kQuantities> out;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (!valid[i]) continue;
    const stereo_color::Texture t = texture({c.major[i], c.minor[i]});
    out[0].push_back(t.norm);
    out[1].push_back(t.ratio);
  }
  for (auto& values : out) std::sort(values.begin(), values.end());
  return out;
}

TEST_F(FeatureMapsTest, FindExactMediansOfOddAndEvenCounts) {
  for (const auto texture : {test::Texture::noise, test::Texture::waves, test::Texture::flat}) {
    for (const int count : {1, 2, 3, 4, 999, 1000, 16000, 16001, 33333, 60000}) {
      const int size = count > 16000 ? 256 : 128;
      const Observation observation =
          pair_of({.width = size, .height = size, .texture = texture, .valid_pixels = count});
      const DeviceFrame frame(observation, device_->stream());
      FeatureMaps maps{Settings{}};
      maps.enqueue(frame.observation(), device_->stream());
      const auto found = download(maps.medians(), 2 * kQuantities, device_->stream());
      for (std::size_t view = 0; view < 2; ++view) {
        const auto expected = sorted_quantities(observation.views[view]);
        for (std::size_t q = 0; q < kQuantities; ++q) {
          const MedianPair median = found[view * kQuantities + q];
          const std::size_t n = expected[q].size();
          EXPECT_EQ(median.low, expected[q][(n - 1) / 2]) << count << " of quantity " << q;
          EXPECT_EQ(median.high, expected[q][n / 2]) << count << " of quantity " << q;
        }
      }
    }
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
