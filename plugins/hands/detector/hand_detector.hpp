#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "hand_detection.hpp"

namespace hypotrack {

/// Finds hands and their landmarks in single pictures, by MediaPipe's networks. Equal pictures give
/// equal results, whatever was found before. Several threads may use it, each for its picture.
/// Detectors share the networks of a folder.
class HandDetector {
 public:
  struct Options {
    /// Where `hypotrack get detector` has put the networks; empty: default_folder().
    std::filesystem::path folder{};
    bool lite = false;            ///< smaller networks: quicker, less accurate
    double palm_threshold = 0.5;  ///< score of a sure palm; a fifth of it if no hand is found so
    double presence = 0.5;        ///< least probability of a hand
    int most_hands = 4;           ///< in a picture
    /// Length in pixels of the smallest hands that are looked for, in ever smaller tiles, where no
    /// larger one is found. 0 looks at the whole picture only.
    double smallest_hand = 50;
  };

  /// Reads the networks. Throws DataError, naming `hypotrack get detector`, if one is missing
  /// or damaged, and ConfigError for options out of range.
  explicit HandDetector(Options options);
  ~HandDetector();
  HandDetector(HandDetector&&) noexcept;
  HandDetector& operator=(HandDetector&&) noexcept;

  /// Returns the hands in an 8-bit BGR or grey picture, those with the surest palms first. Throws
  /// DataError for other pictures.
  std::vector<HandDetection> detect(const cv::Mat& picture) const;

  /// Returns hands as detect() does, but looks for small ones in one of the largest tiles only. The
  /// tiles take turns: give a frame's number.
  std::vector<HandDetection> glance(const cv::Mat& picture, int turn) const;

  /// Returns the hand at about these landmarks, such as projected ones; nothing if there is none or
  /// a landmark is NaN. Takes a fraction of the time of detect().
  std::optional<HandDetection> refine(const cv::Mat& picture, const HandPoints& guess,
                                      int threads = 1) const;

  /// Returns the hand at about the landmarks that it had in the last frame, moved to where it is
  /// expected. Runs the network once, and again only if the hand is elsewhere.
  std::optional<HandDetection> follow(const cv::Mat& picture, const HandPoints& guess,
                                      int threads = 1) const;

  /// Returns the folder in HYPOTRACK_HAND_DETECTOR, else hypotrack/hand_detector in XDG_DATA_HOME,
  /// else the same in ~/.local/share. Throws DataError if none of these variables nor HOME is set.
  static std::filesystem::path default_folder();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
