#include "output/run/worst_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "hypotrack/api/media.hpp"
#include "output/recording/image_writer.hpp"

namespace hypotrack::internal {
namespace {

bool is_less_bad(const WorstFrame& a, const WorstFrame& b) { return a.error < b.error; }

/// Returns whether two frames compete for the same place.
bool share_a_place(int a, int b) { return a / WorstFrames::kApart == b / WorstFrames::kApart; }

}  // namespace

bool WorstFrames::wants(int frame, double error) const {
  if (std::isnan(error) || count_ == 0) return false;
  for (const WorstFrame& kept : candidates_)
    if (share_a_place(kept.frame, frame)) return error > kept.error;
  return candidates_.size() < places() ||
         error > std::min_element(candidates_.begin(), candidates_.end(), is_less_bad)->error;
}

void WorstFrames::offer(WorstFrame frame) {
  std::erase_if(candidates_,
                [&](const WorstFrame& kept) { return share_a_place(kept.frame, frame.frame); });
  if (candidates_.size() == places())
    candidates_.erase(std::min_element(candidates_.begin(), candidates_.end(), is_less_bad));
  candidates_.push_back(std::move(frame));
}

std::vector<WorstFrame> WorstFrames::frames() const {
  std::vector<WorstFrame> sorted = candidates_, chosen;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return is_less_bad(b, a); });
  for (const WorstFrame& candidate : sorted) {
    const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](const WorstFrame& worse) {
      return std::abs(worse.frame - candidate.frame) < kApart;
    });
    if (!is_near && chosen.size() < static_cast<std::size_t>(count_)) chosen.push_back(candidate);
  }
  return chosen;
}

void WorstFrames::write(OutputContext& run) const {
  for (const WorstFrame& worst : frames()) {
    const cv::Mat picture = draw_comparison(
        run.renderer(), worst.picture, run.cameras().front(), worst.solution, worst.truth,
        fmt::format("frame {}   {:.1f} mm off   {}", worst.frame, 1000 * worst.error,
                    worst.status));
    const auto file = run.file(fmt::format("worst_{}.jpg", worst.frame));
    write_picture(file, picture, {cv::IMWRITE_JPEG_QUALITY, 90});
  }
}

}  // namespace hypotrack::internal
