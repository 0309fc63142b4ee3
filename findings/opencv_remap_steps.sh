#!/usr/bin/env bash
# Calibration and tracking undistort and warp pictures, then measure corners and motion to
# hundredths of a pixel. OpenCV's remap and warpAffine round every coordinate to 1/32 pixel before
# they interpolate, also for pictures and maps of floating point. A warp by 0.01 pixel changes
# nothing, so numerical derivatives by small warps are zero and refined shifts have steps of 0.03
# pixel.
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
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

int main() {
  cv::Mat ramp(9, 64, CV_32F);  // a pixel's value is its column
  for (int y = 0; y < ramp.rows; ++y)
    for (int x = 0; x < ramp.cols; ++x) ramp.at<float>(y, x) = static_cast<float>(x);
  bool rounded = true;
  for (const float shift : {0.01f, 0.02f, 0.04f}) {
    const cv::Mat column(1, 1, CV_32F, cv::Scalar(20 + shift)), row(1, 1, CV_32F, cv::Scalar(4));
    const cv::Mat motion = (cv::Mat_<double>(2, 3) << 1, 0, shift, 0, 1, 0);
    cv::Mat mapped, warped, exact;
    cv::remap(ramp, mapped, column, row, cv::INTER_LINEAR);
    cv::warpAffine(ramp, warped, motion, ramp.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    cv::getRectSubPix(ramp, cv::Size(1, 1), cv::Point2f(20 + shift, 4), exact, CV_32F);
    const float by_map = mapped.at<float>(0) - 20, by_warp = warped.at<float>(4, 20) - 20;
    std::printf("expected: %.5f as getRectSubPix: %.5f    seen: remap %.5f, warpAffine %.5f\n",
                shift, exact.at<float>(0) - 20, by_map, by_warp);
    const float step = std::round(shift * 32) / 32;
    rounded = rounded && std::abs(by_map - step) < 1e-4 && std::abs(by_warp - step) < 1e-4;
  }
  return rounded ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" \
  $(pkg-config --cflags opencv4) -lopencv_imgproc -lopencv_core
"$folder/main"
