#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/source.hpp"
#include "session/frame_clock.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Wraps a plugin's source: names it in what it throws and where it crashes, and checks cameras,
/// frame rate, and every frame's number, pictures and ground truth. Corrects times that do not
/// grow. Errors of sources that come with hypotrack stay as they are.
class CheckedSource final : public Source {
 public:
  /// `plugin`: its place in the scene and name: `a.yaml:2:9: source 'video'`. `who`: its
  /// plugin_label().
  /// Throws DataError, naming the plugin.
  CheckedSource(std::unique_ptr<Source> source, const Scene& scene, std::string plugin,
                std::string who = {});

  const std::vector<Camera>& cameras() const override { return source_->cameras(); }
  double frame_rate() const override { return source_->frame_rate(); }
  std::optional<int> frame_count() const override { return source_->frame_count(); }
  /// Returns the next frame. Throws DataError, naming the plugin and the frame.
  std::optional<Frame> next() override;
  bool live() const override { return source_->live(); }
  std::vector<std::string> notes() const override { return source_->notes(); }
  /// Returns the source's lines; without any, one that it ended before its announced end.
  std::vector<std::string> statistics() const override;

 private:
  std::optional<Frame> ask();
  void check_order(const Frame& frame);
  void check_pictures(const Frame& frame) const;
  void check_truth(const Frame& frame, const char* what, Eigen::Index found,
                   Eigen::Index expected) const;

  std::unique_ptr<Source> source_;
  std::string plugin_, who_;
  Eigen::Index parameters_, landmarks_;
  bool explains_;
  int last_index_ = -1;
  bool stamped_ = false;  ///< frames have Frame::stamp
  int frames_ = 0;        ///< so far
  bool ended_ = false;    ///< by itself
  FrameClock clock_;
};

}  // namespace internal
}  // namespace hypotrack
