#include "clicking/click_picture.hpp"

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/overlay.hpp"
#include "picture/pen.hpp"

namespace hypotrack::clicking {

cv::Mat draw_clicks(Renderer& renderer, const Scene& scene, const std::vector<Camera>& cameras,
                    const Frame& frame, const ClickDrawing& drawing) {
  const cv::Scalar kMarked(120, 235, 120), kAsked(80, 230, 255), kLine(255, 200, 120);
  std::vector<cv::Mat> views;
  for (const std::size_t i : {0, 1}) {
    views.push_back(picture_of(frame.views.at(i)).clone());
    if (drawing.state.size() > 0)
      views[i] = draw_overlay(renderer, scene, views[i], cameras[i], drawing.state,
                              {.opacity = 0.35, .hidden = drawing.hidden});
    Pen pen(views[i]);
    pen.line(drawing.lines[i], kLine);
    for (const Mark& mark : drawing.marks)
      if (mark.view == i)
        pen.cross(mark.at, mark.asked ? kAsked : kMarked, mark.asked ? mark.name : "");
  }
  return side_by_side(views, drawing.text);
}

}  // namespace hypotrack::clicking
