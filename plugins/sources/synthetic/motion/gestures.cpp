#include "motion/gestures.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {
namespace {

/// A gesture as written: patterns and angles, in order.
struct GestureParams {
  struct Entry {
    std::string pattern;
    double angle = 0;
  };
  std::vector<Entry> entries;
  void visit(ParamVisitor& v) {
    for (Entry& e : entries) {
      v(e.pattern, e.angle, {.help = "joint angle", .unit = "deg", .to_si = kDegree});
    }
  }
};

GestureParams entries_of(const ConfigNode& gesture) {
  if (!gesture.is_map()) {
    throw ConfigError(gesture.where() + ": expected a map of joint angles to degrees");
  }
  GestureParams params;
  for (const std::string& pattern : gesture.keys()) params.entries.push_back({pattern, 0});
  return ParamReader(gesture).read(std::move(params));
}

std::string angle_names(const Model& model) {
  std::vector<std::string> names;
  for (const Parameter& p : model.data().parameters) {
    if (p.kind == ParameterKind::angle) names.push_back(p.name);
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

void check_bounds(const std::string& gesture, const ConfigNode& entry, const Parameter& p,
                  double angle) {
  constexpr double kSlack = 1e-6;
  if (angle >= p.lower - kSlack && angle <= p.upper + kSlack) return;
  throw ConfigError(fmt::format(
      "{}: gesture '{}' turns '{}' to {:.6g} deg, but the model allows {:.6g} to {:.6g}",
      entry.where(), gesture, p.name, angle / kDegree, p.lower / kDegree, p.upper / kDegree));
}

ConfigNode checked_map(ConfigNode node) {
  if (node.defined() && !node.is_map()) {
    throw ConfigError(node.where() + ": expected a map of gesture names to angles");
  }
  return node;
}

}  // namespace

Gestures::Gestures(ConfigNode own, const std::filesystem::path& file)
    : own_(checked_map(std::move(own))) {
  if (!file.empty()) shared_ = checked_map(ConfigNode::load(file));
}

std::vector<std::string> Gestures::names() const {
  std::vector<std::string> names = own_.keys();
  for (const std::string& name : shared_.keys())
    if (!own_.get(name).defined()) names.push_back(name);
  return names;
}

ConfigNode Gestures::find(const std::string& name, const ConfigNode& said) const {
  const ConfigNode own = own_.get(name);
  if (own.defined()) return own;
  const ConfigNode shared = shared_.get(name);
  if (shared.defined() || name == "rest") return shared;
  std::vector<std::string> known = names();
  known.insert(known.begin(), "rest");
  throw ConfigError(fmt::format("{}: no gesture is called '{}'; there are: {}", said.where(), name,
                                fmt::join(known, ", ")));
}

std::vector<double> Gestures::parameters(const std::string& name, const ConfigNode& said_at,
                                         const Scene::Item& item) const {
  const ConfigNode gesture = find(name, said_at);
  const std::vector<Parameter>& parameters = item.model->data().parameters;
  std::vector<double> values;
  for (const Parameter& p : parameters) values.push_back(p.rest);
  if (!gesture.defined()) return values;
  std::vector<std::string> said(parameters.size());  // the pattern that set each angle
  for (const auto& [pattern, angle] : entries_of(gesture).entries) {
    bool used = false;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].kind != ParameterKind::angle) continue;
      if (fnmatch(pattern.c_str(), parameters[i].name.c_str(), 0) != 0) continue;
      values[i] = angle;
      said[i] = pattern;
      used = true;
    }
    if (used) continue;
    throw ConfigError(fmt::format("{}: no joint angle of '{}' is called '{}'; there are: {}",
                                  gesture.get(pattern).where(), item.name, pattern,
                                  angle_names(*item.model)));
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (said[i].empty()) continue;
    check_bounds(name, gesture.get(said[i]), parameters[i], values[i]);
  }
  return values;
}

}  // namespace hypotrack::synthetic
