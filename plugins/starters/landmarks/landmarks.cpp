#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/landmark_fit.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Returns the known landmarks, less their mean.
Eigen::Matrix3Xd centred(const Eigen::Matrix3Xd& landmarks) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < landmarks.cols(); ++i)
    if (landmarks.col(i).allFinite()) known.push_back(i);
  const Eigen::Matrix3Xd points = landmarks(Eigen::all, known);
  return points.colwise() - points.rowwise().mean();
}

/// Returns the mean distance of the known landmarks from their mean.
double extent(const Eigen::Matrix3Xd& landmarks) {
  return centred(landmarks).colwise().norm().mean();
}

/// Returns whether three or more landmarks lie on a line, about which a model could turn freely.
bool on_a_line(const Eigen::Matrix3Xd& landmarks) {
  const Eigen::Matrix3Xd points = centred(landmarks);
  if (points.cols() < 3) return false;
  const Eigen::Vector3d spreads =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(points * points.transpose())
          .eigenvalues();  // in rising order
  return spreads[1] <= 1e-6 * spreads[2];
}

class Landmarks final : public Starter {
 public:
  struct Params {
    std::filesystem::path file;
    int frame = 0;
    LengthUnit units = LengthUnit::m;
    std::vector<std::string> rename;
    void visit(ParamVisitor& v) {
      v("file", file,
        {.help = "CSV of landmarks in world axes: <landmark>_x, _y and _z, and perhaps frame and "
                 "time (a joints.csv for example)",
         .required = true});
      v("frame", frame,
        {.help = "which frame of the table; without a column frame, its rows are 0, 1, 2, ...",
         .min = 0});
      v("units", units, {.help = "unit of the file: m, cm or mm"});
      v("rename", rename,
        {.help = "`name=landmark` gives a name of the table to a landmark of the scene, `name=` "
                 "drops it"});
    }
  };
  explicit Landmarks(const Params& params) : params_(params) {}

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    const Scene& scene = context.scene;
    const Eigen::Matrix3Xd landmarks = row(scene).landmarks;
    if (landmarks.array().isNaN().all()) fail("knows no landmark of the scene");
    Eigen::VectorXd state = scene.rest_state();
    Eigen::Index first = 0;
    for (const Scene::Item& item : scene.items()) {
      const auto count = static_cast<Eigen::Index>(item.model->data().landmarks.size());
      const Eigen::Matrix3Xd own = landmarks.middleCols(first, count);
      first += count;
      // A model without known landmarks stays at rest, where `init.pose` may move it.
      if (own.array().isNaN().all()) continue;
      state.segment(item.offset, item.model->dimension()) =
          fitted(item, own, scene.part(item, state));
    }
    return state;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(fmt::format("{}: frame {} {}", params_.file.string(), params_.frame, what));
  }

  LandmarkRow row(const Scene& scene) const {
    std::vector<LandmarkRow> rows =
        read_landmarks(params_.file, scene.landmark_names(),
                       {.metres_per_unit = metres_per(params_.units), .rename = params_.rename});
    for (LandmarkRow& row : rows)
      if (row.frame == params_.frame) return std::move(row);
    fail(rows.empty() ? std::string("is not there: the file has no rows")
                      : fmt::format("is not there: the file has {} to {}", rows.front().frame,
                                    rows.back().frame));
  }

  /// Returns the model's parameters of the best fit. Throws DataError if it is too bad.
  Eigen::VectorXd fitted(const Scene::Item& item, const Eigen::Matrix3Xd& landmarks,
                         std::span<const double> rest) const {
    // Landmarks that belong to the model fit better than this, as a share of their extent.
    constexpr double kWorst = 0.5;
    constexpr double kFarthest = 1000;  // metres
    const Model& model = *item.model;
    for (const double value : landmarks.reshaped())
      if (std::abs(value) > kFarthest)
        fail(fmt::format("has a landmark of '{}' {:.3g} m away; check the units", item.name,
                         std::abs(value)));
    if (on_a_line(landmarks))
      fail(fmt::format("has only landmarks of '{}' on a line; a pose needs one beside it",
                       item.name));
    LandmarkFit fit;
    try {
      const Eigen::VectorXd aligned = align_to_landmarks(model, landmarks, rest);
      fit = fit_landmarks(model, landmarks,
                          {aligned.data(), static_cast<std::size_t>(aligned.size())});
    } catch (const DataError& e) {
      fail(fmt::format("cannot place the model '{}': {}", item.name, e.what()));
    }
    if (!(fit.mean_distance <= kWorst * extent(landmarks)))
      fail(fmt::format(
          "does not fit the model '{}': the best pose has its landmarks {:.3g} mm away on average; "
          "check the names and the units (now {})",
          item.name, 1000 * fit.mean_distance,
          enum_names(params_.units)[static_cast<std::size_t>(params_.units)]));
    return fit.parameters;
  }

  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Landmarks, "a fit of the models to given 3D landmarks", "")
