#include "contour.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
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

Eigen::Isometry3f camera_from_model(const TileCamera& camera, const Eigen::VectorXd& state,
                                    int offset) {
  return (camera.camera_from_world * pose_of(state, offset)).cast<float>();
}

/// Returns how far a model is from a camera along its axis.
float distance_of(const ContourViews& contours, const Eigen::Isometry3f& camera_from_model) {
  return (camera_from_model * contours.centre()).z();
}

/// Returns the colours of a view, with 0 as the fourth channel where its camera has no pixel.
cv::Mat4b with_validity(const TileView& view) {
  cv::Mat4b out;
  cv::cvtColor(view.color, out, cv::COLOR_BGR2BGRA);
  out.setTo(cv::Scalar::all(0), view.valid == 0);
  return out;
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
  const std::vector<Picture> pictures = pictures_of(observation);
  for (const RigidModel& model : models_) fit(model, observation, pictures);
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
  constexpr float kReach = 0.125f;  // of the model's extent
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].color.empty()) continue;
    const cv::Mat1f nearest = this->nearest(state, views[i].camera);
    for (RigidModel& model : models_) {
      const Eigen::Isometry3f pose = camera_from_model(views[i].camera, state, model.offset);
      const float reach = kReach * extent_of(model.contours, pose, views[i].camera);
      const double shown = count_colors(model.contours.seen_by(pose), pose,
                                        {&views[i], nearest, distance_of(model.contours, pose)},
                                        reach, model.colors[i]);
      if (shown < kLeastShown)
        model.colors[i].discard();
      else
        model.colors[i].learn(weight);
    }
  }
}

std::vector<Contour::Picture> Contour::pictures_of(const Observation& observation) const {
  std::vector<Picture> out;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (!view.color.empty())
      out.push_back({&view, i, with_validity(view), nearest(observation.start, view.camera)});
  }
  return out;
}

cv::Mat1f Contour::nearest(const Eigen::VectorXd& state, const TileCamera& camera) const {
  if (models_.size() < 2) return {};
  cv::Mat1f out(camera.height, camera.width, std::numeric_limits<float>::infinity());
  for (const RigidModel& model : models_) {
    const Eigen::Isometry3f pose = camera_from_model(camera, state, model.offset);
    add_cover(model.contours.seen_by(pose), pose, camera, distance_of(model.contours, pose), out);
  }
  return out;
}

void Contour::fit(const RigidModel& model, const Observation& observation,
                  const std::vector<Picture>& pictures) {
  std::vector<RegionView> regions;
  std::vector<std::size_t> views;
  for (const Picture& picture : pictures) {
    const ColorHistograms& colors = model.colors[picture.index];
    if (colors.is_empty()) continue;
    const TileCamera& camera = picture.view->camera;
    // Distances stay those of the start, so that no model is behind another that it was before.
    const float distance =
        distance_of(model.contours, camera_from_model(camera, observation.start, model.offset));
    regions.push_back({&camera, {picture.color, colors.log_odds()}, picture.nearest, distance});
    views.push_back(picture.index);
  }
  DepthViews depth{.points = model.surface, .views = {}, .sigma = params_.depth_sigma};
  for (const TileView& view : observation.views)
    if (params_.depth_sigma > 0 && !view.depth.empty()) depth.views.push_back(&view);
  const Eigen::Isometry3d pose =
      fit_region(model.contours, pose_of(refined_, model.offset), regions, depth);
  set_pose(pose, model.offset, refined_);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    RegionView& region = regions[i];
    const Eigen::Isometry3f here = camera_from_model(*region.camera, refined_, model.offset);
    if (!region.nearest.empty()) {  // models that are fitted later see this one where it is now
      add_cover(model.contours.seen_by(here), here, *region.camera, region.distance,
                region.nearest);
    }
    constexpr double kReach = 0.1;  // of the model's extent
    lines_.push_back({*region.camera, model.offset, 1.0 / static_cast<double>(regions.size()),
                      kReach * double{extent_of(model.contours, here, *region.camera)},
                      lines_of(model.contours, pose, region, 1), views[i]});
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
