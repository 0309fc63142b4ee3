#!/usr/bin/env bash
# Ceres Solver tells callbacks the length of each step, step_norm. Version 2.2 reports 0 for every step up to
# and including the first success. A calibration or pose refinement whose callback ends it at short steps, as
# with Ceres 2.1, ends after its first step, far from the solution, and Ceres calls that a success.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:14
need libceres-dev 2.2.0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'CODE'
#include <ceres/ceres.h>

#include <cmath>
#include <cstdio>

// How far a camera's distance to a scale of 1 m is off, if the scale is seen 400 pixels long.
struct Seen {
  template <class T>
  bool operator()(const T* distance, T* off) const {
    off[0] = 800.0 / distance[0] - 400.0;
    return true;
  }
};

struct UntilShort : ceres::IterationCallback {
  double last = 0, told = -1, moved = -1;
  const double* distance = nullptr;
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& step) override {
    if (step.iteration == 1) told = step.step_norm, moved = std::abs(*distance - last);
    last = *distance;
    const bool is_short = step.iteration > 0 && step.step_norm < 1e-6;
    return is_short ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
};

int main() {
  double distance = 1;
  UntilShort until;
  until.distance = &distance;
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Seen, 1, 1>(new Seen), nullptr, &distance);
  ceres::Solver::Options options;
  options.callbacks.push_back(&until);
  options.update_state_every_iteration = true;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::printf("expected: the first step is as long as the parameter moves; the answer is 2 m\n");
  std::printf("seen:     it moves by %.3f m, step_norm is %g; the answer is %.3f m, %s\n", until.moved,
              until.told, distance, summary.IsSolutionUsable() ? "called usable" : "a failure");
  const bool ended = until.told == 0 && until.moved > 0.1 && std::abs(distance - 2) > 0.1;
  return ended && summary.IsSolutionUsable() ? 0 : 1;
}
CODE
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" $(pkg-config --cflags eigen3) -lceres -lglog
"$folder/main"
