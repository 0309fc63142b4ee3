#!/usr/bin/env bash
# Skeleton files such as BVH, and many programs for animation, want three angles per joint and
# interpolate between frames. Eigen's eulerAngles keeps the first angle between 0 and 180 degrees,
# so a joint that passes through zero jumps by 180 degrees in all three. Every single frame is
# right, but curves, filters, joint limits and in-between frames of the exported motion are not.
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
need libeigen3-dev 3.4.0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'END'
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

Eigen::Matrix3d turn(double z, double y, double x) {
  const double degree = M_PI / 180;
  return (Eigen::AngleAxisd(z * degree, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(y * degree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(x * degree, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

int main() {
  const Eigen::Vector3d before = turn(1, 2, 3).eulerAngles(2, 1, 0) * 180 / M_PI;
  const Eigen::Vector3d after = turn(-1, 2, 3).eulerAngles(2, 1, 0) * 180 / M_PI;
  std::printf("expected: 1, 2, 3 degrees, then -1, 2, 3 degrees\n");
  std::printf("seen:     %.0f, %.0f, %.0f degrees, then %.0f, %.0f, %.0f degrees\n", before[0],
              before[1], before[2], after[0], after[1], after[2]);
  const bool jumps = (before - Eigen::Vector3d(1, 2, 3)).norm() < 1e-6 &&
                     (after - Eigen::Vector3d(179, 178, -177)).norm() < 1e-6;
  return jumps ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" $(pkg-config --cflags eigen3)
"$folder/main"
