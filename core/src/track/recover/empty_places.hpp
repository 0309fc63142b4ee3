#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Remembers places that were searched in vain, so that they are not searched again while both
/// views look the same there.
class EmptyPlaces {
 public:
  /// Compares patches of about `radius` metres around a place.
  EmptyPlaces(const std::vector<Camera>& cameras, double radius);

  /// Counts a search at a place and returns whether it is worth it. Returns false if the place
  /// looks the same and was searched several times; every tenth time it returns true all the same.
  bool is_worth(const Frame& frame, const Eigen::Vector3d& center);

  /// Forgets the places that is_worth() was not asked about since the last call.
  void end_frame();
  void forget() { places_.clear(); }

 private:
  struct Place {
    Eigen::Vector3d center;
    std::array<cv::Mat3b, 2> patches;
    int searches = 0;
    bool seen = true;  ///< in this frame
  };
  cv::Mat3b patch(const Frame& frame, const Eigen::Vector3d& center, std::size_t view) const;

  std::vector<Camera> cameras_;
  double radius_;
  std::vector<Place> places_;
};

}  // namespace internal
}  // namespace hypotrack
