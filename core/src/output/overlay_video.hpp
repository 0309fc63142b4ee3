#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// overlay.mp4: every frame's solution drawn on the first view.
class HYPOTRACK_API OverlayVideo {
 public:
  /// The scene must outlive the video. Throws DeviceError without OpenGL, OutputError if the video
  /// cannot be opened.
  OverlayVideo(const std::filesystem::path& file, const Scene& scene, const Camera& camera,
               double frame_rate);

  void add(const Frame& frame, const Solution& solution);
  void close() { writer_.release(); }

 private:
  const Scene* scene_;
  Camera camera_;
  Renderer renderer_;
  cv::VideoWriter writer_;
};

}  // namespace hypotrack
