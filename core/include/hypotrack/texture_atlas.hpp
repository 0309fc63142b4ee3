#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Joins pictures into one texture, because a model has one. Equal pictures share a place.
class HYPOTRACK_API TextureAtlas {
 public:
  /// Adds an 8-bit BGR picture and returns the index of its place.
  std::size_t add(const cv::Mat& picture);
  /// Adds a colour, RGB in [0, 1], and returns the index of its place.
  std::size_t add(const Eigen::Vector3f& color);

  /// Returns the texture. Throws DataError, beginning with `where`, if it were too large.
  cv::Mat texture(const std::string& where);

  /// Moves texture coordinates (2xN, v upwards) from a picture to its place in texture(), which was
  /// called before.
  Eigen::Matrix2Xf moved(std::size_t index, const Eigen::Ref<const Eigen::Matrix2Xf>& uv) const;

 private:
  struct Place {
    int left = 0, top = 0, width = 0, height = 0;
  };
  std::vector<cv::Mat> pictures_;
  std::vector<Place> places_;
  int width_ = 0, height_ = 0;
};

}  // namespace hypotrack
