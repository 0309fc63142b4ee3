#!/usr/bin/env bash
# To save time, trackers shrink colours with a filter, and masks and depth with the nearest pixel
# because these must not be blended. OpenCV's INTER_NEAREST takes the top left pixel of each block
# instead of its middle, so at a quarter of the size masks and depth lie 1.5 pixels beside the
# colours. Silhouettes and back-projected points are then biased to one side, although both pictures
# have the same size.
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
  cv::Mat columns(64, 64, CV_32F);  // a pixel's value is its column
  for (int y = 0; y < columns.rows; ++y)
    for (int x = 0; x < columns.cols; ++x) columns.at<float>(y, x) = static_cast<float>(x);
  const auto shrunk = [&](int filter) {
    cv::Mat small;
    cv::resize(columns, small, cv::Size(16, 16), 0, 0, filter);
    return small.at<float>(5, 5);
  };
  const float colour = shrunk(cv::INTER_AREA), mask = shrunk(cv::INTER_NEAREST),
              exact = shrunk(cv::INTER_NEAREST_EXACT);
  std::printf(
      "expected: pixel 5 shows the middle of columns 20 to 23, within half a column of 21.5, with "
      "every filter\n");
  std::printf("seen:     area %.1f, nearest %.1f, nearest exact %.1f\n", colour, mask, exact);
  return colour == 21.5f && mask == 20 && exact >= 21 && exact <= 22 ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" \
  $(pkg-config --cflags opencv4) -lopencv_imgproc -lopencv_core
"$folder/main"
