#include "hand_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string>

#include "duplicates.hpp"
#include "hand_landmarker.hpp"
#include "hypotrack/error.hpp"
#include "joints.hpp"
#include "palm_detector.hpp"
#include "picture_check.hpp"
#include "tiles.hpp"

namespace hypotrack {
namespace {

constexpr double kUnsure = 0.2;         // times the threshold of sure palms
constexpr double kUnsureAbsence = 0.1;  // times the greatest probability that there is no hand
constexpr int kRounds = 2;              // of the landmark network for a hand
constexpr int kUnsureRounds = 4;        // the boxes of unsure palms are less accurate
constexpr int kTries = 3;               // palms that are looked at, for each hand there may be

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
              (options.lite ? "palm_detection_lite.onnx" : "palm_detection_full.onnx")),
        landmarker(options.folder /
                   (options.lite ? "hand_landmark_lite.onnx" : "hand_landmark_full.onnx")) {}

  double least_score() const { return kUnsure * options.palm_threshold; }
  std::vector<HandDetection> detect(const cv::Mat& picture, bool thorough);
  std::vector<HandDetection> confirm(const cv::Mat& picture, std::span<const hands::Palm> found,
                                     bool sure);
  std::vector<HandDetection> detect_small(const cv::Mat& picture, int side);

  Options options;
  hands::PalmDetector palms;
  hands::HandLandmarker landmarker;
};

std::vector<HandDetection> HandDetector::Impl::detect(const cv::Mat& picture, bool thorough) {
  const cv::Rect whole({}, picture.size());
  const std::vector<hands::Palm> found = palms.find(picture, whole, least_score());
  const auto unsure = std::find_if(found.begin(), found.end(), [&](const hands::Palm& palm) {
    return palm.score < options.palm_threshold;
  });
  std::vector<HandDetection> out = confirm(picture, {found.begin(), unsure}, true);
  if (out.empty()) out = confirm(picture, {unsure, found.end()}, false);
  for (const int side : hands::tile_sides(picture.size(), options.smallest_hand)) {
    if (!out.empty()) break;
    out = detect_small(picture, side);
    if (!thorough) break;
  }
  return out;
}

/// Returns the hands at palms, which are sorted by score. Unsure palms take a surer hand.
std::vector<HandDetection> HandDetector::Impl::confirm(const cv::Mat& picture,
                                                       std::span<const hands::Palm> found,
                                                       bool sure) {
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
std::vector<HandDetection> HandDetector::Impl::detect_small(const cv::Mat& picture, int side) {
  std::vector<hands::Palm> found;
  for (const cv::Rect& tile : hands::tiles(picture.size(), side)) {
    const auto here = palms.find(picture, tile, least_score());
    found.insert(found.end(), here.begin(), here.end());
  }
  return confirm(picture, hands::without_overlaps(std::move(found)), false);
}

HandDetector::HandDetector(Options options) : impl_(std::make_unique<Impl>(std::move(options))) {}
HandDetector::~HandDetector() = default;
HandDetector::HandDetector(HandDetector&&) noexcept = default;
HandDetector& HandDetector::operator=(HandDetector&&) noexcept = default;

std::vector<HandDetection> HandDetector::detect(const cv::Mat& picture, bool thorough) {
  std::vector<HandDetection> found = impl_->detect(hands::checked_color(picture), thorough);
  std::ranges::for_each(found, move_to_joints);
  return found;
}

std::optional<HandDetection> HandDetector::refine(const cv::Mat& picture, const HandPoints& guess) {
  const cv::Mat color = hands::checked_color(picture);
  if (!guess.allFinite()) return std::nullopt;
  HandDetection hand =
      impl_->landmarker.find(color, hands::region_of(hands::landmarks_at(guess)), kRounds);
  if (!(hand.presence > impl_->options.presence)) return std::nullopt;
  move_to_joints(hand);
  return hand;
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
