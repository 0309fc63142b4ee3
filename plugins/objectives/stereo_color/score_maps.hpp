#pragma once

#include <opencv2/core/mat.hpp>

#include "score.hpp"

namespace hypotrack::stereo_color {

/// What measure() finds at every pixel of `here`; NaN where not both views see the surface.
struct ScoreMaps {
  cv::Mat1f difference;   ///< ||I_l - I_r||
  cv::Mat1f consistency;  ///< s
};

ScoreMaps score_maps(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                     const Params& params);

/// Returns the weight C of every pixel.
cv::Mat1f weight_map(const Features& features);

}  // namespace hypotrack::stereo_color
