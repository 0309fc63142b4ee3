#include "hypotrack/api/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Writes white text with a dark edge, readable on any image.
void write_caption(cv::Mat& image, const std::string& text) {
  const double scale = image.rows / 720.0 + 0.2;
  const cv::Point at(static_cast<int>(12 * scale), static_cast<int>(30 * scale));
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.8 * scale, {0, 0, 0}, 4, cv::LINE_AA);
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.8 * scale, {255, 255, 255}, 1,
              cv::LINE_AA);
}

/// Returns the status as text; if the models' differ, by name.
std::string status_text(const Scene& scene, const Solution& solution) {
  const std::vector<Status>& models = solution.models;
  if (std::ranges::all_of(models, [&](Status s) { return s == models.front(); }))
    return std::string(to_string(solution.status));
  std::string text;
  for (std::size_t m = 0; m < models.size(); ++m)
    text += fmt::format("{}{} {}", m == 0 ? "" : ", ", scene.items()[m].name, to_string(models[m]));
  return text;
}

/// Flags the models that are not drawn, because their pose is unknown.
std::vector<bool> unknown_models(const Solution& solution) {
  std::vector<bool> out;
  for (const Status s : solution.models)
    out.push_back(s == Status::lost || s == Status::absent || s == Status::missing);
  return out;
}

/// Draws a ring about every landmark with its sigma as radius.
void draw_sigmas(cv::Mat& image, const Camera& camera, const Eigen::Matrix3Xd& landmarks,
                 const Eigen::VectorXd& sigmas) {
  for (Eigen::Index i = 0; i < sigmas.size(); ++i) {
    const Eigen::Vector2d at = project(camera, landmarks.col(i));
    const double radius = camera.fx * sigmas[i] / (camera.camera_from_world * landmarks.col(i)).z();
    // NaN fails both: unknown, or the landmark is behind the camera.
    if (!(at.cwiseAbs().maxCoeff() < 1e4) || !(radius > 0 && radius < camera.width)) continue;
    const cv::Point center(cvRound(at.x()), cvRound(at.y()));
    cv::circle(image, center, cvRound(radius), {0, 0, 0}, 3, cv::LINE_AA);
    cv::circle(image, center, cvRound(radius), {80, 230, 255}, 1, cv::LINE_AA);
  }
}

enum class Views { first, both };
[[maybe_unused]] std::span<const std::string_view> enum_names(Views) {
  static constexpr std::array<std::string_view, 2> kNames = {"first", "both"};
  return kNames;
}

class Overlay final : public Output {
 public:
  struct Params {
    Views views = Views::first;
    void visit(ParamVisitor& v) {
      v("views", views, {.help = "views to draw on: the first one, or the first two side by side"});
    }
  };
  explicit Overlay(const Params& params) : params_(params) {}

 private:
  std::vector<std::string> do_file_names() const override { return {"overlay.mp4"}; }
  void do_begin(OutputContext& run) override;
  void do_online(const Frame& frame, const Solution& solution) override;
  void do_frame(const Frame& /*frame*/, const Solution& /*solution*/) override {}
  void do_finish(bool complete) override;

  /// Draws the solution on the picture of one view.
  void draw(const Frame& frame, const Solution& solution, std::size_t view, cv::Mat image);

  Params params_;
  OutputContext* run_ = nullptr;
  Renderer* renderer_ = nullptr;
  std::vector<Camera> cameras_;  ///< of the views that are drawn
  cv::Size size_;                ///< of the video
  std::filesystem::path file_;
  std::unique_ptr<VideoWriter> writer_;
};

void Overlay::do_begin(OutputContext& run) {
  file_ = run.file("overlay.mp4");
  run_ = &run;
  renderer_ = &run.renderer();
  cameras_ = run.cameras();
  cameras_.resize(std::min<std::size_t>(cameras_.size(), params_.views == Views::both ? 2 : 1));
  for (const Camera& camera : cameras_) {
    size_.width += camera.width;
    size_.height = std::max(size_.height, camera.height);
  }
  try {
    writer_ = create_video(file_.string(), size_, run.frame_rate());
  } catch (const OutputError& error) {
    throw OutputError(
        fmt::format("{}; run with --set output.overlay=false to do without", error.what()));
  }
}

void Overlay::draw(const Frame& frame, const Solution& solution, std::size_t view, cv::Mat image) {
  const Scene& scene = run_->scene();
  draw_overlay(*renderer_, scene, picture_of(frame.views[view]), cameras_[view], solution.state,
               {.hidden = unknown_models(solution)})
      .copyTo(image);
  draw_sigmas(image, cameras_[view], scene.landmarks(solution.state), solution.sigma);
}

void Overlay::do_online(const Frame& frame, const Solution& solution) {
  constexpr int kGrey = 40;
  cv::Mat image(size_, CV_8UC3, cv::Scalar::all(kGrey));
  std::string caption =
      fmt::format("frame {}  {}", solution.frame, status_text(run_->scene(), solution));
  if (frame.views.empty())
    caption += ": " + frame.problem;
  else if (solution.status == Status::missing)
    caption += fmt::format(": {}", to_string(solution.fault));
  else
    caption += fmt::format("  cost {:.4g}", solution.cost);
  int left = 0;
  for (std::size_t view = 0; view < std::min(cameras_.size(), frame.views.size()); ++view) {
    const Camera& camera = cameras_[view];
    draw(frame, solution, view, image(cv::Rect(left, 0, camera.width, camera.height)));
    left += camera.width;
  }
  write_caption(image, caption);
  writer_->write(image);  // finish() tells what went wrong: the other results are whole
}

void Overlay::do_finish(bool /*complete*/) {
  const std::string why = writer_->finish();
  if (why.empty()) return;
  throw OutputError(
      fmt::format("{}: the video is cut off and may not play: {}; make room or name another folder "
                  "with --out",
                  file_.string(), why));
}

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Overlay, "the solution drawn on one view or two, overlay.mp4", "")
