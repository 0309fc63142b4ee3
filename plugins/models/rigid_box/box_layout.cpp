#include <algorithm>
#include <cmath>

#include "box.hpp"

namespace hypotrack {
namespace {

constexpr double kLongestEdge = 1024;  // pixels, for a box longer than twice its mean edge
constexpr double kMeanEdge = 512;      // pixels

}  // namespace

BoxLayout layout_in_proportion(const Eigen::Vector3d& size) {
  const double scale = std::min(kLongestEdge / size.maxCoeff(), kMeanEdge / std::cbrt(size.prod()));
  const int row_height = static_cast<int>(std::ceil(size.maxCoeff() * scale + 2 * kFaceMargin));
  BoxLayout layout;
  int left = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double width = size[(axis + 1) % 3] * scale;
    const double height = size[(axis + 2) % 3] * scale;
    for (int negative = 0; negative < 2; ++negative) {
      layout.faces[static_cast<std::size_t>(2 * axis + negative)] =
          cv::Rect2d(left + kFaceMargin, negative * row_height + kFaceMargin, width, height);
    }
    left += static_cast<int>(std::ceil(width + 2 * kFaceMargin));
  }
  layout.image = cv::Size(left, 2 * row_height);
  return layout;
}

BoxLayout layout_of_pictures(const cv::Size& picture) {
  constexpr double kRim = 0.002;  // of the picture stays unused, so that filtering does not reach
                                  // the next
  BoxLayout layout{cv::Size(3 * picture.width, 2 * picture.height), {}};
  for (int face = 0; face < 6; ++face) {
    layout.faces[static_cast<std::size_t>(face)] =
        cv::Rect2d((face / 2 + kRim) * picture.width, (face % 2 + kRim) * picture.height,
                   (1 - 2 * kRim) * picture.width, (1 - 2 * kRim) * picture.height);
  }
  return layout;
}

}  // namespace hypotrack
