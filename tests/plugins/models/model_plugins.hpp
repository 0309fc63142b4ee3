#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

using Degrees = std::map<std::string, double>;

/// A model from its YAML, through the plugin loader.
inline std::unique_ptr<Model> make_model(const std::string& yaml) {
  PluginLoader loader;
  return loader.make<Model>(ConfigNode::parse(yaml, "scene.yaml"));
}

/// The message that making a model ends in; fails the test if there is none.
inline std::string model_error(const std::string& yaml) {
  try {
    make_model(yaml);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error from " << yaml;
  return {};
}

inline std::vector<double> model_state(const Model& model, const Degrees& degrees) {
  std::vector<double> values;
  for (const Parameter& parameter : model.data().parameters) {
    const auto given = degrees.find(parameter.name);
    values.push_back(given == degrees.end() ? parameter.rest : given->second * kDegree);
  }
  return values;
}

inline Eigen::Vector3d model_landmark(const Model& model, const std::string& name,
                                      const Degrees& degrees) {
  const Eigen::Matrix3Xd all = posed_landmarks(model, model_state(model, degrees));
  const auto& landmarks = model.data().landmarks;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (landmarks[i].name == name) return all.col(static_cast<Eigen::Index>(i));
  }
  ADD_FAILURE() << "no landmark " << name;
  return Eigen::Vector3d::Zero();
}

}  // namespace hypotrack::test
