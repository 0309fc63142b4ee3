#include "hypotrack/api/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stop_scope.hpp"
#include "cost/cuda/device.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/plugin_notes.hpp"
#include "run/tracker_impl.hpp"

namespace hypotrack {
namespace {

/// Returns the solution of a frame without views before anything was tracked.
Solution missing(const OpenedScene& opened, const Eigen::VectorXd& start, const Frame& frame) {
  const Scene& scene = *opened.scene;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = unknown;
  solution.models.assign(scene.items().size(), Status::missing);
  solution.probabilities.assign(scene.items().size(), unknown);
  solution.state = start.size() > 0 ? start : scene.rest_state();
  solution.landmarks = scene.landmarks(solution.state);
  if (opened.parts.status.uncertainty.enabled)
    solution.sigma.setConstant(solution.landmarks.cols(), unknown);
  return solution;
}

}  // namespace

Tracker::Impl::Impl(OpenedScene opened, std::vector<Camera> from)
    : scene(std::move(opened)), cameras(std::move(from)) {
  if (cameras.empty()) throw DataError("a tracker needs at least one camera");
  if (scene.shape.seconds > 0)
    throw ConfigError(
        "shape.estimate_s fits the shape to the first frames of the scene's own source; for frames "
        "of a program, find it with `hypotrack fit-shape` and give the models its shape_file");
  // Smoothing by later frames is a run's, as is its share of the budget.
  scene.parts.fixed_lag.enabled = false;
  scene.parts.cameras = cameras;
  start = start_state(scene, nullptr).value_or(Eigen::VectorXd());
  const bool sizes_known =
      std::ranges::all_of(cameras, [](const Camera& c) { return c.width > 0 && c.height > 0; });
  if (sizes_known && start.size() > 0) begin({});
}

void Tracker::Impl::begin(const Frame& first) {
  if (begun)
    throw DataError("this tracker could not start, as an error said before; make another one");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string where = fmt::format("camera {} of the tracker", i);
    if (!first.views.empty()) {
      const View& view = first.views[i];
      const cv::Mat& image = view.color.empty() ? view.depth : view.color;
      fit_image_size(cameras[i], image.cols, image.rows, where);
    }
    validate(cameras[i], where);
  }
  scene.parts.cameras = cameras;
  if (start.size() == 0) start = initial_state(scene, first);
  begun = true;
  tracker.emplace(*scene.scene, std::move(scene.parts), start, scene.seed);
}

void Tracker::Impl::check_order(const Frame& frame) const {
  if (last_index && frame.index <= *last_index)
    throw DataError(fmt::format("frame {} comes after frame {}; expected a larger index",
                                frame.index, *last_index));
  if (!std::isfinite(frame.time))
    throw DataError(fmt::format("frame {} is at {} s; expected a number", frame.index, frame.time));
  if (frame.time <= last_time)
    throw DataError(
        fmt::format("frame {} is at {} s, the one before at {} s; expected a later time",
                    frame.index, frame.time, last_time));
}

void Tracker::Impl::check_views(const Frame& frame) const {
  if (frame.views.empty()) return;
  if (frame.views.size() != cameras.size())
    throw DataError(fmt::format("frame {} has {} view{}; expected {}, one per camera", frame.index,
                                frame.views.size(), frame.views.size() == 1 ? "" : "s",
                                cameras.size()));
  for (std::size_t i = 0; i < frame.views.size(); ++i) {
    const View& view = frame.views[i];
    if (view.color.empty() && view.depth.empty())
      throw DataError(
          fmt::format("frame {}: view {} has no image; a frame that cannot be used has "
                      "no views at all",
                      frame.index, i));
    Camera camera = cameras[i];
    for (const cv::Mat* image : {&view.color, &view.depth, &view.mask})
      if (!image->empty())
        fit_image_size(camera, image->cols, image->rows,
                       fmt::format("frame {}, view {}", frame.index, i));
  }
}

Tracker::Tracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

void Tracker::Impl::pass(const Frame& frame) {
  last_index = frame.index;
  last_time = frame.time;
}

Solution Tracker::track(const Frame& frame, const StopTest& stop) {
  Impl& self = *impl_;
  self.check_order(frame);
  self.check_views(frame);
  const StopScope scope(stop);
  const cuda::KeepDevice keep;
  try {
    if (!self.tracker && !frame.views.empty()) self.begin(frame);
    Solution solution =
        self.tracker ? self.tracker->track(frame) : missing(self.scene, self.start, frame);
    self.pass(frame);
    return solution;
  } catch (const Stopped&) {
    self.pass(frame);
    throw;
  }
}

const Scene& Tracker::scene() const { return *impl_->scene.scene; }
const std::vector<Camera>& Tracker::cameras() const { return impl_->cameras; }
std::vector<std::string> Tracker::take_notes() {
  std::vector<std::string> lines = impl_->scene.plugin_notes->take_lines();
  if (!impl_->tracker) return lines;
  for (const auto& notes : {impl_->tracker->take_start_notes(), impl_->tracker->take_rig_notes()})
    for (const std::string& note : notes) lines.push_back("note: " + note);
  return lines;
}
std::string Tracker::backend() const {
  return impl_->tracker ? impl_->tracker->backend() : "not chosen before the first frame";
}

}  // namespace hypotrack
