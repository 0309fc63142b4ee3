#include "window/window.hpp"

#include <algorithm>
#include <opencv2/highgui.hpp>
#include <utility>
#include <vector>

namespace hypotrack {
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

/// Returns the size of the pictures' area of a window.
cv::Size area_of(const std::string& title) {
  constexpr int kSmallest = 64;
  const cv::Size size = cv::getWindowImageRect(title).size();
  return {std::max(size.width, kSmallest), std::max(size.height, kSmallest)};
}

/// Opens a window of the size that the content or its first picture asks for.
void open(const WindowContent& content) {
  constexpr double kWidest = 1800;
  const bool fills = !content.size.empty();
  cv::namedWindow(content.title, cv::WINDOW_NORMAL | cv::WINDOW_GUI_NORMAL |
                                     (fills ? cv::WINDOW_FREERATIO : cv::WINDOW_KEEPRATIO));
  cv::Size size = content.size;
  if (!fills) {
    const cv::Mat picture = content.picture({});
    const double scale = std::min(1.0, kWidest / picture.cols);
    size = {cvRound(scale * picture.cols), cvRound(scale * picture.rows)};
  }
  cv::resizeWindow(content.title, size.width, size.height);
}

}  // namespace
}  // namespace hypotrack

extern "C" __attribute__((visibility("default"))) void hypotrack_show_window(
    const hypotrack::WindowContent& content) {
  using namespace hypotrack;
  constexpr int kMilliseconds = 30;
  Mouse mouse;
  open(content);
  if (content.on_click) cv::setMouseCallback(content.title, Mouse::on_event, &mouse);
  cv::Size area = area_of(content.title);
  cv::imshow(content.title, content.picture(area));
  while (true) {
    const int key = cv::waitKey(kMilliseconds);
    if (!is_open(content.title)) return;
    const std::vector<cv::Point> clicks = std::exchange(mouse.clicks, {});
    for (const cv::Point& at : clicks) content.on_click(at);
    WindowStep step = content.next ? content.next() : WindowStep::wait;
    if (key >= 0 && step != WindowStep::close)
      step = std::max(step, content.on_key(static_cast<char>(key & 0xff)));
    if (step == WindowStep::close) break;
    const cv::Size before = std::exchange(area, area_of(content.title));
    if (step == WindowStep::redraw || !clicks.empty() || area != before)
      cv::imshow(content.title, content.picture(area));
  }
  cv::destroyWindow(content.title);
}
