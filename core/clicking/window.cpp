#include "clicking/window.hpp"

#include <algorithm>
#include <opencv2/highgui.hpp>

namespace hypotrack::clicking {
namespace {

/// Clicks since the last look.
struct Mouse {
  std::vector<cv::Point> clicks;
  static void on_event(int event, int x, int y, int /*flags*/, void* self) {
    if (event == cv::EVENT_LBUTTONDOWN) static_cast<Mouse*>(self)->clicks.emplace_back(x, y);
  }
};

bool is_open(const std::string& title) {
  return cv::getWindowProperty(title, cv::WND_PROP_VISIBLE) >= 1;
}

}  // namespace
}  // namespace hypotrack::clicking

extern "C" __attribute__((visibility("default"))) void hypotrack_show_window(
    const hypotrack::clicking::WindowContent& content) {
  using namespace hypotrack::clicking;
  constexpr int kMilliseconds = 30, kWidest = 1800;
  Mouse mouse;
  cv::namedWindow(content.title, cv::WINDOW_NORMAL | cv::WINDOW_KEEPRATIO | cv::WINDOW_GUI_NORMAL);
  cv::Mat picture = content.picture();
  const double scale = std::min(1.0, static_cast<double>(kWidest) / picture.cols);
  cv::resizeWindow(content.title, cvRound(scale * picture.cols), cvRound(scale * picture.rows));
  cv::setMouseCallback(content.title, Mouse::on_event, &mouse);
  cv::imshow(content.title, picture);
  for (bool go_on = true; go_on;) {
    const int key = cv::waitKey(kMilliseconds);
    if (!is_open(content.title)) return;
    if (key < 0 && mouse.clicks.empty()) continue;
    for (const cv::Point& at : mouse.clicks) content.on_click(at);
    mouse.clicks.clear();
    if (key >= 0) go_on = content.on_key(static_cast<char>(key & 0xff));
    if (go_on) cv::imshow(content.title, content.picture());
  }
  cv::destroyWindow(content.title);
}
