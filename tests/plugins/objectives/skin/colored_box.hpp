#pragma once

#include <vector>

#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::skin {

/// A box of 60 x 40 x 120 mm, 0.5 m away, in 2 views of 96 x 96 pixels: reddish with noise before a
/// bluish ground. `start` says where it is.
Observation colored_box();

/// A hypothesis that covers a rectangle of every view.
class Rectangle {
 public:
  Rectangle(const Observation& observation, const cv::Rect& covered);
  RenderedHypothesis hypothesis() const { return {state_, tiles_}; }

 private:
  std::vector<double> state_;
  std::vector<std::vector<float>> memory_;
  std::vector<DepthTile> tiles_;
};

/// What the box covers of a view.
cv::Rect box_outline();

}  // namespace hypotrack::skin
