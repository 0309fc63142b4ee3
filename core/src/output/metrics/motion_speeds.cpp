#include "output/metrics/motion_speeds.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::internal {
namespace {

/// Adds a step to a speed whose mean is still a sum. Returns whether it is the new peak.
bool add_step(Speed& speed, double step, int frame) {
  speed.mean += step;
  if (step <= speed.peak) return false;
  speed.peak = step;
  speed.frame = frame;
  return true;
}

Eigen::Quaterniond rotation(const Scene::Item& item, const Eigen::VectorXd& state) {
  const auto q = state.segment<4>(item.offset + 3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

struct JointStep {
  double size = 0;
  std::string joint;  // empty if no joint moved
};

/// Returns the largest change among the joints of a kind.
JointStep largest_step(const Scene::Item& item, ParameterKind kind, const StateRow& from,
                       const StateRow& to) {
  const std::vector<Parameter>& parameters = item.model->data().parameters;
  JointStep largest;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind != kind) continue;
    const Eigen::Index at = item.offset + static_cast<Eigen::Index>(i);
    const double step = std::abs(to.state[at] - from.state[at]);
    if (step > largest.size) largest = {step, parameters[i].name};
  }
  return largest;
}

void add_pair(const Scene::Item& item, const StateRow& from, const StateRow& to,
              ModelSpeeds& speeds) {
  const Eigen::Vector3d moved =
      to.state.segment<3>(item.offset) - from.state.segment<3>(item.offset);
  add_step(speeds.translation, moved.norm(), to.frame);
  add_step(speeds.rotation, rotation(item, from.state).angularDistance(rotation(item, to.state)),
           to.frame);
  const JointStep turned = largest_step(item, ParameterKind::angle, from, to);
  if (add_step(speeds.joints, turned.size, to.frame)) speeds.fastest_joint = turned.joint;
  const JointStep slid = largest_step(item, ParameterKind::length, from, to);
  if (add_step(speeds.slides, slid.size, to.frame)) speeds.fastest_slide = slid.joint;
}

/// Returns the median time between two states, 0 without one.
double usual_step(std::span<const StateRow> states) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < states.size(); ++i)
    steps.push_back(states[i].time - states[i - 1].time);
  return steps.empty() ? 0 : upper_median(std::move(steps));
}

nlohmann::ordered_json to_json(const Speed& speed, double unit) {
  return {{"peak", speed.peak / unit}, {"mean", speed.mean / unit}, {"frame", speed.frame}};
}

}  // namespace

std::vector<ModelSpeeds> motion_speeds(const Scene& scene, std::span<const StateRow> states) {
  const double longest_step = 1.5 * usual_step(states);
  std::vector<ModelSpeeds> all;
  for (const Scene::Item& item : scene.items()) {
    ModelSpeeds speeds;
    speeds.model = item.name;
    int pairs = 0;
    for (std::size_t i = 1; i < states.size(); ++i) {
      if (states[i].frame != states[i - 1].frame + 1) continue;
      if (states[i].time - states[i - 1].time > longest_step) continue;
      add_pair(item, states[i - 1], states[i], speeds);
      ++pairs;
    }
    for (Speed* speed : {&speeds.translation, &speeds.rotation, &speeds.joints, &speeds.slides})
      if (pairs > 0) speed->mean /= pairs;
    all.push_back(std::move(speeds));
  }
  return all;
}

std::string motion_json(std::span<const ModelSpeeds> speeds) {
  nlohmann::ordered_json models = nlohmann::ordered_json::object();
  for (const ModelSpeeds& s : speeds) {
    nlohmann::ordered_json model;
    model["translation_mm_per_frame"] = to_json(s.translation, kMillimetre);
    model["rotation_deg_per_frame"] = to_json(s.rotation, kDegree);
    if (!s.fastest_joint.empty()) {
      model["joint_deg_per_frame"] = to_json(s.joints, kDegree);
      model["joint_deg_per_frame"]["joint"] = s.fastest_joint;
    }
    if (!s.fastest_slide.empty()) {
      model["joint_mm_per_frame"] = to_json(s.slides, kMillimetre);
      model["joint_mm_per_frame"]["joint"] = s.fastest_slide;
    }
    models[s.model] = model;
  }
  return nlohmann::ordered_json{{"models", models}}.dump(2) + "\n";
}

std::string motion_text(std::span<const ModelSpeeds> speeds) {
  std::string text;
  for (const ModelSpeeds& s : speeds) {
    text += fmt::format("peak speed of {}: {:.1f} mm (frame {}), {:.2f} deg (frame {})", s.model,
                        s.translation.peak / kMillimetre, s.translation.frame,
                        s.rotation.peak / kDegree, s.rotation.frame);
    if (!s.fastest_joint.empty())
      text += fmt::format(", joints {:.1f} deg ({}, frame {})", s.joints.peak / kDegree,
                          s.fastest_joint, s.joints.frame);
    if (!s.fastest_slide.empty())
      text += fmt::format(", joints {:.1f} mm ({}, frame {})", s.slides.peak / kMillimetre,
                          s.fastest_slide, s.slides.frame);
    text += " per frame\n";
  }
  return text;
}

}  // namespace hypotrack::internal
