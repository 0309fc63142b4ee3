#include "calibrate/charuco.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calibrate/marker_layout.hpp"

// From OpenCV 4.7 on, the markers are in the module objdetect.
#define HYPOTRACK_NEW_MARKERS (CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7)
#if HYPOTRACK_NEW_MARKERS
#include <opencv2/objdetect/charuco_detector.hpp>
#else
#include <opencv2/aruco/charuco.hpp>
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

/// Returns OpenCV's number of a board's dictionary.
int dictionary_of(const Board& board) {
  return std::ranges::find(kDictionaries, board.dictionary,
                           &decltype(kDictionaries)::value_type::first)
      ->second;
}

/// Returns the layout of OpenCV in which a pattern is found. OpenCV's boards begin with a black
/// square (its legacy pattern is for even rows only). A board that begins with a marker is the rest
/// of one with a row more, whose markers no picture has.
cv::Size opencv_size(const Board& board, bool marker_first) {
  return {board.size.width, board.size.height + (marker_first ? 1 : 0)};
}

/// Returns the numbers of the markers of opencv_size().
std::vector<int> marker_numbers(const Board& board, bool marker_first) {
  const MarkerLayout layout{board.size.width, false};
  const int before = marker_first ? layout.markers_in(1) : 0;
  std::vector<int> out;
  for (int i = 0; i < layout.markers_in(opencv_size(board, marker_first).height); ++i)
    out.push_back(i < before ? -1 - i : i - before);
  return out;
}

/// Refines corners once more: OpenCV (4.6 as well as 4.10) gives them half a pixel off in x and y.
/// The windows end before the markers, whose edges would draw corners to them.
void refine(const cv::Mat& gray, const Markers& markers, std::vector<cv::Point2f>& at) {
  constexpr double kLeast = 2, kMost = 8;  // pixels
  constexpr int kIterations = 40;
  constexpr double kAccuracy = 0.001;  // pixels
  constexpr double kGap = 0.6;  // of the distance to a marker's corner, which lies on the diagonal
  for (cv::Point2f& corner : at) {
    double nearest = kMost / kGap;
    for (const auto& marker : markers.corners)
      for (const cv::Point2f& other : marker) nearest = std::min(nearest, cv::norm(corner - other));
    const int window = static_cast<int>(std::max(kLeast, kGap * nearest));
    std::vector<cv::Point2f> one = {corner};
    cv::cornerSubPix(gray, one, {window, window}, {-1, -1},
                     {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, kIterations, kAccuracy});
    corner = one[0];
  }
}

/// Returns the columns and at least as many rows as markers tell, whatever board was expected.
cv::Size size_of(const Markers& markers, const std::vector<MarkerStep>& steps) {
  const std::optional<MarkerLayout> layout = fitting_layout(steps);
  if (!layout) return {};
  int rows = 0;
  for (const int id : markers.ids) rows = std::max(rows, layout->square_of(id).y + 1);
  return {layout->columns, rows};
}

}  // namespace

#if HYPOTRACK_NEW_MARKERS

/// Finds and draws a board's markers and corners.
struct DetectorMarkings {
  explicit DetectorMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        marker_detector(dictionary) {
    for (const bool marker_first : {false, true})
      corner_detectors.emplace_back(cv::aruco::CharucoBoard(
          opencv_size(board, marker_first), static_cast<float>(board.square),
          static_cast<float>(board.marker), dictionary, marker_numbers(board, marker_first)));
  }

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    marker_detector.detectMarkers(gray, out.corners, out.ids);
    return out;
  }
  void interpolate(const cv::Mat& gray, Markers markers, PatternCorners& out) const {
    corner_detectors[out.marker_first].detectBoard(gray, out.at, out.ids, markers.corners,
                                                   markers.ids);
  }
  cv::Mat marker(int id, int side) const {
    cv::Mat out;
    dictionary.generateImageMarker(id, side, out);
    return out;
  }

  cv::aruco::Dictionary dictionary;
  cv::aruco::ArucoDetector marker_detector;
  std::vector<cv::aruco::CharucoDetector> corner_detectors;  ///< by marker_first
};
using Markings = DetectorMarkings;

#else

struct ArucoMarkings {
  explicit ArucoMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        parameters(cv::aruco::DetectorParameters::create()) {
    for (const bool marker_first : {false, true}) {
      const cv::Size size = opencv_size(board, marker_first);
      layouts.push_back(
          cv::aruco::CharucoBoard::create(size.width, size.height, static_cast<float>(board.square),
                                          static_cast<float>(board.marker), dictionary));
      layouts.back()->ids = marker_numbers(board, marker_first);
    }
  }

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    cv::aruco::detectMarkers(gray, dictionary, out.corners, out.ids, parameters);
    return out;
  }
  void interpolate(const cv::Mat& gray, const Markers& markers, PatternCorners& out) const {
    cv::aruco::interpolateCornersCharuco(markers.corners, markers.ids, gray,
                                         layouts[out.marker_first], out.at, out.ids);
  }
  cv::Mat marker(int id, int side) const {
    cv::Mat out;
    cv::aruco::drawMarker(dictionary, id, side, out);
    return out;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary;
  cv::Ptr<cv::aruco::DetectorParameters> parameters;
  std::vector<cv::Ptr<cv::aruco::CharucoBoard> > layouts;  ///< by marker_first
};

using Markings = ArucoMarkings;

#endif

struct CharucoFinder::Impl : Markings {
  explicit Impl(const Board& of) : Markings(of), board(of) {}

  PatternCorners corners(const cv::Mat& gray, const Markers& markers, bool marker_first) const;
  Board board;
};

std::vector<std::string> dictionary_names() {
  std::vector<std::string> out;
  for (const auto& [name, dictionary] : kDictionaries) out.emplace_back(name);
  return out;
}

/// Returns the corners between markers that lie in a pattern.
PatternCorners CharucoFinder::Impl::corners(const cv::Mat& gray, const Markers& markers,
                                            bool marker_first) const {
  PatternCorners out;
  out.marker_first = marker_first;
  interpolate(gray, markers, out);
  const int before = marker_first ? board.size.width - 1 : 0;  // corners of the row that is added
  std::size_t kept = 0;
  for (std::size_t i = 0; i < out.ids.size(); ++i) {
    if (out.ids[i] < before) continue;
    out.ids[kept] = out.ids[i] - before;
    out.at[kept++] = out.at[i];
  }
  out.ids.resize(kept);
  out.at.resize(kept);
  return out;
}

CharucoFinder::CharucoFinder(const Board& board) : impl_(std::make_unique<Impl>(board)) {}
CharucoFinder::~CharucoFinder() = default;

BoardCorners CharucoFinder::find(const cv::Mat& gray) const {
  BoardCorners out;
  const Board& board = impl_->board;
  const Markers markers = impl_->markers(gray);
  const std::vector<MarkerStep> steps = marker_steps(markers);
  for (const bool marker_first : {false, true}) {
    if (board.marker_first.value_or(marker_first) != marker_first) continue;
    const double share = agreement({board.size.width, marker_first}, steps);
    if (share < kFits) continue;
    PatternCorners corners = impl_->corners(gray, markers, marker_first);
    corners.explained = cvRound(share * static_cast<double>(steps.size()));
    if (corners.ids.empty()) continue;
    refine(gray, markers, corners.at);
    out.patterns.push_back(std::move(corners));
  }
  if (out.patterns.empty()) {
    out.seen = size_of(markers, steps);
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
