#include "track/smooth/trajectory_fit.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "track/tangent.hpp"

namespace hypotrack {
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
constexpr double kFirstDamping = 0.03;
constexpr int kPatience = 3;  // steps in a row without progress that end the fit
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
struct Beside {
  Beside(const Scene& scene, const Eigen::VectorXd& state, double share) {
    const std::vector<TangentPart> parts = tangent_parts(scene);
    steps.resize(parts.back().first + parts.back().size);
    states.resize(state.size(), steps.size() + 1);
    states.col(0) = state;
    for (const TangentPart& part : parts) {
      const double size = share * (part.kind == ParameterKind::position     ? kPositionStep
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

std::int64_t TrajectoryFit::evaluations_per_look() const {
  return residuals_->can_linearize() ? 2 : motion_->weight().size() + 1;
}

TrajectoryFit::Look TrajectoryFit::look(const Sight& sight, const Eigen::VectorXd& state,
                                        double blur) {
  const Eigen::Index d = motion_->weight().size();
  Look look{0, {Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)}};
  if (!sight) return look;
  cost_->prepare(*sight);
  if (residuals_->can_linearize()) {
    const Beside beside(*scene_, state, kSlopeShare);
    Eigen::VectorXd cost(1);
    cost_->evaluate(state, cost);
    look.cost = cost[0];
    if (std::isfinite(look.cost))
      look.equations = residuals_->linearize(beside.states, beside.steps, blur);
    return look;
  }
  const Beside beside(*scene_, state, 1);
  Eigen::MatrixXf residuals(residuals_->count(), d + 1);
  Eigen::VectorXd costs(d + 1);
  residuals_->evaluate(beside.states, residuals, costs);
  look.cost = costs[0];
  if (!costs.allFinite()) return look;
  const Eigen::VectorXf r = residuals.col(0);
  const Eigen::MatrixXf j = (residuals.rightCols(d).colwise() - r) *
                            beside.steps.cast<float>().cwiseInverse().asDiagonal();
  look.equations = {(j.transpose() * j).cast<double>(), (j.transpose() * r).cast<double>()};
  return look;
}

std::vector<Sight> TrajectoryFit::matt(const std::vector<Moment>& moments,
                                       const std::vector<Sight>& sights, std::size_t fixed) {
  if (!highlights_) return sights;
  highlights_->learn(sights, moments);
  std::vector<Sight> out = sights;
  for (std::size_t i = fixed; i < moments.size(); ++i)
    if (sights[i]) out[i] = highlights_->off(*sights[i], moments[i].state);
  return out;
}

std::vector<TrajectoryFit::Look> TrajectoryFit::look_at_all(const std::vector<Moment>& moments,
                                                            const std::vector<Sight>& sights,
                                                            std::size_t fixed, double blur) {
  std::vector<Look> looks;
  for (std::size_t i = fixed; i < moments.size(); ++i)
    looks.push_back(look(sights[i], moments[i].state, blur));
  return looks;
}

Eigen::VectorXd TrajectoryFit::step(const std::vector<Moment>& moments,
                                    const std::vector<Look>& looks,
                                    const std::vector<double>& damping, double looseness,
                                    std::size_t fixed) const {
  const Eigen::VectorXd& full_weight = motion_->weight();
  const Eigen::VectorXd weight = full_weight / (looseness * looseness);
  const Eigen::Index d = weight.size();
  const auto rows = static_cast<Eigen::Index>(looks.size()) * d;
  std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
  Eigen::VectorXd gradient(rows);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const NormalEquations& eq = looks[i].equations;
    const Eigen::Index at = static_cast<Eigen::Index>(i) * d;
    gradient.segment(at, d) = eq.g;
    for (Eigen::Index c = 0; c < d; ++c) {
      const double held = eq.a(c, c) + kHold * full_weight[c];
      entries.emplace_back(at + c, at + c, eq.a(c, c) + damping[i] * held);
      for (Eigen::Index r = c + 1; r < d; ++r) entries.emplace_back(at + r, at + c, eq.a(r, c));
    }
  }
  for (std::size_t i = 1; i + 1 < moments.size(); ++i) {
    if (i + 1 < fixed) continue;
    const MotionPrior::Change change = motion_->change(moments[i - 1], moments[i], moments[i + 1]);
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

std::vector<bool> TrajectoryFit::worth_taking(const std::vector<Moment>& moments,
                                              const std::vector<Moment>& trial,
                                              const std::vector<Look>& looks,
                                              const std::vector<Look>& seen,
                                              double looseness) const {
  // Viterbi algorithm over the decisions of two consecutive moments: bit 1 the first, bit 0 the
  // second.
  const std::size_t fixed = moments.size() - looks.size();
  const auto at = [&](std::size_t i, int taken) -> const Moment& {
    return taken ? trial[i] : moments[i];
  };
  const auto cost = [&](std::size_t i, int taken) {
    if (i < fixed) return taken ? kInfinity : 0.0;
    return (taken ? seen : looks)[i - fixed].cost;
  };
  std::vector<std::array<int, 4>> before(moments.size());  // best decision of the moment before the
                                                           // two
  std::array<double, 4> sum{};
  for (int two = 0; two < 4; ++two) sum[two] = cost(0, two >> 1) + cost(1, two & 1);
  for (std::size_t i = 2; i < moments.size(); ++i) {
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
  std::vector<bool> take(moments.size());
  for (std::size_t i = moments.size(); i-- > 0;) {
    take[i] = two & 1;
    two = (i >= 2 ? before[i][two] << 1 : 0) | two >> 1;
  }
  return take;
}

std::int64_t TrajectoryFit::improve(std::vector<Moment>& moments, const std::vector<Sight>& sights,
                                    std::size_t fixed, std::int64_t evaluations) {
  const std::int64_t looks_left = evaluations / evaluations_per_look();
  if (looks_left < 2 || moments.size() <= fixed || moments.size() < 2) return 0;
  const Eigen::Index d = motion_->weight().size();
  double blur = kFirstBlur, looseness = kFirstLooseness;
  std::vector<Sight> shown = matt(moments, sights, fixed);
  std::vector<Look> looks = look_at_all(moments, shown, fixed, blur);
  const double tightening = std::pow(kFirstLooseness, -2.0 / static_cast<double>(looks_left));
  std::vector<double> damping(looks.size(), kFirstDamping);
  std::int64_t done = 1;
  std::size_t learned = 0;
  for (int idle = 0; done < looks_left && idle < kPatience;) {
    if (highlights_ && learned < kLearnAfter.size() && done + 2 <= looks_left &&
        static_cast<double>(done) >= kLearnAfter[learned] * static_cast<double>(looks_left)) {
      ++learned;
      shown = matt(moments, sights, fixed);
      looks = look_at_all(moments, shown, fixed, blur);
      ++done;
    }
    const Eigen::VectorXd steps = step(moments, looks, damping, looseness, fixed);
    if (!steps.allFinite()) break;
    std::vector<Moment> trial = moments;
    for (std::size_t i = fixed; i < trial.size(); ++i)
      trial[i].state = moved(*scene_, moments[i].state,
                             steps.segment(static_cast<Eigen::Index>(i - fixed) * d, d));
    std::vector<Look> seen = look_at_all(trial, shown, fixed, blur);
    ++done;
    const std::vector<bool> take = worth_taking(moments, trial, looks, seen, looseness);
    double gain = 0;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      // Damp a frame more if its cost exceeds the prediction of its normal equations.
      const auto dx = steps.segment(static_cast<Eigen::Index>(i) * d, d);
      const NormalEquations& eq = looks[i].equations;
      const bool kept = seen[i].cost <= looks[i].cost + dx.dot(2 * eq.g + eq.a * dx) + kSurprise;
      const bool taken = take[i + fixed];
      damping[i] = std::clamp(damping[i] * (kept ? 0.4 : taken ? 2.0 : 8.0), 1e-4, 1e6);
      if (!taken) continue;
      gain = std::max(gain, dx.cwiseAbs().cwiseProduct(motion_->weight().cwiseSqrt()).maxCoeff());
      moments[i + fixed] = std::move(trial[i + fixed]);
      looks[i] = std::move(seen[i]);
    }
    const bool settled = gain < kLeastStep && looseness == 1;
    idle = settled ? idle + 1 : 0;
    if (settled) blur = std::max(blur / 2, kLeastBlur);
    looseness = std::max(looseness * tightening, 1.0);
  }
  return done * evaluations_per_look();
}

}  // namespace hypotrack
