#include "clicking/clicker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "camera/epipolar_line.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/overlay.hpp"
#include "picture/pen.hpp"

namespace hypotrack::clicking {
namespace {

/// Returns the names of a model's landmarks in the order in which they are asked for: its clear
/// ones first, or the corners of a box only.
std::vector<std::string> names_in_order(const std::shared_ptr<const Model>& model) {
  const std::vector<std::string> first = model->clear_landmarks();
  const std::shared_ptr<const Model> whole = clickable(model);
  const bool has_corners = whole != model;
  std::vector<std::string> names;
  for (const Landmark& l : whole->data().landmarks)
    if (!has_corners || l.name.starts_with("corner_")) names.push_back(l.name);
  const auto rank = [&](const std::string& name) {
    return std::ranges::find(first, name) - first.begin();  // the others: all the same
  };
  std::ranges::stable_sort(names, {}, rank);
  return names;
}

/// Returns what the name of a box's corner means; empty for other landmarks.
std::string meaning(const std::string& name) {
  if (name.find("corner_") == std::string::npos) return "";
  return " (x, y, z of the box: 0 = low end, 1 = high end)";
}

/// Says in few words how far the clicks are from the fit.
std::string summary_of(const ClickFit& fit) {
  double sum = 0;
  const ClickResidual* worst = &fit.residuals.front();
  for (const ClickResidual& r : fit.residuals) {
    sum += r.distance;
    if (r.distance > worst->distance) worst = &r;
  }
  return fmt::format("fit of {} clicks: {:.1f} mm on average, at most {:.1f} mm and {:.1f} px ({})",
                     fit.residuals.size(), 1000 * sum / static_cast<double>(fit.residuals.size()),
                     1000 * worst->distance, worst->pixels, worst->landmark);
}

}  // namespace

Clicker::Clicker(const Scene& scene, std::vector<Camera> cameras, double tolerance)
    : scene_(scene), cameras_(std::move(cameras)), tolerance_(tolerance) {
  if (cameras_.size() < 2)
    throw DataError("landmarks are clicked in two views, and the source has one");
  const bool several = scene.items().size() > 1;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Scene::Item& item = scene.items()[m];
    for (const std::string& name : names_in_order(item.model))
      landmarks_.push_back({several ? item.name + "." + name : name, m});
  }
  now_.points.resize(landmarks_.size());
  refit();
}

void Clicker::click(std::size_t view, const Eigen::Vector2d& pixel) {
  remember();
  now_.points[now_.asked][view] = pixel;
  refit();
}

Clicker::Answer Clicker::press(char key) {
  constexpr char kBackspace = 8, kEscape = 27, kEnter = 13;
  switch (key) {
    case 'u':
    case kBackspace:
      if (earlier_.empty()) break;
      now_ = std::move(earlier_.back());
      earlier_.pop_back();
      break;
    case 'x':
    case 'n':
    case ' ':
    case kEnter:
      remember();
      if (key == 'x') now_.points[now_.asked] = {};
      now_.asked = std::min(now_.asked + 1, landmarks_.size() - 1);
      break;
    case 'p':
      remember();
      now_.asked -= now_.asked > 0 ? 1 : 0;
      break;
    case 's':
      if (fit_) return Answer::save;
      break;
    case 'q':
    case kEscape:
      return Answer::quit;
    default:
      break;
  }
  refit();
  return Answer::go_on;
}

std::vector<bool> Clicker::complete_models() const {
  std::vector<int> counts(scene_.items().size(), 0);
  for (std::size_t i = 0; i < landmarks_.size(); ++i)
    if (now_.points[i][0] && now_.points[i][1]) ++counts[landmarks_[i].model];
  std::vector<bool> out;
  for (std::size_t m = 0; m < counts.size(); ++m)
    out.push_back(counts[m] >= clicks_needed(*scene_.items()[m].model));
  return out;
}

std::vector<Click> Clicker::clicks() const {
  const std::vector<bool> complete = complete_models();
  std::vector<Click> out;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const auto& [left, right] = now_.points[i];
    if (complete[landmarks_[i].model] && left && right)
      out.push_back({landmarks_[i].name, *left, *right});
  }
  return out;
}

void Clicker::refit() {
  fit_.reset();
  problem_.clear();
  const std::vector<Click> all = clicks();
  if (all.empty()) {
    problem_ = "no model has enough landmarks yet: one with joints takes 4, a rigid one 3";
    return;
  }
  try {
    fit_ = fit_clicks(scene_, cameras_, all, tolerance_, "no fit");
  } catch (const Error& e) {
    problem_ = e.what();
  }
}

ClickDrawing Clicker::drawing() const {
  ClickDrawing out;
  for (std::size_t i = 0; i < landmarks_.size(); ++i)
    for (const std::size_t view : {0, 1})
      if (const Point& at = now_.points[i][view])
        out.marks.push_back({view, *at, landmarks_[i].name, i == now_.asked});
  const auto& [left, right] = now_.points[now_.asked];
  if (left) out.lines[1] = epipolar_line(cameras_[0], *left, cameras_[1]);
  if (right) out.lines[0] = epipolar_line(cameras_[1], *right, cameras_[0]);
  if (fit_) {
    out.state = fit_->state;
    for (const bool complete : complete_models()) out.hidden.push_back(!complete);
  }
  const char* what = !left && !right ? "click it in both views"
                     : !right        ? "click it in the right view, near the line"
                     : !left         ? "click it in the left view, near the line"
                                     : "n: next";
  out.text.push_back(fmt::format("{}{}, {} of {}: {}", asked(), meaning(asked()), now_.asked + 1,
                                 landmarks_.size(), what));
  out.text.push_back(fit_ ? summary_of(*fit_) : problem_);
  out.text.emplace_back("u: undo   x: skip   n: next   p: previous   s: save   q: quit");
  return out;
}

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
