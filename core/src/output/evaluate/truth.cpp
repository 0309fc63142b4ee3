#include "hypotrack/plugin/truth.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "output/evaluate/true_landmarks.hpp"

namespace hypotrack {

TruthTables::TruthTables(const TruthSettings& settings, const Scene& scene)
    : offset_(settings.offset) {
  for (const auto& file : {settings.states, settings.landmarks})
    if (!file.empty()) files_ += (files_.empty() ? "" : ", ") + file.string();
  if (!settings.states.empty()) {
    for (StateRow& row : read_states(settings.states, scene)) {
      frames_[row.frame - settings.offset].state = std::move(row.state);
    }
  }
  if (!settings.landmarks.empty()) {
    const LandmarkTableOptions options = {.metres_per_unit = metres_per(settings.units),
                                          .rename = settings.rename};
    for (LandmarkRow& row : read_landmarks(settings.landmarks, scene.landmark_names(), options)) {
      GroundTruth& truth = frames_[row.frame - settings.offset];
      truth.absent = absent_models(row, landmark_owners(scene), scene.items().size());
      truth.landmarks = std::move(row.landmarks);
    }
  }
}

std::optional<GroundTruth> TruthTables::at(int number) const {
  const auto it = frames_.find(number);
  if (it == frames_.end()) return std::nullopt;
  return it->second;
}

void TruthTables::expect_some(int first, int step, std::optional<int> count) const {
  if (files_.empty() || count == 0) return;
  const auto given = [&](int number) {
    const auto distance = std::int64_t{number} - first;
    return distance >= 0 && distance % step == 0 && (!count || distance / step < *count);
  };
  const auto knows = [](const GroundTruth& truth) {
    return truth.state.size() > 0 || !truth.absent.empty() ||
           !truth.landmarks.array().isNaN().all();
  };
  bool matched = false;
  for (const auto& [number, truth] : frames_) {
    if (!given(number)) continue;
    if (knows(truth)) return;
    matched = true;
  }
  if (matched)
    throw DataError(
        fmt::format("{}: no landmark is known in any of the source's frames; expected columns "
                    "<landmark>_x, _y and _z with numbers (or leave the key out)",
                    files_));
  const std::string has = frames_.empty()
                              ? "no rows"
                              : fmt::format("frames {} to {}", frames_.begin()->first + offset_,
                                            frames_.rbegin()->first + offset_);
  const std::string last =
      count ? fmt::format(" to {}", first + offset_ + (*count - 1) * step) : " on";
  throw DataError(
      fmt::format("{}: has {}, and none of them is one of the source's frames, {}{}{}; set "
                  "truth_offset (now {}), or leave the key out",
                  files_, has, first + offset_, last,
                  step == 1 ? "" : fmt::format(" in steps of {}", step), offset_));
}

}  // namespace hypotrack
