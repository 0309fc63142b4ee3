#include "contour.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "model_contours.hpp"

namespace hypotrack::contour {
namespace {

constexpr int kSurfacePoints = 800;  // on all sides; a camera sees less than half

/// Throws unless a view has colour, and where colour or valid image are not the tile's.
void check(const Observation& observation, bool wants_depth) {
  bool any = false, depth = false;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (wants_depth && !view.depth.empty()) {
      check_tile_image("contour", view.depth, CV_32FC1, view, i, "depth image");
      depth = true;
    }
    if (view.color.empty()) continue;
    any = true;
    check_tile_image("contour", view.color, CV_8UC3, view, i, "colour image");
    check_tile_image("contour", view.valid, CV_8UC1, view, i, "valid image");
  }
  if (any && depth == wants_depth) return;
  const std::size_t count = observation.views.size();
  throw DataError(fmt::format(
      "objective contour: frame {} has {} view{}, none with {}; use a source that gives it{}",
      observation.frame, count, count == 1 ? "" : "s", any ? "depth" : "colour",
      any ? ", or leave depth_sigma_mm out" : ""));
}

Eigen::Isometry3d pose_of(const Eigen::VectorXd& state, int offset) {
  return world_from_model({state.data() + offset, kPoseSize});
}

void set_pose(const Eigen::Isometry3d& pose, int offset, Eigen::VectorXd& state) {
  const Eigen::Quaterniond q(pose.linear());
  state.segment<kPoseSize>(offset) << pose.translation(), q.w(), q.vec();
}

}  // namespace

Contour::Contour(const Params& params, const Scene& scene, const PluginLog& log) : params_(params) {
  for (const Scene::Item& item : scene.items()) {
    if (is_rigid(*item.model))
      models_.push_back({item.offset, model_contours(item.model, params, log),
                         spread_points(item.model->data().mesh, kSurfacePoints)});
    else
      log.note(fmt::format("model '{}' has joints; its contour is not looked at", item.name));
  }
  if (models_.empty()) log.warning("no model is rigid; the objective costs nothing");
}

void Contour::do_prepare(const Observation& observation) {
  check(observation, params_.depth_sigma > 0);
  learn(observation);
  lines_.clear();
  depths_.clear();
  refined_ = observation.start;
  for (const RigidModel& model : models_) fit(model, observation.views);
}

void Contour::learn(const Observation& observation) {
  const auto& previous = observation.context.previous;
  if (from_guess_ || observation.context.start_is_guess) {
    for (RigidModel& model : models_) model.colors.assign(observation.views.size(), {});
    learn_from(observation.start, observation.views, 1);
    from_guess_ = observation.context.start_is_guess;
    learned_ = observation.frame;
  } else if (previous && last_ && previous->frame == last_->frame && learned_ < last_->frame) {
    learn_from(previous->state, last_->views, params_.learning_rate);
    learned_ = last_->frame;
  }
  last_ = SeenFrame{observation.frame, observation.views};
}

void Contour::learn_from(const Eigen::VectorXd& state, const std::vector<TileView>& views,
                         double weight) {
  constexpr double kLeastShown = 0.5;
  for (RigidModel& model : models_) {
    const Eigen::Isometry3d pose = pose_of(state, model.offset);
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].color.empty()) continue;
      const Eigen::Isometry3f camera_from_model =
          (views[i].camera.camera_from_world * pose).cast<float>();
      TileView view = views[i];
      if (const cv::Mat1b covered = hidden(model, state, view.camera); !covered.empty()) {
        view.valid = view.valid.clone();
        view.valid.setTo(0, covered);
      }
      const double shown = count_colors(model.contours.seen_by(camera_from_model),
                                        camera_from_model, view, model.colors[i]);
      if (shown < kLeastShown)
        model.colors[i].discard();
      else
        model.colors[i].learn(weight);
    }
  }
}

cv::Mat1b Contour::hidden(const RigidModel& model, const Eigen::VectorXd& state,
                          const TileCamera& camera) const {
  const auto placed = [&](const RigidModel& any) {
    return Eigen::Isometry3f((camera.camera_from_world * pose_of(state, any.offset)).cast<float>());
  };
  const auto distance = [&](const RigidModel& any) {
    return (placed(any) * any.contours.centre()).z();
  };
  cv::Mat1b out;
  for (const RigidModel& other : models_) {
    if (&other == &model || distance(other) >= distance(model)) continue;
    const Eigen::Isometry3f pose = placed(other);
    const cv::Mat1b covered = covered_by(other.contours.seen_by(pose), pose, camera);
    if (out.empty())
      out = covered;
    else
      out |= covered;
  }
  return out;
}

void Contour::fit(const RigidModel& model, const std::vector<TileView>& views) {
  std::vector<RegionView> regions;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].color.empty() || model.colors[i].is_empty()) continue;
    cv::Mat with_alpha, color;
    cv::cvtColor(views[i].color, with_alpha, cv::COLOR_BGR2BGRA);
    with_alpha.convertTo(color, CV_32F);
    regions.push_back({&views[i].camera, color,
                       model.colors[i].log_odds(views[i].color, views[i].valid),
                       hidden(model, refined_, views[i].camera)});
  }
  DepthViews depth{.points = model.surface, .views = {}, .sigma = params_.depth_sigma};
  for (const TileView& view : views)
    if (params_.depth_sigma > 0 && !view.depth.empty()) depth.views.push_back(&view);
  const Eigen::Isometry3d pose =
      fit_region(model.contours, pose_of(refined_, model.offset), regions, depth);
  set_pose(pose, model.offset, refined_);
  for (const RegionView& region : regions) {
    constexpr double kReach = 0.1;  // of a tile: a tenth of the model's size
    lines_.push_back({*region.camera, model.offset, 1.0 / static_cast<double>(regions.size()),
                      kReach * region.camera->width, lines_of(model.contours, pose, region, 1)});
  }
  for (const TileView* view : depth.views)
    depths_.push_back({model.offset, depth.sigma, 1.0 / static_cast<double>(depth.views.size()),
                       match_depth(model.surface, pose, *view)});
}

double Contour::do_cost(const RenderedHypothesis& hypothesis) const {
  return contour::cost_and_residuals(lines_, hypothesis.state, {}) +
         contour::cost_and_residuals(depths_, hypothesis.state, {});
}

void Contour::do_write_residuals(const RenderedHypothesis& hypothesis,
                                 std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double Contour::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                      std::span<float> residuals) const {
  const auto lines = static_cast<std::size_t>(contour::residual_count(lines_));
  return contour::cost_and_residuals(lines_, hypothesis.state, residuals.first(lines)) +
         contour::cost_and_residuals(depths_, hypothesis.state, residuals.subspan(lines));
}

void Contour::do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                                Jacobian& jacobian) const {
  do_cost_and_residuals(hypothesis, residuals);
  contour::write_jacobian(lines_, hypothesis.state, jacobian);
  contour::write_jacobian(depths_, hypothesis.state, contour::residual_count(lines_), jacobian);
}

}  // namespace hypotrack::contour
