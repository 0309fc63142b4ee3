#include "viewing/preview.hpp"

#include <fmt/format.h>

#include <atomic>
#include <future>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "hypotrack/api/renderer.hpp"
#include "viewing/preview_picture.hpp"
#include "viewing/view_drawing.hpp"
#include "window/window.hpp"

namespace hypotrack {
namespace {

class Preview final : public Viewer {
 public:
  Preview(RunControls& controls, ShowWindow show_window,
          std::function<void(const std::string&)> warn)
      : controls_(controls), show_window_(show_window), warn_(std::move(warn)) {}
  ~Preview() override {
    closing_ = true;
    if (thread_.joinable()) thread_.join();
  }

  void open(const Scene& scene, const std::vector<Camera>& cameras) override;
  void begin(std::optional<int> frames) override {
    change([&] { text_.frames = frames; });
  }
  void frame(const LiveFrame& frame) override {
    change([&] { text_.newest = frame; });
  }
  void set_status(const LiveStatus& status) override {
    change([&] { text_.status = status; });
  }
  void say(const std::string& text) override {
    change([&] { text_.message = text; });
  }
  void end() override {
    const std::lock_guard lock(drawing_);
    renderer_.reset();
  }

 private:
  template <class Change>
  void change(const Change& make) {
    const std::lock_guard lock(mutex_);
    make();
    changed_ = true;
  }

  void show();
  WindowStep take_key(char key);
  WindowStep next();
  cv::Mat picture(cv::Size area);

  RunControls& controls_;
  ShowWindow show_window_;
  std::function<void(const std::string&)> warn_;
  const Scene* scene_ = nullptr;
  std::vector<Camera> cameras_;
  std::mutex drawing_;                  ///< of `renderer_`
  std::unique_ptr<Renderer> renderer_;  ///< null after the run
  std::mutex mutex_;                    ///< of `text_` and `changed_`
  PreviewText text_;
  bool changed_ = false;
  std::vector<cv::Mat> views_;  ///< as they were drawn last
  std::atomic<bool> closing_ = false;
  std::thread thread_;
};

void Preview::open(const Scene& scene, const std::vector<Camera>& cameras) {
  scene_ = &scene;
  cameras_ = cameras;
  for (const Scene::Item& item : scene.items()) text_.models.push_back(item.name);
  std::promise<void> ready;
  std::future<void> opened = ready.get_future();
  thread_ = std::thread([this, ready = std::move(ready)]() mutable {
    yield_to_others();
    try {
      renderer_ = std::make_unique<Renderer>(*scene_);
      ready.set_value();
    } catch (...) {
      ready.set_exception(std::current_exception());
      return;
    }
    show();
  });
  opened.get();
}

void Preview::show() {
  WindowContent content;
  content.title = "hypotrack run";
  content.size = preview_size(cameras_, text_.models.size(), screen_size());
  content.picture = [this](cv::Size area) { return picture(area); };
  content.on_key = [this](char key) { return take_key(key); };
  content.next = [this] { return next(); };
  try {
    show_window_(content);
    if (!closing_) controls_.ask_for_end();
  } catch (const std::exception& e) {
    if (closing_) return;
    controls_.resume();
    warn_(fmt::format("warning: the run goes on without a preview: {}", e.what()));
  }
}

WindowStep Preview::take_key(char key) {
  const PreviewKey pressed = preview_key(key);
  press(controls_, pressed);
  if (pressed == PreviewKey::none) return WindowStep::wait;
  change([&] {
    text_.message.clear();
    if (pressed == PreviewKey::help) text_.help = !text_.help;
    if (pressed == PreviewKey::end) text_.message = "the run ends";
  });
  return WindowStep::redraw;
}

WindowStep Preview::next() {
  if (closing_) return WindowStep::close;
  const std::lock_guard lock(mutex_);
  return std::exchange(changed_, false) ? WindowStep::redraw : WindowStep::wait;
}

cv::Mat Preview::picture(cv::Size area) {
  PreviewText text;
  {
    const std::lock_guard lock(mutex_);
    text = text_;
  }
  const std::lock_guard lock(drawing_);
  if (renderer_ && text.newest && text.newest->views)
    views_ = draw_views(*renderer_, *scene_, *text.newest->views,
                        preview_cameras(cameras_, text.models.size(), area));
  return preview_picture(views_, text, area);
}

}  // namespace

std::unique_ptr<Viewer> make_preview(RunControls& controls, ShowWindow show_window,
                                     std::function<void(const std::string&)> warn) {
  return std::make_unique<Preview>(controls, show_window, std::move(warn));
}

}  // namespace hypotrack
