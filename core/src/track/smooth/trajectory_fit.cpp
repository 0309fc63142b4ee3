#include "track/smooth/trajectory_fit.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

// Steps of finite differences. Slopes need motion by a fraction of a pixel, residuals by about one
// pixel.
constexpr double kSlopeShare = 0.1;
constexpr double kPositionStep = 0.001;
constexpr double kRotationStep = 0.75 * kDegree;
constexpr double kAngleStep = 1.5 * kDegree;

constexpr double kFirstBlur = 1.5, kLeastBlur = 0.5;  // pixels
// Damping scales a dimension's diagonal plus this share of the prior's weight, which holds
// dimensions that the pictures do not show.
constexpr double kHold = 1;
constexpr DampingSchedule kDamping = {
    .first = 0.03, .least = 1e-4, .most = 1e6, .accepted = 0.4, .rejected = 8};
constexpr double kDearer = 2;  // factor after a step that was taken but cost more than predicted
constexpr int kPatience = 3;   // steps in a row without progress that end the fit
// Initial factor on the allowed change of velocity. It falls with every step to 1 at half the
// budget. Otherwise the first step would trade the pictures' fit for smoothness, which
// frame-by-frame search does not have.
constexpr double kFirstLooseness = 8;
// Shares of the budget after which highlights are relearned from better states. Each relearning
// linearises all frames again, as their costs have changed.
constexpr std::array kLearnAfter = {0.2, 0.4, 0.6};
constexpr double kLeastStep = 1e-3;  // relative to the change of velocity in a second
constexpr double kSurprise = 0.5;  // tolerated excess of a cost over its prediction, as pixels are
                                   // noisy
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// States that differ from one by steps[i] in one dimension, in the other direction at a limit.
struct PerturbedStates {
  PerturbedStates(const Scene& scene, const Eigen::VectorXd& state, double share) {
    const std::vector<TangentPart> parts = tangent_parts(scene);
    steps.resize(parts.back().first + parts.back().size);
    states.resize(state.size(), steps.size() + 1);
    states.col(0) = state;
    for (const TangentPart& part : parts) {
      const double size = share * (is_in_metres(part.kind)                  ? kPositionStep
                                   : part.kind == ParameterKind::quaternion ? kRotationStep
                                                                            : kAngleStep);
      for (Eigen::Index d = part.first; d < part.first + part.size; ++d) {
        Eigen::VectorXd off = size * Eigen::VectorXd::Unit(steps.size(), d);
        states.col(d + 1) = moved(scene, state, off);
        if (difference(scene, state, states.col(d + 1))[d] < 0.5 * size)
          states.col(d + 1) = moved(scene, state, -off);
        steps[d] = difference(scene, state, states.col(d + 1))[d];
      }
    }
  }

  Eigen::MatrixXd states;  ///< the state itself first
  Eigen::VectorXd steps;
};

}  // namespace

std::int64_t TrajectoryFit::evaluations_per_linearization() const {
  const Eigen::Index d = motion_->weight().size();
  return residuals_->can_linearize() ? 1 + residuals_->linearize_price(d) : 1 + d;
}

TrajectoryFit::LinearizedFrame TrajectoryFit::linearize(const FrameTiles& tiles,
                                                        const Eigen::VectorXd& state, double blur) {
  const Eigen::Index d = motion_->weight().size();
  LinearizedFrame frame{0, {Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)}};
  if (!tiles) return frame;
  cost_->prepare(*tiles);
  if (residuals_->can_linearize()) {
    const double share = residuals_->draws_neighbours() ? 1 : kSlopeShare;
    const PerturbedStates perturbed(*scene_, state, share);
    Eigen::VectorXd cost(1);
    cost_->evaluate(state, cost);
    frame.cost = cost[0];
    if (std::isfinite(frame.cost))
      frame.equations = residuals_->linearize(perturbed.states, perturbed.steps, blur);
    return frame;
  }
  const PerturbedStates perturbed(*scene_, state, 1);
  Eigen::MatrixXf residuals(residuals_->count(), d + 1);
  Eigen::VectorXd costs(d + 1);
  residuals_->evaluate(perturbed.states, residuals, costs);
  frame.cost = costs[0];
  if (!costs.allFinite()) return frame;
  const Eigen::VectorXf r = residuals.col(0);
  const Eigen::MatrixXf j = (residuals.rightCols(d).colwise() - r) *
                            perturbed.steps.cast<float>().cwiseInverse().asDiagonal();
  frame.equations = {(j.transpose() * j).cast<double>(), (j.transpose() * r).cast<double>()};
  return frame;
}

std::vector<FrameTiles> TrajectoryFit::without_highlights(const std::vector<TimedState>& states,
                                                          const std::vector<FrameTiles>& tiles,
                                                          std::size_t fixed) {
  if (!highlights_) return tiles;
  highlights_->learn(tiles, states);
  std::vector<FrameTiles> out = tiles;
  for (std::size_t i = fixed; i < states.size(); ++i)
    if (tiles[i]) out[i] = highlights_->off(*tiles[i], states[i].state);
  return out;
}

std::vector<TrajectoryFit::LinearizedFrame> TrajectoryFit::linearize_all(
    const std::vector<TimedState>& states, const std::vector<FrameTiles>& tiles, std::size_t fixed,
    double blur) {
  std::vector<LinearizedFrame> frames;
  for (std::size_t i = fixed; i < states.size(); ++i)
    frames.push_back(linearize(tiles[i], states[i].state, blur));
  return frames;
}

Eigen::VectorXd TrajectoryFit::step(const std::vector<TimedState>& states,
                                    const std::vector<LinearizedFrame>& frames,
                                    const std::vector<Damping>& damping, double looseness,
                                    std::size_t fixed) const {
  const Eigen::VectorXd& full_weight = motion_->weight();
  const Eigen::VectorXd weight = full_weight / (looseness * looseness);
  const Eigen::Index d = weight.size();
  const auto rows = static_cast<Eigen::Index>(frames.size()) * d;
  std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
  Eigen::VectorXd gradient(rows);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const NormalEquations& eq = frames[i].equations;
    const Eigen::Index at = static_cast<Eigen::Index>(i) * d;
    gradient.segment(at, d) = eq.g;
    for (Eigen::Index c = 0; c < d; ++c) {
      const double held = eq.a(c, c) + kHold * full_weight[c];
      entries.emplace_back(at + c, at + c, eq.a(c, c) + damping[i].value() * held);
      for (Eigen::Index r = c + 1; r < d; ++r) entries.emplace_back(at + r, at + c, eq.a(r, c));
    }
  }
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    if (i + 1 < fixed) continue;
    const MotionPrior::Change change = motion_->change(states[i - 1], states[i], states[i + 1]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (i + k - 1 < fixed) continue;
      const Eigen::Index row = static_cast<Eigen::Index>(i + k - 1 - fixed) * d;
      gradient.segment(row, d) += change.factor[k] * weight.cwiseProduct(change.residual);
      for (std::size_t m = 0; m <= k; ++m) {
        if (i + m - 1 < fixed) continue;
        const Eigen::Index column = static_cast<Eigen::Index>(i + m - 1 - fixed) * d;
        for (Eigen::Index n = 0; n < d; ++n)
          entries.emplace_back(row + n, column + n,
                               change.factor[k] * change.factor[m] * weight[n]);
      }
    }
  }
  Eigen::SparseMatrix<double> a(rows, rows);
  a.setFromTriplets(entries.begin(), entries.end());
  // In the order of time the factor is a narrow band.
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower,
                              Eigen::NaturalOrdering<int>>
      solver(a);
  return solver.solve(-gradient);
}

std::vector<bool> TrajectoryFit::worth_taking(const std::vector<TimedState>& states,
                                              const std::vector<TimedState>& trial,
                                              const std::vector<LinearizedFrame>& frames,
                                              const std::vector<LinearizedFrame>& trial_frames,
                                              double looseness) const {
  // Viterbi algorithm over the decisions of two consecutive states: bit 1 the first, bit 0 the
  // second.
  const std::size_t fixed = states.size() - frames.size();
  const auto at = [&](std::size_t i, int taken) -> const TimedState& {
    return taken ? trial[i] : states[i];
  };
  const auto cost = [&](std::size_t i, int taken) {
    if (i < fixed) return taken ? kInfinity : 0.0;
    return (taken ? trial_frames : frames)[i - fixed].cost;
  };
  std::vector<std::array<int, 4>> before(states.size());  // best decision of the state before the
                                                          // two
  std::array<double, 4> sum{};
  for (int two = 0; two < 4; ++two) sum[two] = cost(0, two >> 1) + cost(1, two & 1);
  for (std::size_t i = 2; i < states.size(); ++i) {
    std::array<double, 4> next{};
    for (int two = 0; two < 4; ++two) {
      next[two] = kInfinity;
      for (int first = 0; first < 2; ++first) {
        const double motion = motion_->cost(at(i - 2, first), at(i - 1, two >> 1), at(i, two & 1));
        const double total = sum[first << 1 | two >> 1] + motion / (looseness * looseness);
        if (total < next[two]) {
          next[two] = total;
          before[i][two] = first;
        }
      }
      next[two] += cost(i, two & 1);
    }
    sum = next;
  }
  auto two = static_cast<int>(std::ranges::min_element(sum) - sum.begin());
  std::vector<bool> take(states.size());
  for (std::size_t i = states.size(); i-- > 0;) {
    take[i] = two & 1;
    two = (i >= 2 ? before[i][two] << 1 : 0) | two >> 1;
  }
  return take;
}

std::int64_t TrajectoryFit::improve(std::vector<TimedState>& states,
                                    const std::vector<FrameTiles>& tiles, std::size_t fixed,
                                    std::int64_t evaluations) {
  const std::int64_t allowed = evaluations / evaluations_per_linearization();
  if (allowed < 2 || states.size() <= fixed || states.size() < 2) return 0;
  const Eigen::Index d = motion_->weight().size();
  double blur = kFirstBlur, looseness = kFirstLooseness;
  std::vector<FrameTiles> shown = without_highlights(states, tiles, fixed);
  std::vector<LinearizedFrame> frames = linearize_all(states, shown, fixed, blur);
  const double tightening = std::pow(kFirstLooseness, -2.0 / static_cast<double>(allowed));
  std::vector<Damping> damping(frames.size(), Damping(kDamping));
  std::int64_t done = 1;
  std::size_t learned = 0;
  for (int idle = 0; done < allowed && idle < kPatience;) {
    if (highlights_ && learned < kLearnAfter.size() && done + 2 <= allowed &&
        static_cast<double>(done) >= kLearnAfter[learned] * static_cast<double>(allowed)) {
      ++learned;
      shown = without_highlights(states, tiles, fixed);
      frames = linearize_all(states, shown, fixed, blur);
      ++done;
    }
    const Eigen::VectorXd steps = step(states, frames, damping, looseness, fixed);
    if (!steps.allFinite()) break;
    std::vector<TimedState> trial = states;
    for (std::size_t i = fixed; i < trial.size(); ++i)
      trial[i].state = moved(*scene_, states[i].state,
                             steps.segment(static_cast<Eigen::Index>(i - fixed) * d, d));
    std::vector<LinearizedFrame> trial_frames = linearize_all(trial, shown, fixed, blur);
    ++done;
    const std::vector<bool> take = worth_taking(states, trial, frames, trial_frames, looseness);
    double gain = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      // Damp a frame more if its cost exceeds the prediction of its normal equations.
      const auto dx = steps.segment(static_cast<Eigen::Index>(i) * d, d);
      const NormalEquations& eq = frames[i].equations;
      const bool kept =
          trial_frames[i].cost <= frames[i].cost + dx.dot(2 * eq.g + eq.a * dx) + kSurprise;
      const bool taken = take[i + fixed];
      if (kept) {
        damping[i].accept();
      } else if (taken) {
        damping[i].scale(kDearer);
      } else {
        damping[i].reject();
      }
      if (!taken) continue;
      gain = std::max(gain, dx.cwiseAbs().cwiseProduct(motion_->weight().cwiseSqrt()).maxCoeff());
      states[i + fixed] = std::move(trial[i + fixed]);
      frames[i] = std::move(trial_frames[i]);
    }
    const bool settled = gain < kLeastStep && looseness == 1;
    idle = settled ? idle + 1 : 0;
    if (settled) blur = std::max(blur / 2, kLeastBlur);
    looseness = std::max(looseness * tightening, 1.0);
  }
  return done * evaluations_per_linearization();
}

}  // namespace hypotrack::internal
