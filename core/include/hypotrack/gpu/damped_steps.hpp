#pragma once

#include <cstdint>

/// Decisions of a search by damped least squares, shared by the CPU and CUDA kernels; without
/// Eigen. A CUDA kernel can include this file (constexpr functions: compile with
/// --expt-relaxed-constexpr).
namespace hypotrack {

/// Settings of a search by damped least squares (plugins/optimizers/levenberg_marquardt).
struct DampedSettings {
  std::int64_t evaluations = 1;    ///< budget
  std::int64_t price = 1;          ///< evaluations that normal equations count as
  std::int32_t iterations = 0;     ///< most normal equations; 0: as many as the budget allows
  std::int32_t trials = 3;         ///< steps of different damping that are evaluated together
  std::int32_t patience = 1;       ///< normal equations without gain before they become finer
  bool leaves_infeasible = false;  ///< there are normal equations at points of infinite cost, too
  double difference = 0.01;        ///< steps of Jacobians, as a share of the spread
  double blur = 1.5;               ///< pixels
  double finest = 0.2;             ///< share of the first differences or blur
  double damping = 0.1;            ///< the first
  double damping_factor = 4;       ///< between the dampings of neighbouring trials
  double mean_share = 0;           ///< share of the mean curvature in the damping
  double tolerance = 1e-4;         ///< a shorter step, in spreads, is no gain
};

/// Says what a search by damped least squares does next. The caller keeps the points, evaluates
/// and solves.
struct DampedSteps {
  /// What the search waits for.
  enum class Wants : std::int32_t { costs, equations, nothing };
  DampedSettings settings;
  std::int64_t evaluations = 0;  ///< so far
  Wants wants = Wants::costs;
  std::int32_t points = 1;  ///< whose costs it wants: the start, or trial steps
  std::int32_t round = -1;  ///< of trial steps; -1: the start
  std::int32_t jacobians = 0, failed = 0;
  double cost = 0;  ///< at the current point
  double damping = 0;
  double lowest = 0;    ///< damping of the first trial step
  double fineness = 1;  ///< of differences or blur, as a share of the first

  DampedSteps() = default;
  constexpr explicit DampedSteps(const DampedSettings& all) : settings(all), damping(all.damping) {}

  constexpr std::int64_t remaining() const { return settings.evaluations - evaluations; }
  /// Returns the damping of a trial step.
  constexpr double damping_of(std::int32_t trial) const { return by_factor(lowest, trial); }
  constexpr bool is_feasible() const { return cost - cost == 0; }  // it is finite

  /// Goes on from a point of this cost: the start, or one that was found beside an infeasible one.
  constexpr void begin(double its_cost) {
    cost = its_cost;
    want_equations();
  }
  /// Moves to a trial step of lower cost, which is `moved` spreads long.
  constexpr void accept(std::int32_t trial, double its_cost, double moved) {
    damping = limited(damping_of(trial));
    cost = its_cost;
    end_of_steps(moved > settings.tolerance);
  }
  /// Takes note that no trial step lowers the cost.
  constexpr void reject() {
    constexpr std::int32_t kRounds = 2;  // of trials with the same equations
    damping = limited(damping_of(points));
    if (round + 1 < kRounds && remaining() > 0) {
      want_trials(round + 1);
    } else {
      end_of_steps(false);
    }
  }
  /// Goes on with normal equations at the current point.
  constexpr void solve() {
    ++jacobians;
    want_trials(0);
  }
  /// Goes on with new equations after those of an infeasible point, or ends where they fail again.
  constexpr void leave(bool found_feasible, double its_cost) {
    ++jacobians;
    if (found_feasible) {
      begin(its_cost);
    } else if (++failed == 2) {
      wants = Wants::nothing;
    } else {
      want_equations();
    }
  }

 private:
  // Without std::clamp() and std::min(): a reference to a constant would be one to memory of the
  // host.
  static constexpr double limited(double damping) {
    constexpr double kLeast = 1e-7, kMost = 1e7;
    return damping < kLeast ? kLeast : damping > kMost ? kMost : damping;
  }
  constexpr double by_factor(double x, std::int32_t power) const {
    for (; power > 0; --power) x *= settings.damping_factor;
    for (; power < 0; ++power) x /= settings.damping_factor;
    return x;
  }
  constexpr void want_equations() {
    const bool allowed = settings.iterations == 0 || jacobians < settings.iterations;
    const bool enough = remaining() > settings.price;  // otherwise nothing is left for a step
    const bool possible = is_feasible() || settings.leaves_infeasible;
    wants = allowed && enough && possible ? Wants::equations : Wants::nothing;
  }
  constexpr void want_trials(std::int32_t number) {
    wants = Wants::costs;
    round = number;
    const std::int64_t left = remaining();
    points = left < settings.trials ? static_cast<std::int32_t>(left) : settings.trials;
    lowest = by_factor(damping, round == 0 ? -(points / 2) : 0);
  }
  constexpr void end_of_steps(bool gained) {
    if (gained) {
      failed = 0;
    } else if (++failed == settings.patience) {
      failed = 0;
      fineness *= 0.5;
      if (fineness < settings.finest) {
        wants = Wants::nothing;
        return;
      }
      if (damping > settings.damping) damping = settings.damping;
    }
    want_equations();
  }
};

}  // namespace hypotrack
