#include "calibrate/charuco.hpp"

#include <algorithm>
#include <array>
#include <opencv2/core/version.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// Markers that were found in a picture.
struct Markers {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
};

}  // namespace

#if HYPOTRACK_NEW_MARKERS

/// Finds and draws a board's markers and corners.
struct DetectorMarkings {
  explicit DetectorMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        layout(board.size, static_cast<float>(board.square), static_cast<float>(board.marker),
               dictionary),
        marker_detector(dictionary),
        corner_detector(layout),
        places(layout.getChessboardCorners()) {}

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    marker_detector.detectMarkers(gray, out.corners, out.ids);
    return out;
  }
  void interpolate(const cv::Mat& gray, Markers& markers, BoardCorners& out) const {
    corner_detector.detectBoard(gray, out.at, out.ids, markers.corners, markers.ids);
  }
  void draw(cv::Size size, int margin, cv::Mat& out) const {
    layout.generateImage(size, out, margin);
  }

  cv::aruco::Dictionary dictionary;
  cv::aruco::CharucoBoard layout;
  cv::aruco::ArucoDetector marker_detector;
  cv::aruco::CharucoDetector corner_detector;
  std::vector<cv::Point3f> places;
};
using Markings = DetectorMarkings;

#else

struct ArucoMarkings {
  explicit ArucoMarkings(const Board& board)
      : dictionary(cv::aruco::getPredefinedDictionary(dictionary_of(board))),
        layout(cv::aruco::CharucoBoard::create(board.size.width, board.size.height,
                                               static_cast<float>(board.square),
                                               static_cast<float>(board.marker), dictionary)),
        parameters(cv::aruco::DetectorParameters::create()),
        places(layout->chessboardCorners) {}

  Markers markers(const cv::Mat& gray) const {
    Markers out;
    cv::aruco::detectMarkers(gray, dictionary, out.corners, out.ids, parameters);
    return out;
  }
  void interpolate(const cv::Mat& gray, const Markers& markers, BoardCorners& out) const {
    cv::aruco::interpolateCornersCharuco(markers.corners, markers.ids, gray, layout, out.at,
                                         out.ids);
  }
  void draw(cv::Size size, int margin, cv::Mat& out) const { layout->draw(size, out, margin); }

  cv::Ptr<cv::aruco::Dictionary> dictionary;
  cv::Ptr<cv::aruco::CharucoBoard> layout;
  cv::Ptr<cv::aruco::DetectorParameters> parameters;
  std::vector<cv::Point3f> places;
};

using Markings = ArucoMarkings;

#endif

struct CharucoFinder::Impl : Markings {
  using Markings::Markings;
};

std::vector<std::string> dictionary_names() {
  std::vector<std::string> out;
  for (const auto& [name, dictionary] : kDictionaries) out.emplace_back(name);
  return out;
}

CharucoFinder::CharucoFinder(const Board& board) : impl_(std::make_unique<Impl>(board)) {}
CharucoFinder::~CharucoFinder() = default;

BoardCorners CharucoFinder::find(const cv::Mat& gray) const {
  BoardCorners out;
  Markers markers = impl_->markers(gray);
  if (!markers.ids.empty()) impl_->interpolate(gray, markers, out);
  return out;
}

bool CharucoFinder::sees_marker(const cv::Mat& gray) const {
  return !impl_->markers(gray).ids.empty();
}

cv::Point3f CharucoFinder::place(int id) const {
  return impl_->places[static_cast<std::size_t>(id)];
}

cv::Mat CharucoFinder::drawn(cv::Size size, int margin) const {
  cv::Mat out;
  impl_->draw(size, margin, out);
  return out;
}

}  // namespace hypotrack::calibrate
