#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "base/exported.hpp"
#include "cost/cuda/descend/descent_kernels.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/linearize/device_linearizer.hpp"
#include "cost/cuda/repeated_work.hpp"
#include "hypotrack/gpu/device_cost.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// An event of a stream.
class StreamEvent {
 public:
  StreamEvent();
  ~StreamEvent();
  StreamEvent(const StreamEvent&) = delete;
  StreamEvent& operator=(const StreamEvent&) = delete;

  void record(Stream stream);
  /// Waits until the stream has come to the record. Throws DeviceError if its work failed.
  void wait() const;

 private:
  cudaEvent_t event_ = nullptr;
};

/// Runs searches by damped least squares whose steps stay on the GPU. The host enqueues a step
/// while the one before it runs. It reads only whether searches have ended.
class DeviceDescent {
 public:
  /// Both must outlive it.
  DeviceDescent(FrameOnDevice& frame, DeviceLinearizer& linearizer)
      : frame_(frame), linearizer_(linearizer) {}

  /// Returns whether run() can make these searches. `rotation_vectors`: there is a prior.
  bool can_run(const DampedSettings& settings, std::int32_t dimension, std::size_t searches,
               bool rotation_vectors);
  /// Searches as DescentCost::descend(). `prior` is a state in device memory that rotation vectors
  /// apply to, or null.
  void run(const DampedSettings& settings, std::int32_t dimension, std::span<Descent> searches,
           const double* prior, const std::function<bool()>& ends);

 private:
  std::int64_t trials() const { return std::int64_t{job_.searches} * job_.trials; }
  void reserve(const DampedSettings& settings, std::int32_t dimension, std::size_t searches);
  void upload(std::span<const Descent> searches);
  void enqueue_step();
  void enqueue_evaluation();
  void enqueue_linearization();
  bool all_ended() const;
  void read(std::span<Descent> searches) const;
  /// Makes room for so many objects. Counts the revision if memory moves, or would.
  template <class Buffer>
  auto grow(Buffer& buffer, std::int64_t size) {
    if (static_cast<std::size_t>(size) > buffer.size()) ++revision_;
    buffer.reserve(static_cast<std::size_t>(size));
    return buffer.data();
  }

  FrameOnDevice& frame_;
  DeviceLinearizer& linearizer_;
  DescentJob job_{};
  RepeatedWork evaluations_, linearizations_;
  std::uint64_t revision_ = 0;  // changes whenever memory below moves
  std::array<StreamEvent, 2> step_ends_;
  PinnedBuffer<double> regions_staging_, answer_points_;
  PinnedBuffer<DescentAnswer> answers_;
  DeviceBuffer<double> regions_, points_, trial_states_, centres_;
  DeviceBuffer<double> costs_, posed_costs_;  // of trial states; of centres and neighbours, unused
  DeviceBuffer<DescentState> states_;
  DeviceBuffer<float> per_step_, blurs_;
  DeviceBuffer<std::int32_t> rests_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
