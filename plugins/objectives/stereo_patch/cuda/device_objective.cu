#include <cmath>
#include <memory>

#include "cuda/device_volume.hpp"
#include "cuda/patch_term.cuh"
#include "hypotrack/gpu/pixel_objective.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_patch {
namespace {

class DeviceStereoPatch final : public cuda::PixelObjective<PatchTerm> {
 public:
  explicit DeviceStereoPatch(const Settings& settings) : settings_(settings), volume_(settings) {}

 private:
  PatchTerm make_term(const cuda::DeviceObservation& observation, cuda::Stream stream) override {
    volume_.enqueue(observation, stream);
    PatchTerm term{};
    term.words = volume_.words();
    term.planes = volume_.planes();
    const cuda::DeviceTile& left = observation.tiles[0];
    term.pixels = left.layout.pixels;
    term.counting =
        cuda::kValidFlag | (settings_.use_mask && left.has_mask ? cuda::kForegroundFlag : 0);
    term.share = static_cast<float>(share_of(settings_, *observation.header));
    term.root = std::sqrt(term.share);
    term.width = observation.tiles[0].layout.width;
    term.tolerance = static_cast<float>(settings_.r);
    return term;
  }

  Settings settings_;
  DeviceVolume volume_;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings) {
  return std::make_unique<DeviceStereoPatch>(settings);
}

const char* capabilities() { return "device residuals slopes device_residuals"; }

}  // namespace hypotrack::stereo_patch
