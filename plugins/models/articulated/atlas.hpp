#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace hypotrack::articulated {

/// Several pictures in one, because a model has one texture. Equal pictures share a place.
class Atlas {
 public:
  /// Adds an 8-bit BGR picture and returns the index of its place.
  std::size_t add(const cv::Mat& picture);

  /// Returns the texture. Throws DataError, beginning with `where`, if it were too large.
  cv::Mat texture(const std::string& where);

  /// A place in texture(), relative to its size, rows downwards.
  struct Place {
    double left, top, width, height;
  };
  /// Requires texture() before.
  Place place(std::size_t index) const;

 private:
  std::vector<cv::Mat> pictures_;
  std::vector<cv::Rect> places_;
  cv::Size size_;
};

}  // namespace hypotrack::articulated
