#include "calibrate/board/charuco.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calibrate/board/marker_corners.hpp"
#include "calibrate/board/marker_layout.hpp"

// From OpenCV 4.7 on, the markers are in the module objdetect.
#define HYPOTRACK_NEW_MARKERS (CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7)
#if HYPOTRACK_NEW_MARKERS
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace hypotrack::calibrate {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 21> kDictionaries = {
    {{"4X4_50", cv::aruco::DICT_4X4_50},
     {"4X4_100", cv::aruco::DICT_4X4_100},
     {"4X4_250", cv::aruco::DICT_4X4_250},
     {"4X4_1000", cv::aruco::DICT_4X4_1000},
     {"5X5_50", cv::aruco::DICT_5X5_50},
     {"5X5_100", cv::aruco::DICT_5X5_100},
     {"5X5_250", cv::aruco::DICT_5X5_250},
     {"5X5_1000", cv::aruco::DICT_5X5_1000},
     {"6X6_50", cv::aruco::DICT_6X6_50},
     {"6X6_100", cv::aruco::DICT_6X6_100},
     {"6X6_250", cv::aruco::DICT_6X6_250},
     {"6X6_1000", cv::aruco::DICT_6X6_1000},
     {"7X7_50", cv::aruco::DICT_7X7_50},
     {"7X7_100", cv::aruco::DICT_7X7_100},
     {"7X7_250", cv::aruco::DICT_7X7_250},
     {"7X7_1000", cv::aruco::DICT_7X7_1000},
     {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
     {"APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
     {"APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
     {"APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
     {"APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11}}};

/// Between outlines that are not the same, in perimeters. With the usual 0.05, OpenCV takes a
/// marker of 0.8 of its square and the white square around it for the same, and keeps the square.
constexpr double kLeastDistance = 0.03;

/// Returns OpenCV's number of a board's dictionary.
int dictionary_of(const Board& board) {
  return std::ranges::find(kDictionaries, board.dictionary,
                           &decltype(kDictionaries)::value_type::first)
      ->second;
}

/// Returns the columns and at least as many rows as markers tell, whatever board was expected.
cv::Size size_of(const Markers& markers, std::span<const MarkerStep> steps) {
  const std::optional<MarkerLayout> layout = fitting_layout(steps);
  if (!layout) return {};
  int rows = 0;
  for (const int id : markers.ids) rows = std::max(rows, layout->square_of(id).y + 1);
  return {layout->columns, rows};
}

}  // namespace

#if HYPOTRACK_NEW_MARKERS

/// Finds and draws markers.
struct DetectorMarkings {
  explicit DetectorMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        detector(dictionary, parameters()) {}

  static cv::aruco::DetectorParameters parameters() {
    cv::aruco::DetectorParameters out;
    out.minMarkerDistanceRate = kLeastDistance;
    return out;
  }

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    detector.detectMarkers(gray, out.corners, out.ids);
    return out;
  }
  cv::Mat marker(int id, int side) const {
    cv::Mat out;
    dictionary.generateImageMarker(id, side, out);
    return out;
  }

  cv::aruco::Dictionary dictionary;
  cv::aruco::ArucoDetector detector;
};
using Markings = DetectorMarkings;

#else

struct ArucoMarkings {
  explicit ArucoMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        parameters(cv::aruco::DetectorParameters::create()) {
    parameters->minMarkerDistanceRate = kLeastDistance;
  }

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    cv::aruco::detectMarkers(gray, dictionary, out.corners, out.ids, parameters);
    return out;
  }
  cv::Mat marker(int id, int side) const {
    cv::Mat out;
    cv::aruco::drawMarker(dictionary, id, side, out);
    return out;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary;
  cv::Ptr<cv::aruco::DetectorParameters> parameters;
};

using Markings = ArucoMarkings;

#endif

struct CharucoFinder::Impl : Markings {
  explicit Impl(const Board& of) : Markings(of), board(of) {}

  Board board;
};

std::vector<std::string> dictionary_names() {
  std::vector<std::string> out;
  for (const auto& [name, dictionary] : kDictionaries) out.emplace_back(name);
  return out;
}

CharucoFinder::CharucoFinder(const Board& board) : impl_(std::make_unique<Impl>(board)) {}
CharucoFinder::~CharucoFinder() = default;

BoardCorners CharucoFinder::find(const cv::Mat& gray) const {
  constexpr double kClearly = 0.1;  // of the steps
  BoardCorners out;
  const Board& board = impl_->board;
  const Markers markers = impl_->markers(gray);
  const MarkerSteps steps = marker_steps(markers);
  if (steps.square <= 1) return out;
  out.marker = 1 / steps.square;
  const CornerFinder search(gray, markers, steps.square);
  std::array<double, 2> shares{};  // by marker_first
  for (const bool marker_first : {false, true})
    shares[marker_first] = agreement({board.size.width, marker_first}, steps.all);
  if (const auto given = board.marker_first)
    out.other_pattern = shares[!*given] >= kFits && shares[!*given] > shares[*given] + kClearly;
  for (const bool marker_first : {false, true}) {
    const double share = shares[marker_first];
    if (share < kFits || out.other_pattern || board.marker_first == !marker_first) continue;
    PatternCorners corners = search.corners({board.size.width, marker_first}, board.size.height);
    if (corners.ids.empty()) continue;
    corners.explained = cvRound(share * static_cast<double>(steps.all.size()));
    out.patterns.push_back(std::move(corners));
  }
  if (out.patterns.empty()) {
    if (!out.other_pattern) out.seen = size_of(markers, steps.all);
    return out;
  }
  std::ranges::stable_sort(out.patterns, std::ranges::greater(), &PatternCorners::explained);
  out.ids = out.patterns.front().ids;
  out.at = out.patterns.front().at;
  out.seen = board.size;
  return out;
}

std::size_t CharucoFinder::markers(const cv::Mat& gray) const {
  return impl_->markers(gray).ids.size();
}

cv::Point3f CharucoFinder::place(int id) const {
  const Board& board = impl_->board;
  const int columns = board.size.width - 1;
  return {static_cast<float>((1 + id % columns) * board.square),
          static_cast<float>((1 + id / columns) * board.square), 0};
}

cv::Mat CharucoFinder::drawn(int square, int margin) const {
  const Board& board = impl_->board;
  const MarkerLayout layout{board.size.width, board.marker_first.value_or(false)};
  cv::Mat out(board.size.height * square, board.size.width * square, CV_8U, cv::Scalar(0));
  const int side = cvRound(square * board.marker / board.square), inset = (square - side) / 2;
  for (int id = 0; id < layout.markers_in(board.size.height); ++id) {
    const cv::Rect cell(layout.square_of(id) * square, cv::Size(square, square));
    out(cell) = 255;
    impl_->marker(id, side).copyTo(
        out(cv::Rect(cell.tl() + cv::Point(inset, inset), cv::Size(side, side))));
  }
  cv::copyMakeBorder(out, out, margin, margin, margin, margin, cv::BORDER_CONSTANT, 255);
  return out;
}

}  // namespace hypotrack::calibrate
