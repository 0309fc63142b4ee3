#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <string>
#include <thread>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/solution.hpp"
#include "lab/live/latest.hpp"

namespace hypotrack {

/// How the views are put together.
enum class ViewLayout { row, column };

/// JPEG pictures of one layout for those who watch.
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
  void begin(const Scene& scene, std::vector<Camera> cameras);
  /// Takes the newest frame; copies its images.
  void show(const Frame& frame, const Solution& solution);
  /// Writes the newest frame with its solution in full size as PNG. Returns false if that fails or
  /// there is no frame yet.
  bool write(const std::filesystem::path& file);
  /// Stops drawing. The last pictures stay.
  void end();
  /// Ends drawing and what watches the channels.
  void close();

  PictureChannel& channel(ViewLayout layout) { return channels_[static_cast<std::size_t>(layout)]; }

 private:
  struct Shown {
    std::vector<cv::Mat> images;  ///< of all views, 8-bit BGR
    Eigen::VectorXd state;
    std::vector<bool> hidden;
  };

  void draw_all();
  /// Draws the views, each at most `width` pixels wide.
  std::vector<cv::Mat> drawn(const Shown& shown, int width);

  std::function<void(const std::string&)> say_;
  const Scene* scene_ = nullptr;
  std::vector<Camera> cameras_;
  Latest<Shown> newest_;
  std::array<PictureChannel, 2> channels_;
  std::mutex drawing_;
  std::unique_ptr<Renderer> renderer_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace hypotrack
