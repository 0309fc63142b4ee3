#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "camera/epipolar_line.hpp"
#include "hypotrack/api/clicks.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/landmark_fit.hpp"

namespace hypotrack {
namespace {

/// A model of the scene with the clicks on it.
struct ClickedModel {
  const Scene::Item* item = nullptr;
  std::shared_ptr<const Model> model;  ///< with all landmarks that can be clicked
  Eigen::Matrix3Xd landmarks;          ///< triangulated, world, metres; NaN: not clicked
  std::vector<std::pair<std::size_t, Eigen::Index>> clicks = {};  ///< click, its landmark
};

std::vector<ClickedModel> models_of(const Scene& scene) {
  std::vector<ClickedModel> out;
  for (const Scene::Item& item : scene.items()) {
    std::shared_ptr<const Model> model = clickable(item.model);
    const auto count = static_cast<Eigen::Index>(model->data().landmarks.size());
    out.push_back({&item, std::move(model),
                   Eigen::Matrix3Xd::Constant(3, count, std::numeric_limits<double>::quiet_NaN())});
  }
  return out;
}

/// Returns the model and the landmark that a click names. Throws ConfigError if it names none or
/// several.
std::pair<ClickedModel*, Eigen::Index> named(std::vector<ClickedModel>& models,
                                             const std::string& name, const std::string& where) {
  std::vector<std::pair<ClickedModel*, Eigen::Index>> found;
  std::vector<std::string> names;
  for (ClickedModel& model : models) {
    const auto& landmarks = model.model->data().landmarks;
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const std::string whole = model.item->name + "." + landmarks[i].name;
      names.push_back(models.size() > 1 ? whole : landmarks[i].name);
      if (name == whole || name == landmarks[i].name)
        found.emplace_back(&model, static_cast<Eigen::Index>(i));
    }
  }
  if (found.empty())
    throw ConfigError(fmt::format("{}: '{}' is no landmark of the scene's models{}", where, name,
                                  did_you_mean(name, names)));
  if (found.size() > 1)
    throw ConfigError(fmt::format(
        "{}: '{}' is a landmark of several models; write '{}.{}' or "
        "'{}.{}'",
        where, name, found[0].first->item->name, name, found[1].first->item->name, name));
  return found.front();
}

void check_in_picture(const Camera& camera, const Eigen::Vector2d& at, const char* view,
                      const Click& click, const std::string& where) {
  if (at.x() >= -0.5 && at.y() >= -0.5 && at.x() <= camera.width - 0.5 &&
      at.y() <= camera.height - 0.5)
    return;
  throw ConfigError(fmt::format(
      "{}: '{}': ({:.1f}, {:.1f}) lies outside of the {} picture, which has {}x{} pixels", where,
      click.landmark, at.x(), at.y(), view, camera.width, camera.height));
}

/// Throws DataError, naming all clicks that do not meet.
void check_meeting(const std::vector<Camera>& cameras, std::span<const Click> clicks,
                   double tolerance, const std::string& where) {
  std::string bad;
  for (const Click& click : clicks) {
    check_in_picture(cameras[0], click.left, "left", click, where);
    check_in_picture(cameras[1], click.right, "right", click, where);
    const double off = distance_from_epipolar_line(cameras, click);
    if (off <= tolerance) continue;
    bad += fmt::format("{}'{}' ({:.1f} px)", bad.empty() ? "" : ", ", click.landmark, off);
  }
  if (bad.empty()) return;
  throw DataError(
      fmt::format("{}: the clicks of {} do not meet: in the right view they are that far from the "
                  "epipolar line "
                  "of the left one; expected at most {:g} px. Click them again; if all are off, "
                  "the calibration "
                  "does not belong to the pictures",
                  where, bad, tolerance));
}

/// Returns whether points lie so near to a line that the turn about it is unknown.
bool near_a_line(const Eigen::Matrix3Xd& points) {
  constexpr double kNarrow = 0.05;  // standard deviation across, as a share of that along
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d spreads =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centred * centred.transpose())
          .eigenvalues();  // in rising order
  return spreads[1] <= kNarrow * kNarrow * spreads[2];
}

void check_clicks_of(const ClickedModel& model, const std::string& where) {
  const int needed = clicks_needed(*model.model);
  if (std::ssize(model.clicks) < needed)
    throw ConfigError(fmt::format("{}: {} landmark{} of '{}' {} clicked; expected {} or more",
                                  where, model.clicks.size(), model.clicks.size() == 1 ? "" : "s",
                                  model.item->name, model.clicks.size() == 1 ? "is" : "are",
                                  needed));
  std::vector<Eigen::Index> known;
  for (const auto& [click, landmark] : model.clicks) known.push_back(landmark);
  if (near_a_line(model.landmarks(Eigen::all, known)))
    throw DataError(
        fmt::format("{}: the clicked landmarks of '{}' lie on a line; a pose needs one beside it",
                    where, model.item->name));
}

/// Fits one model. Throws DataError if the fit is too bad.
Eigen::VectorXd fitted(const ClickedModel& model, std::span<const double> rest,
                       const std::string& where) {
  constexpr double kWorst = 0.3;  // mean distance, as a share of the landmarks' extent
  const Eigen::VectorXd aligned = align_to_landmarks(*model.model, model.landmarks, rest);
  LandmarkFit fit = fit_landmarks(*model.model, model.landmarks,
                                  {aligned.data(), static_cast<std::size_t>(aligned.size())});
  std::vector<Eigen::Index> known;
  for (const auto& [click, landmark] : model.clicks) known.push_back(landmark);
  const Eigen::Matrix3Xd points = model.landmarks(Eigen::all, known);
  const double extent = (points.colwise() - points.rowwise().mean()).colwise().norm().mean();
  if (!(fit.mean_distance <= kWorst * extent))
    throw DataError(fmt::format(
        "{}: the clicks do not fit the model '{}': its landmarks are {:.3g} mm away on average in "
        "the best pose; check that each name is clicked where it belongs, and the model's size",
        where, model.item->name, 1000 * fit.mean_distance));
  return fit.parameters;
}

}  // namespace

double distance_from_epipolar_line(const std::vector<Camera>& cameras, const Click& click) {
  return distance_from_line(epipolar_line(cameras.at(0), click.left, cameras.at(1)), click.right);
}

ClickFit fit_clicks(const Scene& scene, const std::vector<Camera>& cameras,
                    std::span<const Click> clicks, double tolerance, const std::string& where) {
  if (cameras.size() < 2)
    throw DataError(fmt::format("{}: clicks need two views; the source has one", where));
  if (clicks.empty()) throw ConfigError(fmt::format("{}: holds no click", where));
  std::vector<ClickedModel> models = models_of(scene);
  std::vector<std::pair<ClickedModel*, Eigen::Index>> targets;
  for (const Click& click : clicks) {
    targets.push_back(named(models, click.landmark, where));
    if (std::ranges::count(targets, targets.back()) > 1)
      throw ConfigError(fmt::format("{}: '{}' is clicked twice", where, click.landmark));
  }
  check_meeting(cameras, clicks, tolerance, where);
  for (std::size_t i = 0; i < clicks.size(); ++i) {
    const auto [model, landmark] = targets[i];
    const Eigen::Vector3d at = triangulate(cameras[0], clicks[i].left, cameras[1], clicks[i].right);
    if (!at.allFinite())
      throw DataError(
          fmt::format("{}: the clicks of '{}' meet nowhere before the cameras; are the "
                      "views exchanged?",
                      where, clicks[i].landmark));
    model->landmarks.col(landmark) = at;
    model->clicks.emplace_back(i, landmark);
  }
  ClickFit out{scene.rest_state(), std::vector<ClickResidual>(clicks.size())};
  for (const ClickedModel& model : models) {
    if (model.clicks.empty()) continue;
    check_clicks_of(model, where);
    const Eigen::VectorXd parameters = fitted(model, scene.part(*model.item, out.state), where);
    out.state.segment(model.item->offset, parameters.size()) = parameters;
    const Eigen::Matrix3Xd posed = posed_landmarks(
        *model.model, {parameters.data(), static_cast<std::size_t>(parameters.size())});
    for (const auto& [click, landmark] : model.clicks) {
      const Eigen::Vector3d at = posed.col(landmark);
      const auto& name = model.model->data().landmarks[static_cast<std::size_t>(landmark)].name;
      out.residuals[click] = {model.item->name + "." + name,
                              (at - model.landmarks.col(landmark)).norm(),
                              std::max((project(cameras[0], at) - clicks[click].left).norm(),
                                       (project(cameras[1], at) - clicks[click].right).norm())};
    }
  }
  return out;
}

}  // namespace hypotrack
