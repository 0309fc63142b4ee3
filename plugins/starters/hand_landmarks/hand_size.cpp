#include "hand_size.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::hands {
namespace {

/// Distances in the palm, between landmarks by the detector's order: the wrist to each knuckle, and
/// the index to the little knuckle.
constexpr std::array<std::pair<Eigen::Index, Eigen::Index>, 5> kDistances = {
    {{0, 5}, {0, 9}, {0, 13}, {0, 17}, {5, 17}}};

}  // namespace

std::optional<double> relative_size(const Model& model, const HandModel& hand,
                                    const HandPair& pair) {
  constexpr double kMostApart = 0.05;  // standard deviation of the logarithms
  std::vector<double> rest;
  for (const Parameter& p : model.data().parameters) rest.push_back(p.rest);
  const HandPoints3D own = hand.in_detector_order(posed_landmarks(model, rest));
  Eigen::Array<double, 5, 1> logs;
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    const auto [from, to] = kDistances[i];
    const auto distance = [&, from = from, to = to](const HandPoints3D& points) {
      return (points.col(from) - points.col(to)).norm();
    };
    logs[static_cast<Eigen::Index>(i)] = std::log(distance(pair.landmarks) / distance(own));
  }
  const double mean = logs.mean();
  if (!std::isfinite(mean) || std::sqrt((logs - mean).square().mean()) > kMostApart)
    return std::nullopt;
  return std::exp(mean);
}

}  // namespace hypotrack::hands
