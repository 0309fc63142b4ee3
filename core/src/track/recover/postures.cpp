#include "track/recover/postures.hpp"

#include <algorithm>
#include <cmath>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kRememberedPostures = 8;
constexpr double kUnlike = 25 * kDegree;  // largest difference of an angle

constexpr double kStraight = 0.03, kHalf = 0.4, kBent = 0.85;  // shares of a joint's range

/// Returns the parameters that bend a limb: those with most of their range on one side of the rest
/// value.
std::vector<int> bending(const ModelData& model, const std::vector<int>& limb) {
  std::vector<int> out;
  for (const int p : limb) {
    const Parameter& parameter = model.parameters[static_cast<std::size_t>(p)];
    const double up = parameter.upper - parameter.rest, down = parameter.rest - parameter.lower;
    if (p >= kPoseSize && std::isfinite(up) && up >= 1.5 * down) out.push_back(p);
  }
  return out;
}

/// Returns a parameter's value at a share of its range: 0 at rest, 1 at the upper bound.
double bent(const ModelData& model, int p, double share) {
  const Parameter& parameter = model.parameters[static_cast<std::size_t>(p)];
  return parameter.rest + share * (parameter.upper - parameter.rest);
}

}  // namespace

Postures::Postures(const ModelData& model) {
  std::vector<std::vector<int>> groups = parameter_groups(model);
  for (auto group = groups.begin() + 1; group != groups.end(); ++group) {  // after the pose
    Limb limb{bending(model, *group), {}};
    for (const double share : {kStraight, kHalf, kBent}) {
      Eigen::VectorXd values(std::ssize(limb.parameters));
      for (Eigen::Index i = 0; i < values.size(); ++i)
        values[i] = bent(model, limb.parameters[static_cast<std::size_t>(i)], share);
      limb.variants.push_back(values);
    }
    limbs_.push_back(std::move(limb));
  }
  Eigen::VectorXd rest(std::ssize(model.parameters) - kPoseSize);
  for (Eigen::Index i = 0; i < rest.size(); ++i)
    rest[i] = model.parameters[static_cast<std::size_t>(i + kPoseSize)].rest;
  const auto add = [&](const std::vector<double>& shares) {
    Eigen::VectorXd posture = rest;
    for (std::size_t limb = 0; limb < limbs_.size(); ++limb)
      for (const int p : limbs_[limb].parameters)
        posture[p - kPoseSize] = bent(model, p, shares[limb]);
    all_.push_back(std::move(posture));
  };
  const std::size_t n = limbs_.size();
  if (n == 0) {
    all_.push_back(rest);
  } else {
    for (const double share : {kStraight, kHalf, kBent}) add(std::vector(n, share));
    for (const auto& [all, one] : {std::pair{kBent, kStraight}, std::pair{kStraight, kBent}})
      for (std::size_t first = 0; first < n; ++first)
        for (std::size_t last = first; last < std::min(first + 3, n); ++last) {
          if (n > 8 && last > first) break;  // too many limbs for runs of them
          std::vector<double> shares(n, all);
          std::fill(shares.begin() + static_cast<std::ptrdiff_t>(first),
                    shares.begin() + static_cast<std::ptrdiff_t>(last) + 1, one);
          if (last - first + 1 < n) add(shares);
        }
  }
  fixed_ = all_.size();
}

void Postures::remember(const Eigen::VectorXd& parameters) {
  const Eigen::VectorXd posture = parameters.tail(parameters.size() - kPoseSize);
  if (posture.size() == 0) return;
  for (std::size_t i = fixed_; i < all_.size(); ++i)
    if ((all_[i] - posture).cwiseAbs().maxCoeff() < kUnlike) return;
  if (all_.size() < fixed_ + kRememberedPostures) {
    all_.push_back(posture);
    return;
  }
  all_[fixed_ + replaced_] = posture;
  replaced_ = (replaced_ + 1) % kRememberedPostures;
}

}  // namespace hypotrack::internal
