#include "hypotrack/truth.hpp"

#include <array>

#include "hypotrack/tables.hpp"

namespace hypotrack {

TruthTables::TruthTables(const TruthSettings& settings, const Scene& scene) {
  if (!settings.states.empty()) {
    for (StateRow& row : read_states(settings.states, scene)) {
      frames_[row.frame - settings.offset].state = std::move(row.state);
    }
  }
  if (!settings.landmarks.empty()) {
    constexpr std::array<double, 3> kMetresPerUnit = {1.0, 1e-2, 1e-3};
    const LandmarkTableOptions options = {
        .metres_per_unit = kMetresPerUnit[static_cast<std::size_t>(settings.units)],
        .rename = settings.rename};
    for (LandmarkRow& row : read_landmarks(settings.landmarks, scene.landmark_names(), options)) {
      frames_[row.frame - settings.offset].landmarks = std::move(row.landmarks);
    }
  }
}

std::optional<GroundTruth> TruthTables::at(int number) const {
  const auto it = frames_.find(number);
  if (it == frames_.end()) return std::nullopt;
  return it->second;
}

}  // namespace hypotrack
