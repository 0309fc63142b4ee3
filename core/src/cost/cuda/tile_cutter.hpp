#pragma once

#include <memory>
#include <span>

#include "cost/cuda/work_of_rows.hpp"
#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::cuda {

/// Cuts tiles on the device, as TileMaker::cut does on the CPU: the same pixels but for rounding.
class HYPOTRACK_API TileCutter {
 public:
  /// `cameras` are TileMaker::resamplers(). Throws DeviceError on more than kMaxViews of them, or
  /// if the memory is not to be had: 4 bytes per pixel of every camera's image, and what the images
  /// take that frames bring, on the device and as page-locked memory.
  TileCutter(std::span<const Resampler> cameras, const DeviceLimits& limits);
  ~TileCutter();
  TileCutter(const TileCutter&) = delete;
  TileCutter& operator=(const TileCutter&) = delete;

  /// Enqueues the upload of what the plan touches of the frame's images, and the kernels that make
  /// tiles of it. Does not wait, and allocates nothing after the first frame. Everything that the
  /// call before enqueued must have been waited for. Images in page-locked memory are copied from
  /// where they are: they must stay until the work is done. The tiles lie where they did as long as
  /// the tile size stays the same. The observation's header is the plan's.
  DeviceObservation cut(const Frame& frame, const TilePlan& plan, Stream stream,
                        const WorkEnds& work = even_work());

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack::cuda
