#include "shape/shape_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "shape/frame_sample.hpp"
#include "shape/image_problem.hpp"
#include "shape/landmark_problem.hpp"

namespace hypotrack::internal {
namespace {

using Eigen::VectorXd;

// ImageProblemParts::edge. Chosen on synthetic recordings: fits that start at the truth stay there.
constexpr double kEdge = 0.3;

std::vector<std::string> overrides_of(const ShapeTargets& targets,
                                      const std::vector<ShapeParameter>& shape) {
  std::string map;
  for (const ShapeParameter& p : shape)
    map += fmt::format("{}{}: {}", map.empty() ? "" : ", ", p.name, p.value);
  std::vector<std::string> overrides = {"shape.estimate_s=0"};
  for (const int i : targets.models())
    overrides.push_back(fmt::format("models.{}.shape={{{}}}", i, map));
  return overrides;
}

void take(const JointFit& fit, const ShapeTargets& targets, ShapeEstimate& estimate) {
  take_shape(targets, fit.best.shape, estimate);
  estimate.first_cost = fit.first_cost;
  estimate.cost = fit.cost;
}

/// One round of tracking and fitting.
class Round {
 public:
  Round(OpenedScene session, const ShapeEstimateSettings& settings, const ShapeProgress& progress)
      : session_(std::move(session)),
        settings_(settings),
        progress_(progress),
        targets_(*session_.scene, settings.models, settings.parameters) {
    for (const ObjectiveTerm& term : session_.parts.objective) {
      if (term.weight == 0 || term.objective->residual_term()) continue;
      throw ConfigError(
          fmt::format("shape: objective {}, as it is set up, offers no residuals, which fitting a "
                      "shape needs (`hypotrack plugins info {}` says what it offers)",
                      term.name, term.name));
    }
  }

  ShapeEstimate run(int limit, bool deviations) {
    ImageProblemParts parts{.cameras = session_.parts.cameras,
                            .objective = session_.parts.objective,
                            .tile = session_.parts.tile,
                            .photometric = session_.parts.photometric,
                            .evaluate = session_.parts.evaluate,
                            .coverage = settings_.coverage,
                            .edge = kEdge};
    parts.evaluate.backend = Backend::cpu;  // residuals exist on the CPU
    std::vector<TrackedFrame> frames = track(limit);
    if (progress_.stop()) return estimate_;
    if (frames.size() < 2) {
      throw DataError(
          fmt::format("shape: {} of {} frames were tracked, expected at least 2 to fit a shape to",
                      estimate_.tracked_frames, looked_at_));
    }
    frames = believable(parts, std::move(frames));
    estimate_.used_frames = static_cast<int>(frames.size());
    take(fit(parts, frames), targets_, estimate_);
    if (deviations) estimate_.deviation = deviation(parts, frames);
    return estimate_;
  }

 private:
  std::vector<TrackedFrame> track(int limit) {
    FrameSample sample(settings_.frames);
    std::optional<SceneTracker> tracker;
    for (int i = 0; (limit == 0 || i < limit) && !progress_.stop(); ++i) {
      const auto frame = session_.source->next();
      if (!frame) break;
      ++looked_at_;
      if (!tracker && frame->views.empty()) continue;
      if (!tracker)
        tracker.emplace(*session_.scene, std::move(session_.parts), initial_state(session_, *frame),
                        session_.seed);
      const Solution solution = tracker->track(*frame);
      if (solution.status == Status::tracked) ++estimate_.tracked_frames;
      sample.add(*frame, solution);
      progress_.tracked(*frame, solution);
    }
    return sample.take();
  }

  /// Drops frames that explain much less than the others: the model is elsewhere in them.
  std::vector<TrackedFrame> believable(const ImageProblemParts& parts,
                                       std::vector<TrackedFrame> frames) const {
    constexpr double kMuchLess = 0.6;
    const ImageProblem problem(*session_.scene, targets_, parts, frames);
    const double median = upper_median(problem.explained());
    if (!(median > 0)) {
      throw DataError(fmt::format(
          "shape: in most of the {} tracked frames the objective is no better where the models "
          "were "
          "found than without them: it looks at no pictures, or they are elsewhere (look at the "
          "overlay of a run)",
          estimate_.tracked_frames));
    }
    std::vector<TrackedFrame> kept;
    for (std::size_t k = 0; k < frames.size(); ++k)
      if (problem.explained()[k] >= kMuchLess * median) kept.push_back(std::move(frames[k]));
    return kept;
  }

  /// Fits first on the tracker's tiles with long steps of the derivatives, then on finer tiles,
  /// where a smaller share of the pixels lies at an edge.
  JointFit fit(ImageProblemParts parts, const std::vector<TrackedFrame>& frames) const {
    struct Pass {
      int finer;
      double steps;
    };
    JointFit fit;
    fit.best.shape = targets_.values();
    for (const TrackedFrame& f : frames) fit.best.poses.push_back(f.state);
    for (const Pass& pass : {Pass{1, 2}, Pass{2, 1}}) {
      parts.tile.size = pass.finer * session_.parts.tile.size;
      ImageProblem problem(*session_.scene, targets_, parts, frames);
      problem.set_steps(pass.steps);
      fit = fit_jointly(problem, std::move(fit.best), prior(problem), settings_.iterations,
                        progress_.stop);
    }
    return fit;
  }

  /// Estimates the standard error of the shape from fits to a few parts of the frames.
  VectorXd deviation(const ImageProblemParts& parts,
                     const std::vector<TrackedFrame>& frames) const {
    constexpr std::size_t kParts = 4, kFewest = 2;
    const std::size_t count = std::min(kParts, frames.size() / kFewest);
    VectorXd none = VectorXd::Constant(static_cast<Eigen::Index>(targets_.wanted().size()),
                                       std::numeric_limits<double>::quiet_NaN());
    if (count < 2) return none;
    Eigen::MatrixXd found(none.size(), static_cast<Eigen::Index>(count));
    for (std::size_t part = 0; part < count; ++part) {
      std::vector<TrackedFrame> some;
      for (std::size_t k = part; k < frames.size(); k += count) some.push_back(frames[k]);
      found.col(static_cast<Eigen::Index>(part)) = fit(parts, some).best.shape;
    }
    found.colwise() -= VectorXd(found.rowwise().mean());
    const auto n = static_cast<double>(count);
    return (found.rowwise().squaredNorm() / (n * (n - 1))).cwiseSqrt();
  }

  ShapePrior prior(const ImageProblem& problem) const {
    double weight = 0;
    for (const double pixel : problem.explained()) weight += settings_.prior * std::max(pixel, 0.0);
    return targets_.prior(weight);
  }

  OpenedScene session_;
  const ShapeEstimateSettings& settings_;
  const ShapeProgress& progress_;
  ShapeTargets targets_;
  int looked_at_ = 0;
  ShapeEstimate estimate_;
};

}  // namespace

ShapeEstimate estimate_shape(const OpenShaped& open, const ShapeEstimateSettings& settings,
                             int limit, bool deviations, const ShapeProgress& progress) {
  ShapeEstimate estimate;
  for (int round = 0; round < settings.rounds && !progress.stop(); ++round) {
    progress.begin_round(round);
    estimate = Round(open(estimate.overrides), settings, progress)
                   .run(limit, deviations && round + 1 == settings.rounds);
    if (!progress.stop()) progress.end_round(round, estimate);
  }
  return estimate;
}

void take_shape(const ShapeTargets& targets, const VectorXd& values, ShapeEstimate& estimate) {
  estimate.shape = targets.with(values);
  estimate.wanted = targets.wanted();
  for (std::size_t i = 0; i < estimate.wanted.size(); ++i)
    estimate.wanted[i].value = values[static_cast<Eigen::Index>(i)];
  estimate.deviation = VectorXd::Constant(values.size(), std::numeric_limits<double>::quiet_NaN());
  estimate.overrides = overrides_of(targets, estimate.shape);
}

ShapeEstimate shape_of_labels(OpenedScene session, const ShapeEstimateSettings& settings,
                              int limit) {
  const Scene& scene = *session.scene;
  const ShapeTargets targets(scene, settings.models, settings.parameters);
  std::vector<Eigen::Matrix3Xd> labelled;
  ShapeEstimate estimate;
  for (int i = 0; limit == 0 || i < limit; ++i) {
    const auto frame = session.source->next();
    if (!frame) break;
    if (!frame->truth) continue;
    const GroundTruth& truth = *frame->truth;
    Eigen::Matrix3Xd landmarks = truth.landmarks;
    if (landmarks.size() == 0 && truth.state.size() > 0) landmarks = scene.landmarks(truth.state);
    if (landmarks.size() > 0 && place_models(scene, targets, landmarks))
      labelled.push_back(std::move(landmarks));
  }
  estimate.tracked_frames = static_cast<int>(labelled.size());
  if (labelled.size() < 2) {
    throw DataError(
        fmt::format("shape: {} frames of the source have known landmarks, expected at least 2",
                    labelled.size()));
  }
  const std::size_t count = std::min(labelled.size(), static_cast<std::size_t>(settings.frames));
  std::vector<Eigen::Matrix3Xd> used;
  for (std::size_t i = 0; i < count; ++i) used.push_back(labelled[i * labelled.size() / count]);
  estimate.used_frames = static_cast<int>(count);
  LandmarkProblem problem(scene, targets, std::move(used));
  const JointTrial start = problem.start();
  const JointFit fit = fit_jointly(problem, start, targets.prior(1), settings.iterations);
  take(fit, targets, estimate);
  estimate.first_distance = problem.mean_distance(start);
  estimate.distance = problem.mean_distance(fit.best);
  return estimate;
}

std::vector<std::string> warnings_of_bounds(const ShapeEstimate& estimate) {
  constexpr double kNear = 0.005;  // of the bound
  std::vector<std::string> warnings;
  for (const ShapeParameter& p : estimate.wanted) {
    for (const double bound : {p.lower, p.upper}) {
      if (std::abs(p.value - bound) > kNear * std::abs(bound)) continue;
      warnings.push_back(
          fmt::format("{} ends at {:.4f}, its {} bound being {:.4g}: nobody is built like that, so "
                      "the frames do not show it or were not tracked (look at the overlay of a "
                      "run), or the labels mean other points of the model. Leave it out of "
                      "shape.parameters, or give its value in `shape`",
                      p.name, p.value, bound == p.lower ? "lower" : "upper", bound));
    }
  }
  return warnings;
}

std::string shape_file_text(const ShapeEstimate& estimate) {
  std::string text = fmt::format(
      "# The shape of a model, for its `shape_file`. Written by hypotrack fit-shape from {} of {} "
      "frames.\n",
      estimate.used_frames, estimate.tracked_frames);
  for (std::size_t i = 0; i < estimate.wanted.size(); ++i) {
    const double deviation = estimate.deviation[static_cast<Eigen::Index>(i)];
    text += fmt::format("#   {:<10} {:.4f}{}\n", estimate.wanted[i].name, estimate.wanted[i].value,
                        std::isfinite(deviation) ? fmt::format(" +- {:.4f}", deviation) : "");
  }
  for (const std::string& warning : warnings_of_bounds(estimate)) text += "# " + warning + "\n";
  return text + shape_yaml(estimate.shape);
}

}  // namespace hypotrack::internal
