#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core/mat.hpp>
#include <string>

#include "params.hpp"
#include "rectified_pair.hpp"

namespace hypotrack::depth_from_stereo {

/// Computes the depth of a rectified pair by semi-global matching: Hirschmueller, "Stereo
/// processing by semiglobal matching and mutual information", PAMI 2008, as OpenCV's StereoSGBM
/// does it.
class Matcher {
 public:
  /// The pair must outlive the matcher. Throws ConfigError, naming `where`, if the range of depths
  /// is empty or needs disparities that the images have no room for.
  Matcher(const Params& params, const RectifiedPair& pair, const std::string& where);

  /// Returns depth in metres along the axis of pair.camera(), 32-bit float. It is 0 where nothing
  /// matches and where either camera saw nothing. Both images are rectified, 8-bit BGR.
  cv::Mat depth(const cv::Mat& first, const cv::Mat& second);

 private:
  const RectifiedPair* pair_;
  int lowest_ = 0;  ///< least disparity
  int count_ = 0;   ///< number of disparities
  cv::Ptr<cv::StereoSGBM> sgbm_;
};

}  // namespace hypotrack::depth_from_stereo
