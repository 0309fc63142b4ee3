#include <memory>

#include "cuda/device_foreground.hpp"
#include "cuda/skin_term.cuh"
#include "hypotrack/gpu/pixel_objective.cuh"
#include "settings.hpp"

namespace hypotrack::skin {
namespace {

class DeviceSkin final : public cuda::PixelObjective<SkinTerm> {
 public:
  explicit DeviceSkin(const Settings& settings) : settings_(settings), foreground_(settings) {}

 private:
  SkinTerm make_term(const cuda::DeviceObservation& observation, cuda::Stream stream) override {
    foreground_.enqueue(observation, stream);
    SkinTerm term{};
    for (int i = 0; i < cuda::kMaxViews; ++i) {
      term.foreground[i] = foreground_.pixels(i);
      term.width[i] = observation.tiles[static_cast<std::size_t>(i)].layout.width;
      if (!term.foreground[i]) continue;
      term.view_bits |= 1 << i;
      ++term.view_count;
    }
    term.uncovered = foreground_.sum();
    term.spill = static_cast<float>(settings_.spill);
    return term;
  }

  Settings settings_;
  DeviceForeground foreground_;
};

}  // namespace

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings) {
  return std::make_unique<DeviceSkin>(settings);
}

const char* capabilities() { return "device residuals slopes device_residuals"; }

}  // namespace hypotrack::skin
