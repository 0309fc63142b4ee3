#!/usr/bin/env bash
# A tracker searches with a budget of evaluations and no tolerances, and its cost is flat where the
# model is out of view. NLopt's SLSQP ends there with a negative result code, which its C++ and
# Python interfaces throw as an exception, where other gradient methods end with success. A program
# that takes negative codes for failures of the search loses frames in which nothing went wrong.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:12
need libnlopt-dev 2.7.1

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'END'
#include <nlopt.h>

#include <cstdio>

double flat(unsigned n, const double*, double* gradient, void*) {
  for (unsigned i = 0; gradient && i < n; ++i) gradient[i] = 0;
  return 1;
}

nlopt_result minimise(nlopt_algorithm algorithm) {
  const double lower[] = {-1, -1}, upper[] = {1, 1};
  double x[] = {0.1, 0.2}, cost = 0;
  nlopt_opt search = nlopt_create(algorithm, 2);
  nlopt_set_lower_bounds(search, lower);
  nlopt_set_upper_bounds(search, upper);
  nlopt_set_min_objective(search, flat, nullptr);
  nlopt_set_maxeval(search, 100);
  const nlopt_result result = nlopt_optimize(search, x, &cost);
  nlopt_destroy(search);
  return result;
}

int main() {
  const nlopt_result slsqp = minimise(NLOPT_LD_SLSQP), lbfgs = minimise(NLOPT_LD_LBFGS),
                     mma = minimise(NLOPT_LD_MMA);
  std::printf(
      "expected: SLSQP, LBFGS and MMA end with success (a positive code) on a constant cost\n");
  std::printf("seen:     SLSQP %d (%s), LBFGS %d (%s), MMA %d (%s)\n", slsqp,
              nlopt_result_to_string(slsqp), lbfgs, nlopt_result_to_string(lbfgs), mma,
              nlopt_result_to_string(mma));
  return slsqp == NLOPT_ROUNDOFF_LIMITED && lbfgs > 0 && mma > 0 ? 0 : 1;
}
END
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lnlopt
"$folder/main"
