#include "hand_size.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "hypotrack/kinematics.hpp"

namespace hypotrack::hands {
namespace {

/// Two landmarks of the palm, by the detector's order.
struct Distance {
  Eigen::Index from, to;
  double seen;  ///< the detector's distance as a share of the joints', in rendered hands
};
// The detector's wrist is nearer to the fingers than the joint is.
constexpr std::array<Distance, 5> kDistances = {{{0, 5, 0.924},     // wrist, index_mcp
                                                 {0, 9, 0.939},     // wrist, middle_mcp
                                                 {0, 13, 0.934},    // wrist, ring_mcp
                                                 {0, 17, 0.890},    // wrist, little_mcp
                                                 {5, 17, 0.957}}};  // index_mcp, little_mcp

}  // namespace

std::optional<double> relative_size(const Model& model, const HandModel& hand,
                                    const HandPair& pair) {
  constexpr double kMostApart = 0.05;  // standard deviation of the logarithms
  std::vector<double> rest;
  for (const Parameter& p : model.data().parameters) rest.push_back(p.rest);
  const HandPoints3D own = hand.in_detector_order(posed_landmarks(model, rest));
  Eigen::Array<double, 5, 1> logs;
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    const auto [from, to, seen] = kDistances[i];
    const auto distance = [&, from = from, to = to](const HandPoints3D& points) {
      return (points.col(from) - points.col(to)).norm();
    };
    logs[static_cast<Eigen::Index>(i)] = std::log(distance(pair.landmarks) / distance(own) / seen);
  }
  const double mean = logs.mean();
  if (!std::isfinite(mean) || std::sqrt((logs - mean).square().mean()) > kMostApart)
    return std::nullopt;
  return std::exp(mean);
}

}  // namespace hypotrack::hands
