#include "shape/landmark_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "hypotrack/plugin/landmark_fit.hpp"

namespace hypotrack::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const SearchSettings kTangent = {.rotation_as = RotationCoordinates::tangent, .prediction = {}};
constexpr double kStep = 1e-6;

/// Returns the range of a model's landmarks among the scene's: the first and the count.
std::pair<Index, Index> columns_of(const Scene& scene, int model) {
  Index first = 0;
  for (int i = 0; i < model; ++i)
    first += static_cast<Index>(
        scene.items()[static_cast<std::size_t>(i)].model->data().landmarks.size());
  const auto& item = scene.items()[static_cast<std::size_t>(model)];
  return {first, static_cast<Index>(item.model->data().landmarks.size())};
}

}  // namespace

bool place_models(const Scene& scene, const ShapeTargets& targets, const Matrix3Xd& landmarks) {
  return std::ranges::all_of(targets.models(), [&](int model) {
    const auto [first, count] = columns_of(scene, model);
    int known = 0;
    for (const auto& landmark : landmarks.middleCols(first, count).colwise())
      known += landmark.allFinite() ? 1 : 0;
    return known >= 3;
  });
}

LandmarkProblem::LandmarkProblem(const Scene& scene, const ShapeTargets& targets,
                                 std::vector<Matrix3Xd> landmarks)
    : scene_(scene), targets_(targets), space_(scene, kTangent) {
  for (const Matrix3Xd& all : landmarks) {
    Matrix3Xd wanted = Matrix3Xd::Constant(3, all.cols(), std::numeric_limits<double>::quiet_NaN());
    for (const int model : targets.models()) {
      const auto [first, count] = columns_of(scene, model);
      wanted.middleCols(first, count) = all.middleCols(first, count);
    }
    landmarks_.push_back(std::move(wanted));
  }
}

JointTrial LandmarkProblem::start() const {
  JointTrial trial;
  trial.shape = targets_.values();
  VectorXd state = scene_.rest_state();
  for (const Matrix3Xd& landmarks : landmarks_) {
    for (const int model : targets_.models()) {
      const Scene::Item& item = scene_.items()[static_cast<std::size_t>(model)];
      const auto [first, count] = columns_of(scene_, model);
      auto part = state.segment(item.offset, item.model->dimension());
      const VectorXd before = part;
      const auto span = [](const VectorXd& v) {
        return std::span(v.data(), static_cast<std::size_t>(v.size()));
      };
      const VectorXd placed =
          align_to_landmarks(*item.model, landmarks.middleCols(first, count), span(before));
      part = fit_landmarks(*item.model, landmarks.middleCols(first, count), span(placed),
                           {.prior = span(before)})
                 .parameters;
    }
    trial.poses.push_back(state);
  }
  return trial;
}

VectorXd LandmarkProblem::residuals(const Scene& scene, std::size_t frame,
                                    const VectorXd& pose) const {
  const Matrix3Xd apart = (scene.landmarks(pose) - landmarks_[frame]) / kLabelDeviation;
  return apart.reshaped().unaryExpr([](double r) { return std::isfinite(r) ? r : 0; });
}

double LandmarkProblem::mean_distance(const JointTrial& trial) const {
  const auto scene = targets_.reshaped(scene_, trial.shape);
  double sum = 0;
  Index count = 0;
  for (std::size_t k = 0; k < landmarks_.size(); ++k) {
    const VectorXd distances =
        (scene->landmarks(trial.poses[k]) - landmarks_[k]).colwise().norm().transpose();
    for (const double d : distances) {
      if (!std::isfinite(d)) continue;
      sum += d;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

VectorXd LandmarkProblem::moved(const VectorXd& pose, const VectorXd& step) const {
  const SearchRegion region = space_.region(pose);
  const VectorXd point = (region.start + step).cwiseMax(region.lower).cwiseMin(region.upper);
  return space_.states(point, pose);
}

VectorXd LandmarkProblem::costs(const JointTrial& trial) {
  const auto scene = targets_.reshaped(scene_, trial.shape);
  VectorXd costs(static_cast<Index>(landmarks_.size()));
  for (std::size_t k = 0; k < landmarks_.size(); ++k)
    costs[static_cast<Index>(k)] = residuals(*scene, k, trial.poses[k]).squaredNorm();
  return costs;
}

std::vector<FrameSystem> LandmarkProblem::systems(const JointTrial& trial) {
  const Index d = space_.dimension(), p = trial.shape.size();
  const auto scene = targets_.reshaped(scene_, trial.shape);
  std::vector<std::unique_ptr<Scene>> moved_shapes;
  for (Index i = 0; i < p; ++i)
    moved_shapes.push_back(targets_.reshaped(scene_, trial.shape + kStep * VectorXd::Unit(p, i)));
  std::vector<FrameSystem> systems;
  for (std::size_t k = 0; k < landmarks_.size(); ++k) {
    const VectorXd& pose = trial.poses[k];
    const VectorXd r = residuals(*scene, k, pose);
    MatrixXd jacobian(r.size(), d + p);
    const SearchRegion region = space_.region(pose);
    for (Index i = 0; i < d; ++i) {
      // If a bound forbids the step, the column is zero and the parameter keeps its value.
      const VectorXd point = (region.start + kStep * VectorXd::Unit(d, i)).cwiseMin(region.upper);
      jacobian.col(i) = (residuals(*scene, k, space_.states(point, pose)) - r) / kStep;
    }
    for (Index i = 0; i < p; ++i)
      jacobian.col(d + i) =
          (residuals(*moved_shapes[static_cast<std::size_t>(i)], k, pose) - r) / kStep;
    systems.push_back(
        {r.squaredNorm(), 2 * jacobian.transpose() * r, 2 * jacobian.transpose() * jacobian});
  }
  return systems;
}

}  // namespace hypotrack::internal
