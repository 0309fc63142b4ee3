#include "frame_residuals.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace hypotrack::plausible_motion {
namespace {

LinearResidual residual(std::size_t index, double sigma) {
  const auto i = static_cast<std::int32_t>(index);
  return {{i, i}, {1 / sigma, 0}, 0};
}

/// Returns the index of the parameter with a name; the size if there is none.
std::size_t find(const std::vector<Parameter>& parameters, const std::string& name) {
  const auto found = std::ranges::find(parameters, name, &Parameter::name);
  return static_cast<std::size_t>(found - parameters.begin());
}

constexpr std::string_view kThumb = "thumb";
constexpr std::string_view kSideBySide[] = {"index", "middle", "ring", "little"};

/// Angles of a thumb's joints in a relaxed hand.
struct ThumbJoint {
  std::string_view name;
  double rest;
};
constexpr ThumbJoint kRelaxedThumb[]{{"_abduction", 30 * kDegree},
                                     {"_flexion_1", 5 * kDegree},
                                     {"_flexion_2", 12 * kDegree},
                                     {"_flexion_3", 10 * kDegree}};

}  // namespace

void FrameResiduals::couple(const std::vector<Parameter>& parameters, std::string_view joint,
                            std::string_view before, double share, double sigma) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string& name = parameters[i].name;
    if (!name.ends_with(joint)) continue;
    const std::string finger = name.substr(0, name.size() - joint.size());
    const std::size_t other = find(parameters, finger + std::string(before));
    if (finger.ends_with(kThumb) || other == parameters.size()) continue;
    LinearResidual coupled = residual(i, sigma);
    coupled.index[1] = static_cast<std::int32_t>(other);
    coupled.factor[1] = -share / sigma;
    residuals_.push_back(coupled);
  }
}

void FrameResiduals::couple_neighbors(const Scene& scene, double sigma) {
  const std::vector<Parameter>& parameters = scene.parameters();
  for (const Scene::Item& item : scene.items()) {
    std::size_t before = parameters.size();
    for (const std::string_view finger : kSideBySide) {
      const std::size_t here =
          find(parameters, item.name + "." + std::string(finger) + "_flexion_1");
      if (before < parameters.size() && here < parameters.size()) {
        LinearResidual coupled = residual(here, sigma);
        coupled.index[1] = static_cast<std::int32_t>(before);
        coupled.factor[1] = -1 / sigma;
        residuals_.push_back(coupled);
      }
      before = here;
    }
  }
}

void FrameResiduals::hold(const std::vector<Parameter>& parameters, bool of_thumb,
                          std::string_view joint, double rest, double sigma) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::string_view name = parameters[i].name;
    if (parameters[i].kind != ParameterKind::angle || !name.ends_with(joint)) continue;
    name.remove_suffix(joint.size());
    if (name.ends_with(kThumb) != of_thumb) continue;
    LinearResidual held = residual(i, sigma);
    held.offset = rest / sigma;
    residuals_.push_back(held);
  }
}

FrameResiduals::FrameResiduals(const PlausibleMotionParams& params, const Scene& scene)
    : motion_factor_(1 / params.motion_sigma) {
  const std::vector<Parameter>& parameters = scene.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind != ParameterKind::angle) continue;
    residuals_.push_back(residual(i, params.motion_sigma));
  }
  angles_ = residuals_.size();
  couple(parameters, "_flexion_3", "_flexion_2", params.coupling, params.coupling_sigma);
  couple(parameters, "_flexion_2", "_flexion_1", params.curl, params.curl_sigma);
  couple_neighbors(scene, params.neighbor_sigma);
  hold(parameters, false, "_abduction", 0, params.abduction_sigma);
  for (const ThumbJoint& joint : kRelaxedThumb) {
    hold(parameters, true, joint.name, joint.rest, params.thumb_sigma);
  }
}

MotionTerm FrameResiduals::of(const Observation& observation) {
  for (std::size_t i = 0; i < angles_; ++i) {
    LinearResidual& r = residuals_[i];
    r.factor[0] = observation.context.no_motion_prior ? 0 : motion_factor_;
    r.offset = r.factor[0] * observation.start[r.index[0]];
  }
  return {static_cast<std::int64_t>(residuals_.size()), residuals_.data()};
}

}  // namespace hypotrack::plausible_motion
