#include "recover/postures.hpp"

#include <algorithm>
#include <cmath>

#include "hypotrack/params.hpp"

namespace hypotrack {
namespace {

constexpr int kPose = 7;  // numbers of a model's pose
constexpr std::size_t kRemembered = 8;
constexpr double kUnlike = 25 * kDegree;  // largest difference of an angle

/// How far each limb is bent: 0 at rest, 1 at its joints' upper bounds.
Eigen::VectorXd bent(const ModelData& model, const std::vector<std::vector<int>>& limbs,
                     const std::vector<double>& shares) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(model.parameters.size()) - kPose);
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = model.parameters[static_cast<std::size_t>(i + kPose)].rest;
  for (std::size_t limb = 0; limb < limbs.size(); ++limb)
    for (const int p : limbs[limb]) {
      const Parameter& parameter = model.parameters[static_cast<std::size_t>(p)];
      const double up = parameter.upper - parameter.rest, down = parameter.rest - parameter.lower;
      if (p < kPose || !std::isfinite(up) || up < 1.5 * down) continue;  // bends to one side only
      out[p - kPose] = parameter.rest + shares[limb] * up;
    }
  return out;
}

}  // namespace

Postures::Postures(const ModelData& model) {
  constexpr double kStraight = 0.03, kHalf = 0.4, kBent = 0.85;
  std::vector<std::vector<int>> limbs = parameter_groups(model);
  limbs.erase(limbs.begin());  // the pose
  const auto add = [&](const std::vector<double>& shares) {
    all_.push_back(bent(model, limbs, shares));
  };
  const std::size_t n = limbs.size();
  if (n == 0) {
    all_.push_back(
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.parameters.size()) - kPose));
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
  const Eigen::VectorXd posture = parameters.tail(parameters.size() - kPose);
  if (posture.size() == 0) return;
  for (std::size_t i = fixed_; i < all_.size(); ++i)
    if ((all_[i] - posture).cwiseAbs().maxCoeff() < kUnlike) return;
  if (all_.size() < fixed_ + kRemembered) {
    all_.push_back(posture);
    return;
  }
  all_[fixed_ + replaced_] = posture;
  replaced_ = (replaced_ + 1) % kRemembered;
}

}  // namespace hypotrack
