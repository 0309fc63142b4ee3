#include "cuda/device_frame.hpp"

#include "finger_pair.hpp"
#include "foreground.hpp"

namespace hypotrack::rgbd_depth {

void DeviceFrame::enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream) {
  const Observation& header = *observation.header;
  counts_.reserve(1);
  ObserveJob job{};
  job.counts = counts_.data();
  views_ = {};
  for (std::size_t i = 0; i < header.views.size(); ++i) {
    const cuda::DeviceTile& tile = observation.tiles[i];
    if (!tile.layout.depth) continue;
    planes_[i].reserve(static_cast<std::size_t>(tile.layout.width) *
                       static_cast<std::size_t>(tile.layout.height));
    views_[i] = planes_[i].data();
    ViewJob& view = job.views[static_cast<std::size_t>(job.view_count++)];
    view = {tile.layout, rule_of(settings_.foreground, tile.has_mask), {}, planes_[i].data()};
    if (view.rule != Rule::mask) {
      view.range =
          depth_range(*header.scene, header.start, header.views[i].camera, settings_.range);
    }
  }
  enqueue_observe(job, stream);
  upload_fingers(header, stream);
}

void DeviceFrame::upload_fingers(const Observation& header, cuda::Stream stream) {
  std::vector<FingerPair> fingers = adjacent_fingers(*header.scene);
  if (fingers == known_fingers_) return;
  fingers_.reserve(fingers.size());
  cuda::check(cudaMemcpyAsync(fingers_.data(), fingers.data(), fingers.size() * sizeof(FingerPair),
                              cudaMemcpyHostToDevice, cuda::native(stream)),
              "uploading the scene's fingers");
  known_fingers_ = std::move(fingers);
}

}  // namespace hypotrack::rgbd_depth
