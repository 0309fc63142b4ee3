#pragma once

#include <memory>
#include <span>

#include "base/exported.hpp"
#include "cost/cuda/tiles/load_balance.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Resamples tiles on the GPU; the pixels equal those of TileMaker::resample up to rounding.
class TileResampler {
 public:
  /// Takes TileMaker::resamplers(). Throws DeviceError on more than kMaxViews cameras, or if there
  /// is not enough memory. It needs 4 bytes per pixel of every camera's image. The frames' images
  /// need their size on the device and in page-locked memory.
  TileResampler(std::span<const Resampler> cameras, const DeviceLimits& limits);
  ~TileResampler();
  TileResampler(const TileResampler&) = delete;
  TileResampler& operator=(const TileResampler&) = delete;

  /// Enqueues the upload of the image parts that the plan needs, and the resampling kernels. Does
  /// not wait, and allocates nothing after the first frame. All work of the previous call must have
  /// been waited for.
  /// Page-locked images are copied directly and must live until the work is done. Tiles keep their
  /// addresses as long as the tile size stays the same. The observation's header is the plan's.
  DeviceObservation resample(const Frame& frame, const TilePlan& plan, Stream stream,
                             const BandEnds& bands = even_bands());

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
