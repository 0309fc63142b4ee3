#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/source.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Replays frames that were read already, then continues with the rest of a source.
class ReplaySource final : public Source {
 public:
  /// Replays `frames` only, with cameras and frame rate of `from`.
  ReplaySource(const Source& from, std::vector<Frame> frames);
  /// Replays `frames`, then the rest of `from`.
  ReplaySource(std::unique_ptr<Source> from, std::vector<Frame> frames);

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return frame_rate_; }
  std::optional<int> do_frame_count() const override { return count_; }
  std::optional<Frame> do_next() override;
  bool do_live() const override { return live_; }
  std::vector<std::string> do_notes() const override;
  std::vector<std::string> do_statistics() const override;

  std::vector<Camera> cameras_;
  double frame_rate_;
  bool live_;
  std::optional<int> count_;
  std::unique_ptr<Source> rest_;
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

/// Returns the frames of a source before `seconds`, missing ones included. Where a gap lies across
/// that time, the frame behind it is one of them.
std::vector<Frame> first_seconds(Source& source, double seconds);

}  // namespace internal
}  // namespace hypotrack
