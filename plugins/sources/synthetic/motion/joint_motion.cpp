#include "motion/joint_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/landmark_fit.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::synthetic {
namespace {

std::vector<LandmarkRow> read_rows(const JointFileParams& params, const Scene& scene) {
  std::vector<LandmarkRow> rows =
      read_landmarks(params.file, scene.landmark_names(),
                     {.metres_per_unit = metres_per(params.units), .rename = params.rename});
  std::erase_if(rows, [&](const LandmarkRow& row) {
    return row.frame < params.first ||
           (params.count > 0 && row.frame - params.first >= params.count);
  });
  if (rows.empty())
    throw DataError(fmt::format("{}: the file has no row of frame {} or later",
                                params.file.string(), params.first));
  return rows;
}

/// Smooths every known landmark by a weighted mean over the frames around it.
std::vector<LandmarkRow> smoothed(const std::vector<LandmarkRow>& rows, double sigma) {
  if (sigma <= 0) return rows;
  std::vector<LandmarkRow> out = rows;
  for (LandmarkRow& row : out) {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, row.landmarks.cols());
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(row.landmarks.cols());
    for (const LandmarkRow& other : rows) {
      const double apart = (other.frame - row.frame) / sigma;
      if (std::abs(apart) > 4) continue;
      const double weight = std::exp(-0.5 * apart * apart);
      for (Eigen::Index i = 0; i < sum.cols(); ++i) {
        if (!other.landmarks.col(i).allFinite()) continue;
        sum.col(i) += weight * other.landmarks.col(i);
        weights[i] += weight;
      }
    }
    for (Eigen::Index i = 0; i < sum.cols(); ++i)
      if (row.landmarks.col(i).allFinite()) row.landmarks.col(i) = sum.col(i) / weights[i];
  }
  return out;
}

/// Errors of one model's fits.
struct Quality {
  int rows = 0;
  double sum = 0;    // of the rows' mean distances
  double worst = 0;  // mean distance of a row
  int worst_frame = 0;
  double farthest = 0;  // of one landmark

  void add(const LandmarkFit& fit, int frame) {
    ++rows;
    sum += fit.mean_distance;
    farthest = std::max(farthest, fit.max_distance);
    if (fit.mean_distance < worst) return;
    worst = fit.mean_distance;
    worst_frame = frame;
  }
};

/// Fits one model, whose landmarks begin at column `first`, and adds keys to its motion.
class ModelFit {
 public:
  ModelFit(const Scene& scene, std::size_t model, Eigen::Index first)
      : scene_(scene), item_(scene.items()[model]), model_(model), first_(first) {}

  Eigen::Index landmarks() const {
    return static_cast<Eigen::Index>(item_.model->data().landmarks.size());
  }

  void add_row(const LandmarkRow& row, double time, Motion& motion) {
    const Eigen::Matrix3Xd part = row.landmarks.middleCols(first_, landmarks());
    Eigen::Index known = 0;
    for (Eigen::Index i = 0; i < part.cols(); ++i) known += part.col(i).allFinite();
    if (known < std::max<Eigen::Index>(3, (part.cols() + 1) / 2)) return;
    const LandmarkFit fit = fit_row(part);
    quality_.add(fit, row.frame);
    last_ = fit.parameters;
    for (int i = 0; i < item_.model->dimension(); ++i)
      if (i < 3 || i >= kPoseSize) motion.add_number(item_.offset + i, time, fit.parameters[i]);
    const auto q = fit.parameters.segment<4>(3);
    motion.add_rotation(model_, time, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
    if (quality_.rows % kScaleEvery == 1)
      scales_.push_back(fit_landmarks(*item_.model, part, last(), {.scale = true}).scale);
  }

  std::string report(const std::string& file, std::size_t rows) const {
    if (quality_.rows == 0)
      throw DataError(
          fmt::format("{}: no row knows half of the landmarks of '{}'; rename the file's columns "
                      "to them (joint_file: {{rename: [...]}}), or leave the model out",
                      file, item_.name));
    return fmt::format(
        "{}: '{}' fitted to {} of {} rows: {:.2f} mm on average, {:.2f} mm in the worst row "
        "(frame {}), one landmark by {:.1f} mm; {:.3f} times as large it would fit best\n",
        file, item_.name, quality_.rows, rows, 1e3 * quality_.sum / quality_.rows,
        1e3 * quality_.worst, quality_.worst_frame, 1e3 * quality_.farthest, upper_median(scales_));
  }

 private:
  static constexpr int kScaleEvery = 25;  // rows

  std::span<const double> last() const {
    return {last_.data(), static_cast<std::size_t>(last_.size())};
  }

  /// Fits a row from the row before, or from rest.
  LandmarkFit fit_row(const Eigen::Matrix3Xd& landmarks) const {
    if (last_.size() > 0) return fit_landmarks(*item_.model, landmarks, last(), {.prior = last()});
    const Eigen::VectorXd rest = scene_.rest_state();
    const Eigen::VectorXd aligned =
        align_to_landmarks(*item_.model, landmarks, scene_.part(item_, rest));
    return fit_landmarks(*item_.model, landmarks,
                         {aligned.data(), static_cast<std::size_t>(aligned.size())});
  }

  const Scene& scene_;
  const Scene::Item& item_;
  std::size_t model_;
  Eigen::Index first_;
  Eigen::VectorXd last_;  // parameters of the row before
  Quality quality_;
  std::vector<double> scales_;
};

}  // namespace

Script read_joint_file(const JointFileParams& params, const Scene& scene, double frame_rate) {
  const std::vector<LandmarkRow> rows = smoothed(read_rows(params, scene), params.smooth);
  const int first_frame = rows.front().frame;
  Script script{Motion(scene), (rows.back().frame - first_frame) / frame_rate, {}, {}};
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    ModelFit fit(scene, m, first);
    for (const LandmarkRow& row : rows)
      fit.add_row(row, (row.frame - first_frame) / frame_rate, script.motion);
    std::fputs(fit.report(params.file.string(), rows.size()).c_str(), stderr);
    first += fit.landmarks();
  }
  return script;
}

}  // namespace hypotrack::synthetic
