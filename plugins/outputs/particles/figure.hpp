#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace hypotrack::particles {

/// Side of a panel's picture, in pixels.
inline constexpr int kPanel = 280;

/// A picture with a line of text above it.
struct Panel {
  std::string label;
  cv::Mat picture;  ///< 8-bit BGR
};

/// Rows of panels under a headline. Pictures are scaled to kPanel pixels.
class Figure {
 public:
  explicit Figure(std::string headline) : headline_(std::move(headline)) {}

  /// Adds a row with a line of text above it.
  void add_row(std::string label, std::vector<Panel> panels);

  cv::Mat draw() const;

 private:
  struct Row {
    std::string label;
    std::vector<Panel> panels;
  };

  std::string headline_;
  std::vector<Row> rows_;
};

}  // namespace hypotrack::particles
