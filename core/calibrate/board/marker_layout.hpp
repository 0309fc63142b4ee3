#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace hypotrack::calibrate {

/// Places of the markers of a ChArUco board: numbered row by row on every second square.
struct MarkerLayout {
  int columns = 0;
  bool marker_first = false;  ///< the top left square has a marker; otherwise it is black

  /// Returns the column and row of a marker's square.
  cv::Point square_of(int id) const;
  /// Returns how many markers the first rows have.
  int markers_in(int rows) const;
};

/// Markers that were found in a picture.
struct Markers {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
};

/// Columns and rows between the squares of two markers that are close to each other in a picture.
struct MarkerStep {
  int from = 0, to = 0;  ///< numbers of the markers
  cv::Point squares;
};

/// Steps between neighbouring markers, and the side of a square.
struct MarkerSteps {
  std::vector<MarkerStep> all;
  double square = 0;  ///< in sides of a marker; 0 without neighbours
};

/// Measures the steps between neighbouring markers, whatever the board. Lenses bend steps of so
/// few squares too little to matter.
MarkerSteps marker_steps(const Markers& markers);

/// Returns the share of steps that a layout explains; 0 without steps.
double agreement(const MarkerLayout& layout, std::span<const MarkerStep> steps);

/// Returns the layout that explains steps best; none if there are few steps or none explains most.
std::optional<MarkerLayout> fitting_layout(std::span<const MarkerStep> steps);

/// Share of steps that a layout of a picture's board explains.
constexpr double kFits = 0.7;

}  // namespace hypotrack::calibrate
