#pragma once

#include <filesystem>

#include "hand_detection.hpp"
#include "hand_picture.hpp"
#include "network.hpp"
#include "region.hpp"

namespace hypotrack::hands {

/// Finds the landmarks of a hand in a region of a picture by MediaPipe's hand landmark network.
/// Several threads may use it.
class HandLandmarker {
 public:
  /// Reads the network. Throws DataError as Network does.
  explicit HandLandmarker(const std::filesystem::path& file);

  /// How often the network looks for a hand.
  struct Rounds {
    int most;      ///< each one in the region of the landmarks that the last one found
    double share;  ///< of its side by which the region has to move for another one
  };

  /// Returns the hand of a region of a picture; its palm's score is 1.
  HandDetection find(const HandPicture& picture, Region region, const Rounds& rounds,
                     int threads = 1) const;

 private:
  HandDetection find_once(const HandPicture& picture, const Region& region, int threads) const;

  Network network_;
};

}  // namespace hypotrack::hands
