#include "cuda/device_volume.hpp"

#include "cuda/fill_job.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

void DeviceVolume::enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream) {
  const Observation& header = *observation.header;
  const cuda::DeviceTile& left = observation.tiles[0];
  const cuda::DeviceTile& right = observation.tiles[1];
  check_color_pair("stereo_patch", header, {left.has_color, right.has_color});
  FillJob job{};
  job.left = left.layout;
  job.right = right.layout;
  job.map = stereo_map(header, 0, 1);
  job.planes = planes_around(header, settings_);
  job.measure = settings_.measure;
  job.radius = settings_.radius;
  job.sharpness = static_cast<float>(settings_.sharpness);
  job.variance_floor = static_cast<float>(settings_.variance_floor);
  job.masked = settings_.use_mask && left.has_mask;
  words_.reserve(static_cast<std::size_t>(job.planes.count) *
                 static_cast<std::size_t>(job.left.width) *
                 static_cast<std::size_t>(job.left.height));
  planes_.reserve(1);
  job.similarities = reinterpret_cast<std::uint16_t*>(words_.data());
  job.known_planes = planes_.data();
  enqueue_fill(job, stream);
}

}  // namespace hypotrack::stereo_patch
