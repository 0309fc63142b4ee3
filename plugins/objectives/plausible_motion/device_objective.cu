#include <algorithm>
#include <utility>

#include "hypotrack/gpu/state_objective.cuh"
#include "motion_term.hpp"

namespace hypotrack::plausible_motion {
namespace {

/// Uploads the residuals of every frame to the GPU.
class OnDevice final : public cuda::StateObjective<MotionTerm> {
 public:
  explicit OnDevice(TermOfFrame term_of_frame)
      : StateObjective(MotionTerm{}), term_of_frame_(std::move(term_of_frame)) {}

 private:
  MotionTerm make_term(const cuda::DeviceObservation& observation, cuda::Stream stream) override {
    const MotionTerm host = term_of_frame_(*observation.header);
    const auto count = static_cast<std::size_t>(host.count);
    residuals_.reserve(count);
    staging_.reserve(count);
    std::copy_n(host.residuals, count, staging_.data());
    cuda::check(cudaMemcpyAsync(residuals_.data(), staging_.data(), count * sizeof(LinearResidual),
                                cudaMemcpyHostToDevice, cuda::native(stream)),
                "uploading a frame's residuals");
    return {host.count, residuals_.data()};
  }

  TermOfFrame term_of_frame_;
  cuda::DeviceBuffer<LinearResidual> residuals_;
  cuda::PinnedBuffer<LinearResidual> staging_;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> on_device(TermOfFrame term_of_frame) {
  return std::make_unique<OnDevice>(std::move(term_of_frame));
}

const char* capabilities() { return "device residuals jacobian device_residuals"; }

}  // namespace hypotrack::plausible_motion
