#!/usr/bin/env bash
# Trackers find a patch again by its correlation with the next picture, and call a score near 1 a
# sure match. OpenCV's matchTemplate gives exactly 1 at every place for a patch of one colour, where
# the correlation is undefined, while a picture of one colour scores 0. Patches on sleeves, walls
# and saturated skin therefore win over textured ones unless their variance is checked first.
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
need libopencv-dev 4.6.0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'END'
#include <cstdio>
#include <opencv2/imgproc.hpp>

int main() {
  cv::Mat noise(60, 60, CV_8U), scores;
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  const cv::Mat gray(9, 9, CV_8U, cv::Scalar(77)), wall(60, 60, CV_8U, cv::Scalar(77));
  double least = 0, most = 0, wall_least = 0, wall_most = 0;
  cv::matchTemplate(noise, gray, scores, cv::TM_CCOEFF_NORMED);
  cv::minMaxLoc(scores, &least, &most);
  cv::matchTemplate(wall, noise(cv::Rect(3, 3, 9, 9)), scores, cv::TM_CCOEFF_NORMED);
  cv::minMaxLoc(scores, &wall_least, &wall_most);
  std::printf(
      "expected: a uniform patch correlates with noise as noise does with a uniform picture: 0 or "
      "no number\n");
  std::printf("seen:     %g to %g for the uniform patch, %g to %g for the uniform picture\n", least,
              most, wall_least, wall_most);
  return least == 1 && most == 1 && wall_least == 0 && wall_most == 0 ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" \
  $(pkg-config --cflags opencv4) -lopencv_imgproc -lopencv_core
"$folder/main"
