#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "viewing/latest.hpp"
#include "viewing/live_frame.hpp"
#include "viewing/view_drawing.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// JPEG pictures of one layout for viewers.
struct PictureChannel {
  Latest<std::string> pictures;
  std::atomic<int> watchers = 0;
};

/// Draws solutions on their views in a thread of its own. It draws the newest frame only, and none
/// while nobody watches. Models whose pose is unknown are left out.
class ViewPictures {
 public:
  /// `say` receives an error that ends the drawing.
  explicit ViewPictures(std::function<void(const std::string&)> say) : say_(std::move(say)) {}
  ~ViewPictures();
  ViewPictures(const ViewPictures&) = delete;
  ViewPictures& operator=(const ViewPictures&) = delete;

  /// Starts to draw. The scene must live until end(). Throws DeviceError without OpenGL.
  void begin(const Scene& scene, const std::vector<Camera>& cameras);
  /// Takes the newest views.
  void show(std::shared_ptr<const ShownViews> views) { newest_.put(std::move(views)); }
  /// Stops drawing. The last pictures stay.
  void end();
  /// Ends drawing and what watches the channels.
  void close();

  PictureChannel& channel(ViewLayout layout) { return channels_[static_cast<std::size_t>(layout)]; }

 private:
  void draw_all();

  std::function<void(const std::string&)> say_;
  const Scene* scene_ = nullptr;
  std::vector<Camera> cameras_;  ///< of the pictures
  Latest<std::shared_ptr<const ShownViews>> newest_;
  std::array<PictureChannel, 2> channels_;
  std::unique_ptr<Renderer> renderer_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace internal
}  // namespace hypotrack
