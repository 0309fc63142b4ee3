#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack::test {

/// The motion of a scene, without its pictures.
struct Dataset {
  Scene scene;
  std::vector<StateRow> states;  ///< of all frames
};

/// Reads configs/scenes/NAME.yaml.
Dataset load_dataset(const std::string& name);

/// World positions of a model's vertices in one state.
Eigen::Matrix3Xf vertices(const Dataset& dataset, std::size_t model, int frame);

/// A digit of a hand, or its palm, by the bones that hold most of a vertex.
struct HandPart {
  std::string name;
  std::vector<int> outer;  ///< vertices of its two outer bones (a thumb's last against the palm)
  Eigen::Matrix3Xi triangles;  ///< of all its bones
};

std::vector<HandPart> hand_parts(const ModelData& hand);

/// How deep the digits of a hand lie in each other and in the palm, metres.
double self_penetration(const std::vector<HandPart>& parts, const Eigen::Matrix3Xf& vertices);

}  // namespace hypotrack::test
