#include "lab/study/quick.hpp"

#include <algorithm>

namespace hypotrack::study::internal {
namespace {

constexpr int kFrames = 10;
constexpr std::size_t kQuickSeeds = 2;

}  // namespace

void make_quick(Study& study) {
  study.frames = std::min(study.frames.value_or(kFrames), kFrames);
  study.seeds.resize(std::min(study.seeds.size(), kQuickSeeds));
  for (Axis& axis : study.axes)
    if (axis.is_key && axis.choices.size() > 2)
      axis.choices.erase(axis.choices.begin() + 1, axis.choices.end() - 1);
}

}  // namespace hypotrack::study::internal
