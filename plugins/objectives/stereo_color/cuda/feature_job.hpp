#pragma once

#include <cstdint>

#include "color-inl.hpp"
#include "distinctiveness-inl.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "settings.hpp"

/// The three kernels that turn two tiles into features, and their intermediate data:
///   textures        pixels -> norm and ratio of every pixel, and a histogram of each over buckets
///   select_medians  -> the medians of the valid pixels
///   features        -> channels and weight
/// Each kernel takes both views in one launch. The sources are compiled without fused
/// multiply-adds, so that everything up to the medians has the CPU's bits.
namespace hypotrack::stereo_color {

/// Three channels and the weight of a pixel as 16-bit fractions (pack_unorm16).
struct alignas(8) PackedFeatures {
  std::uint32_t channels_01, channel_2_weight;
};

/// The bits of a norm or ratio, which have the order of their values. kNoKey, above all of them,
/// marks an invalid pixel.
using Key = std::uint32_t;
inline constexpr Key kNoKey = 0x7FFFFFFFu;
/// A key's bucket is its upper bits: exponent and three bits of mantissa.
inline constexpr int kBucketShift = 20;
inline constexpr int kBuckets = 2048;
inline constexpr int kQuantities = 2;  // norm, ratio

/// One view; everything is in device memory.
struct ViewJob {
  cuda::TileLayout tile;
  Key* keys[kQuantities];    ///< per pixel, aligned to 16 bytes
  std::uint32_t* counts;     ///< valid pixels per quantity and bucket; zero between frames
  MedianPair* medians;       ///< per quantity; zero if no pixel is valid
  PackedFeatures* features;  ///< per pixel
  std::int32_t masked;       ///< whether background weighs nothing
};

struct FeatureJob {
  ViewJob views[2];
  ColorSpace color_space;
  float gray_weight;      ///< if color_space is rgb
  std::int32_t weighted;  ///< by distinctiveness; otherwise all weights are 1, and the first two
                          ///< kernels do not run
  float w_t;
  const LabNode* lab_nodes;  ///< if color_space is lab

  int widest() const {
    const int a = views[0].tile.width, b = views[1].tile.width;
    return a < b ? b : a;
  }
  int highest() const {
    const int a = views[0].tile.height, b = views[1].tile.height;
    return a < b ? b : a;
  }
};

/// Enqueues a kernel. With `overlap` it may start early (hypotrack/gpu/runtime.cuh).
void enqueue_textures(const FeatureJob& job, cuda::Stream stream, bool overlap);
void enqueue_medians(const FeatureJob& job, cuda::Stream stream, bool overlap);
void enqueue_features(const FeatureJob& job, cuda::Stream stream, bool overlap);

}  // namespace hypotrack::stereo_color
