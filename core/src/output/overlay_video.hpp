#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack {

/// Writes overlay.mp4: every frame's solution drawn on the first view.
class HYPOTRACK_API OverlayVideo {
 public:
  /// The scene and its renderer must outlive the video. Throws OutputError if the video cannot be
  /// opened.
  OverlayVideo(const std::filesystem::path& file, const Scene& scene, Renderer& renderer,
               const Camera& camera, double frame_rate);

  void add(const Frame& frame, const Solution& solution);
  void close() { writer_.release(); }

 private:
  const Scene* scene_;
  Renderer* renderer_;
  Camera camera_;
  cv::VideoWriter writer_;
};

}  // namespace hypotrack
