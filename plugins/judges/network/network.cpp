#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/plugin/plugin.hpp"
#include "weights.hpp"

namespace hypotrack {
namespace {

/// Returns the file that a scene names, or else the one that comes with hypotrack.
std::filesystem::path file_of(const std::filesystem::path& named) {
  return named.empty() ? data_file("judges/hands_and_boxes.yaml") : named;
}

/// Judges by a network with one hidden layer, whose weights were fitted to right and wrong poses.
class NetworkJudge final : public Judge {
 public:
  struct Params : JudgeThresholds {
    std::filesystem::path weights;
    void visit(ParamVisitor& v) {
      v("weights", weights, {.help = "file of weights; empty: those for hands and boxes"});
      JudgeThresholds::visit(v);
    }
  };

  explicit NetworkJudge(const Params& params)
      : NetworkJudge(params, load_weights(file_of(params.weights))) {}
  NetworkJudge(const JudgeThresholds& thresholds, LoadedWeights loaded)
      : Judge(thresholds), loaded_(std::move(loaded)) {}

 protected:
  double do_log_odds(const Measures& measures) const override {
    const NetworkWeights& weights = loaded_.weights;
    const Network& network = measures.experienced ? weights.experienced : weights.fresh;
    const Eigen::VectorXd x = inputs(measures);
    double sum = network.bias;
    for (const NetworkUnit& unit : network.units) {
      const Eigen::Map<const Eigen::VectorXd> in(unit.in.data(), x.size());
      sum += unit.out * std::max(0.0, in.dot(x) + unit.bias);
    }
    if (measures.experienced && !std::isnan(measures.likeness))
      sum += (measures.tracked ? kOfTracked : 1.0) * weights.likeness * measures.usual_likeness *
             (measures.likeness - measures.usual_likeness);
    return sum;
  }

  FittedJudge do_fit(const JudgeFit& to) const override {
    LoadedWeights out = loaded_;  // the same measures, and the same weight of the likeness
    out.weights.version = kMeasuresVersion;
    out.weights.fitted_to = to.models;
    out.weights.trained_on = to.source;
    out.weights.fresh = fit_network(rows(to, false));
    out.weights.experienced = fit_network(rows(to, true));
    std::string file = dump_params(out.weights);
    return {std::make_unique<NetworkJudge>(thresholds(), std::move(out)), std::move(file)};
  }

 private:
  // The likeness counts half for a tracked model: a hand that turns or closes shows sides that were
  // not seen before.
  static constexpr double kOfTracked = 0.5;

  /// Returns the measures and their differences from the usual ones, which are 0 before these are
  /// known.
  Eigen::VectorXd inputs(const Measures& measures) const {
    const auto count = std::ssize(loaded_.inputs);
    Eigen::VectorXd out = Eigen::VectorXd::Zero(2 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Measures::Index measure = loaded_.inputs[static_cast<std::size_t>(i)];
      out[i] = measures[measure];
      if (measures.experienced) out[count + i] = out[i] - measures.usual[measure];
    }
    return out;
  }

  /// Returns the right and the wrong ones of the poses before or after something was learned.
  FitRows rows(const JudgeFit& to, bool experienced) const {
    std::vector<const KnownPose*> used;
    Eigen::Index right = 0;
    for (const KnownPose& pose : to.poses) {
      if (pose.measures.experienced != experienced) continue;
      if (pose.error > to.right && pose.error <= to.wrong) continue;
      used.push_back(&pose);
      right += pose.error <= to.right;
    }
    const auto count = std::ssize(used);
    if (std::min(right, count - right) < kLeastPoses)
      throw DataError(fmt::format(
          "found {} right and {} wrong poses {} the looks of a model were learned, expected {} of "
          "each; give more frames or sequences",
          right, count - right, experienced ? "after" : "before", kLeastPoses));
    FitRows out{Eigen::MatrixXd(count, 2 * std::ssize(loaded_.inputs)), Eigen::VectorXd(count),
                Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const KnownPose& pose = *used[static_cast<std::size_t>(i)];
      out.inputs.row(i) = inputs(pose.measures).transpose();
      out.right[i] = pose.error <= to.right;
      out.weights[i] = pose.searched ? kOfSearched : 1;
    }
    return out;
  }

  static constexpr Eigen::Index kLeastPoses = 100;
  // Searches end at the poses that are judged; others fill in what they lack.
  static constexpr double kOfSearched = 3;

  LoadedWeights loaded_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::NetworkJudge,
                 "a small network on measures of the pictures, fitted to hands and boxes", "fits")
