#include "shape/image_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hypotrack::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

// Steps of the numerical derivatives: about a millimetre.
SearchSettings steps_of(double length) {
  return {.position = length * 1e-3,
          .rotation = length * 0.75 * kDegree,
          .angle = length * 1.5 * kDegree,
          .rotation_as = RotationCoordinates::tangent,
          .prediction = {}};
}
constexpr double kShapeStep = 0.2;  // deviations

/// Returns a shape with one parameter a step up (or down), within its bounds.
VectorXd with_step(const VectorXd& shape, const std::vector<ShapeParameter>& parameters, Index i,
                   double step) {
  const ShapeParameter& p = parameters[static_cast<std::size_t>(i)];
  VectorXd other = shape;
  other[i] = std::clamp(shape[i] + step * kShapeStep * p.deviation, p.lower, p.upper);
  return other;
}

/// Returns the state with all models moved out of view.
VectorXd out_of_sight(const Scene& scene, VectorXd state) {
  constexpr double kFar = 1e4;  // metres, to the side
  for (const Scene::Item& item : scene.items()) state[item.offset] += kFar;
  return state;
}

}  // namespace

ImageProblem::ImageProblem(const Scene& scene, const ShapeTargets& targets, ImageProblemParts parts,
                           std::vector<TrackedFrame> frames)
    : scene_(scene),
      targets_(targets),
      parts_(std::move(parts)),
      frames_(std::move(frames)),
      space_(scene, steps_of(1)),
      coverage_(std::make_shared<Coverage>()) {
  parts_.objective.push_back({.objective = coverage_, .name = "coverage"});
  const TileMaker tiles(scene, parts_.cameras, parts_.tile);
  PhotometricMatch photometric(scene, parts_.photometric);
  for (const TrackedFrame& f : frames_) {
    TilePlan plan = tiles.plan(f.frame, f.state);
    photometric.learn(tiles, f.frame, plan, f.state);
    photometric.apply(plan);
    photometric.apply_highlights(plan, f.state);
    observations_.push_back(tiles.resample(f.frame, plan));
  }
  thinner_ = parts_.edge * pixel_width();
  measure_explained();
}

ImageProblem::~ImageProblem() = default;

void ImageProblem::set_steps(double length) {
  steps_ = length;
  space_ = SearchSpace(scene_, steps_of(length));
}

JointTrial ImageProblem::start() const {
  JointTrial trial;
  trial.shape = targets_.values();
  for (const TrackedFrame& f : frames_) trial.poses.push_back(f.state);
  return trial;
}

ImageProblem::Built ImageProblem::built(const VectorXd& shape) const {
  Built b;
  b.scene = targets_.reshaped(scene_, shape, thinner_);
  b.cost = make_cost(*b.scene, parts_.objective, parts_.evaluate, {.least_squares = true});
  return b;
}

void ImageProblem::prepare(Cost& cost, std::size_t frame) {
  coverage_->set_penalty(parts_.coverage * std::max(explained_[frame], 0.0));
  cost.prepare(observations_[frame]);
}

double ImageProblem::pixel_width() const {
  double sum = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const TileCamera& camera = observations_[k].views.front().camera;
    for (const int i : targets_.models()) {
      const Index first = scene_.items()[static_cast<std::size_t>(i)].offset;
      const Eigen::Vector3d origin = frames_[k].state.segment<3>(first);
      sum += (camera.camera_from_world * origin).z() / camera.fx;
    }
  }
  return sum / static_cast<double>(frames_.size() * targets_.models().size());
}

void ImageProblem::measure_explained() {
  const JointTrial trial = start();
  const Built b = built(trial.shape);
  explained_.assign(frames_.size(), 0);  // no penalty while it is measured
  const double coverage = std::exchange(parts_.coverage, 1);
  std::vector<double> explained;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    MatrixXd states(scene_.dimension(), 2);
    states << trial.poses[k], out_of_sight(scene_, trial.poses[k]);
    VectorXd free(2), penalized(2);
    prepare(*b.cost, k);
    b.cost->evaluate(states, free);
    coverage_->set_penalty(1);
    b.cost->evaluate(states, penalized);
    const double pixels = penalized[0] - free[0];
    const double value = pixels > 0 ? (free[1] - free[0]) / pixels : 0;
    explained.push_back(std::isfinite(value) ? value : 0);
  }
  explained_ = std::move(explained);
  parts_.coverage = coverage;
}

VectorXd ImageProblem::moved(const VectorXd& pose, const VectorXd& step) const {
  const SearchRegion region = space_.region(pose);
  const VectorXd point = (region.start + step).cwiseMax(region.lower).cwiseMin(region.upper);
  return space_.states(point, pose);
}

VectorXd ImageProblem::costs(const JointTrial& trial) {
  const Built b = built(trial.shape);
  VectorXd costs(static_cast<Index>(frames_.size()));
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    prepare(*b.cost, k);
    b.cost->evaluate(trial.poses[k], costs.segment<1>(static_cast<Index>(k)));
  }
  return costs;
}

/// Fills the columns of the pose by central differences.
void ImageProblem::add_poses(Cost& cost, const VectorXd& pose, FrameSystem& system,
                             MatrixXf& jacobian) {
  const SearchRegion region = space_.region(pose);
  const Index d = space_.dimension(), residuals = cost.least_squares()->count();
  const VectorXd forth = (region.start + region.spread).cwiseMin(region.upper);
  const VectorXd back = (region.start - region.spread).cwiseMax(region.lower);
  MatrixXd points = region.start.replicate(1, 2 * d + 1);
  for (Index i = 0; i < d; ++i) {
    points(i, 2 * i) = forth[i];
    points(i, 2 * i + 1) = back[i];
  }
  MatrixXf r(residuals, points.cols());
  VectorXd costs(points.cols());
  cost.least_squares()->evaluate(space_.states(points, pose), r, costs);
  system.cost = costs[2 * d];
  jacobian.resize(residuals, system.gradient.size());
  for (Index i = 0; i < d; ++i) {
    const double width = forth[i] - back[i];
    system.gradient[i] = (costs[2 * i] - costs[2 * i + 1]) / width;
    jacobian.col(i) = (r.col(2 * i) - r.col(2 * i + 1)) / static_cast<float>(width);
  }
}

std::vector<FrameSystem> ImageProblem::systems(const JointTrial& trial) {
  const Index d = space_.dimension(), p = trial.shape.size();
  const Built base = built(trial.shape);
  std::vector<Built> forth, back;
  VectorXd widths(p);
  for (Index i = 0; i < p; ++i) {
    const VectorXd up = with_step(trial.shape, targets_.wanted(), i, steps_);
    const VectorXd down = with_step(trial.shape, targets_.wanted(), i, -steps_);
    widths[i] = up[i] - down[i];
    forth.push_back(built(up));
    back.push_back(built(down));
  }
  std::vector<FrameSystem> systems(frames_.size());
  MatrixXf jacobian;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    FrameSystem& system = systems[k];
    system.gradient.resize(d + p);
    prepare(*base.cost, k);
    add_poses(*base.cost, trial.poses[k], system, jacobian);
    MatrixXf r(jacobian.rows(), 2);
    VectorXd costs(2);
    for (Index i = 0; i < p; ++i) {
      for (const Index side : {0, 1}) {
        Cost& cost = *(side == 0 ? forth : back)[static_cast<std::size_t>(i)].cost;
        cost.prepare_drawing(observations_[k]);
        cost.least_squares()->evaluate(trial.poses[k], r.middleCols(side, 1),
                                       costs.segment<1>(side));
      }
      system.gradient[d + i] = (costs[0] - costs[1]) / widths[i];
      jacobian.col(d + i) = (r.col(0) - r.col(1)) / static_cast<float>(widths[i]);
    }
    system.hessian = 2 * (jacobian.transpose() * jacobian).cast<double>();
  }
  return systems;
}

}  // namespace hypotrack::internal
