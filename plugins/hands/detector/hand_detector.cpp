#include "hand_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>

#include "hand_detection.hpp"
#include "hand_landmarker.hpp"
#include "hand_picture.hpp"
#include "hypotrack/api/error.hpp"
#include "palm_detector.hpp"
#include "region.hpp"

namespace hypotrack {
namespace {

constexpr double kUnsure = 0.2;         // times the threshold of sure palms
constexpr double kUnsureAbsence = 0.1;  // times the greatest probability that there is no hand
using Rounds = hands::HandLandmarker::Rounds;
constexpr Rounds kRounds{2, 0.05};
constexpr Rounds kUnsureRounds{4, 0.05};    // the boxes of unsure palms are less accurate
constexpr Rounds kFollowingRounds{2, 0.1};  // landmarks of the last frame lie as the network's do
constexpr int kTries = 3;                   // palms that are looked at, for each hand there may be

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

HandDetector::Options checked(HandDetector::Options options) {
  const auto share = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1)) {
      throw ConfigError(fmt::format("the hand detector's {} is {}; expected 0 to 1", name, value));
    }
  };
  share("palm_threshold", options.palm_threshold);
  share("presence", options.presence);
  if (options.most_hands < 1) {
    throw ConfigError(fmt::format("the hand detector's most_hands is {}; expected 1 or more",
                                  options.most_hands));
  }
  if (!(options.smallest_hand >= 0)) {
    throw ConfigError(fmt::format("the hand detector's smallest_hand is {}; expected 0 or more",
                                  options.smallest_hand));
  }
  if (options.folder.empty()) options.folder = HandDetector::default_folder();
  return options;
}

void move_to_joints(HandDetection& hand) {
  hand.landmarks = hands::joints_of(hand.landmarks);
  hand.relative = hands::joints_of(hand.relative);
}

}  // namespace

struct HandDetector::Impl {
  explicit Impl(Options given)
      : options(checked(std::move(given))),
        palms(options.folder /
              (options.lite ? "palm_detection_lite.net" : "palm_detection_full.net")),
        landmarker(options.folder /
                   (options.lite ? "hand_landmark_lite.net" : "hand_landmark_full.net")) {}

  double least_score() const { return kUnsure * options.palm_threshold; }
  std::vector<HandDetection> detect(const hands::HandPicture& picture,
                                    std::optional<int> turn) const;
  std::vector<HandDetection> confirm(const hands::HandPicture& picture,
                                     std::span<const hands::Palm> found, bool sure) const;
  std::vector<HandDetection> detect_small(const hands::HandPicture& picture,
                                          std::span<const cv::Rect> tiles) const;
  std::optional<HandDetection> look(const cv::Mat& picture, const HandPoints& guess,
                                    const Rounds& rounds, int threads) const;

  Options options;
  hands::PalmDetector palms;
  hands::HandLandmarker landmarker;
};

/// Looks in all tiles, or in one of the largest ones.
std::vector<HandDetection> HandDetector::Impl::detect(const hands::HandPicture& picture,
                                                      std::optional<int> turn) const {
  const cv::Size size = picture.pixels.size();
  const cv::Rect whole({}, size);
  const std::vector<hands::Palm> found = palms.find(picture, whole, least_score());
  const auto unsure = std::find_if(found.begin(), found.end(), [&](const hands::Palm& palm) {
    return palm.score < options.palm_threshold;
  });
  std::vector<HandDetection> out = confirm(picture, {found.begin(), unsure}, true);
  if (out.empty()) out = confirm(picture, {unsure, found.end()}, false);
  for (const int side : hands::tile_sides(size, options.smallest_hand)) {
    if (!out.empty()) break;
    const std::vector<cv::Rect> tiles = hands::tiles(size, side);
    if (turn) {
      const auto one = static_cast<unsigned>(*turn) % tiles.size();
      return detect_small(picture, std::span(tiles).subspan(one, 1));
    }
    out = detect_small(picture, tiles);
  }
  return out;
}

/// Returns the hands at palms, which are sorted by score. Unsure palms take a surer hand.
std::vector<HandDetection> HandDetector::Impl::confirm(const hands::HandPicture& picture,
                                                       std::span<const hands::Palm> found,
                                                       bool sure) const {
  const double presence = sure ? options.presence : 1 - kUnsureAbsence * (1 - options.presence);
  const auto most = static_cast<std::size_t>(options.most_hands);
  std::vector<HandDetection> out;
  for (const hands::Palm& palm : found.first(std::min(found.size(), kTries * most))) {
    HandDetection hand =
        landmarker.find(picture, hands::region_of(palm), sure ? kRounds : kUnsureRounds);
    hand.palm_score = palm.score;
    if (hand.presence > presence) hands::add_or_merge(out, hand);
    if (out.size() == most) break;
  }
  return out;
}

/// Returns the hands in tiles of the picture.
std::vector<HandDetection> HandDetector::Impl::detect_small(const hands::HandPicture& picture,
                                                            std::span<const cv::Rect> tiles) const {
  std::vector<hands::Palm> found;
  for (const cv::Rect& tile : tiles) {
    const auto here = palms.find(picture, tile, least_score());
    found.insert(found.end(), here.begin(), here.end());
  }
  return confirm(picture, hands::without_overlaps(std::move(found)), false);
}

std::optional<HandDetection> HandDetector::Impl::look(const cv::Mat& picture,
                                                      const HandPoints& guess, const Rounds& rounds,
                                                      int threads) const {
  const hands::HandPicture color = hands::hand_picture(picture);
  if (!guess.allFinite()) return std::nullopt;
  HandDetection hand =
      landmarker.find(color, hands::region_of(hands::landmarks_at(guess)), rounds, threads);
  if (!(hand.presence > options.presence)) return std::nullopt;
  move_to_joints(hand);
  return hand;
}

HandDetector::HandDetector(Options options) : impl_(std::make_unique<Impl>(std::move(options))) {}
HandDetector::~HandDetector() = default;
HandDetector::HandDetector(HandDetector&&) noexcept = default;
HandDetector& HandDetector::operator=(HandDetector&&) noexcept = default;

std::vector<HandDetection> HandDetector::detect(const cv::Mat& picture) const {
  std::vector<HandDetection> found = impl_->detect(hands::hand_picture(picture), std::nullopt);
  std::ranges::for_each(found, move_to_joints);
  return found;
}

std::vector<HandDetection> HandDetector::glance(const cv::Mat& picture, int turn) const {
  std::vector<HandDetection> found = impl_->detect(hands::hand_picture(picture), turn);
  std::ranges::for_each(found, move_to_joints);
  return found;
}

std::optional<HandDetection> HandDetector::refine(const cv::Mat& picture, const HandPoints& guess,
                                                  int threads) const {
  return impl_->look(picture, guess, kRounds, threads);
}

std::optional<HandDetection> HandDetector::follow(const cv::Mat& picture, const HandPoints& guess,
                                                  int threads) const {
  return impl_->look(picture, guess, kFollowingRounds, threads);
}

std::filesystem::path HandDetector::default_folder() {
  if (const std::string folder = environment("HYPOTRACK_HAND_DETECTOR"); !folder.empty()) {
    return folder;
  }
  std::filesystem::path data = environment("XDG_DATA_HOME");
  if (data.empty()) {
    const std::string home = environment("HOME");
    if (home.empty()) {
      throw DataError(
          "the hand detector's folder is unknown, as HOME is not set; set HYPOTRACK_HAND_DETECTOR");
    }
    data = std::filesystem::path(home) / ".local" / "share";
  }
  return data / "hypotrack" / "hand_detector";
}

}  // namespace hypotrack
