#include "lab_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack::stereo_color {

std::vector<LabNode> lab_nodes() {
  cv::Mat3f colors(kLabNodes * kLabNodes, kLabNodes);
  for (int i = 0; i < kLabNodeCount; ++i) {
    const int r = i / (kLabNodes * kLabNodes), g = i / kLabNodes % kLabNodes, b = i % kLabNodes;
    colors(i / kLabNodes, b) = cv::Vec3f(cv::Vec3i(b, g, r)) / (kLabNodes - 1.0f);
  }
  cv::Mat3f lab;
  cv::cvtColor(colors, lab, cv::COLOR_BGR2Lab);
  const auto units = [](float x) { return static_cast<std::int16_t>(std::lround(x / kLabUnit)); };
  std::vector<LabNode> nodes(kLabNodeCount);
  std::transform(lab.begin(), lab.end(), nodes.begin(), [&](const cv::Vec3f& p) {
    return LabNode{units(p[0] / 100.0f), units((p[1] + 128.0f) / 256.0f),
                   units((p[2] + 128.0f) / 256.0f), 0};
  });
  return nodes;
}

}  // namespace hypotrack::stereo_color
