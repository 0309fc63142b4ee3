#include <memory>

#include "cuda/depth_term.cuh"
#include "cuda/device_frame.hpp"
#include "hypotrack/gpu/pixel_objective.cuh"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {
namespace {

class DeviceRgbdDepth final : public cuda::PixelObjective<DepthTerm> {
 public:
  explicit DeviceRgbdDepth(const Settings& settings) : settings_(settings), frame_(settings) {}

 private:
  DepthTerm make_term(const cuda::DeviceObservation& observation, cuda::Stream stream) override {
    check(observation, settings_.foreground);
    frame_.enqueue(observation, stream);
    DepthTerm term{};
    for (int i = 0; i < cuda::kMaxViews; ++i) {
      term.observed[i] = frame_.observed(i);
      term.width[i] = observation.tiles[static_cast<std::size_t>(i)].layout.width;
      if (term.observed[i]) term.view_bits |= 1 << i;
    }
    term.d_max = static_cast<float>(settings_.d_max);
    term.d_match = static_cast<float>(settings_.d_match);
    term.counts = frame_.counts();
    term.fingers = frame_.fingers();
    term.finger_count = frame_.finger_count();
    term.weights = {settings_.d_max, settings_.lambda, settings_.lambda_k};
    return term;
  }

  Settings settings_;
  DeviceFrame frame_;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings) {
  return std::make_unique<DeviceRgbdDepth>(settings);
}

const char* capabilities() { return "device residuals device_residuals"; }

}  // namespace hypotrack::rgbd_depth
