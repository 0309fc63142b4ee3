#include "hypotrack/model.hpp"

#include <array>
#include <limits>
#include <string>
#include <utility>

#include "hypotrack/error.hpp"
#include "model/posing.hpp"

namespace hypotrack {

Model::Model(ModelData data) : data_(std::move(data)) { validate(data_, "model"); }

Model::~Model() = default;

void Model::pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                 Eigen::Matrix3Xd& landmarks) const {
  const auto bones = world_from_bones(data_, parameters);
  vertices = skin(data_, bones);
  landmarks = place_landmarks(data_, bones);
}

ModelData Model::shaped(std::span<const double> values) const {
  if (!values.empty()) throw Error("model: it has no shape parameters, but a shape was given");
  return data_;
}

std::vector<Parameter> pose_parameters() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Parameter> parameters;
  for (const char* axis : {"x", "y", "z"}) {
    parameters.push_back(
        {std::string("position_") + axis, ParameterKind::position, -kInfinity, kInfinity, 0});
  }
  for (const char* part : {"w", "x", "y", "z"}) {
    const double rest = *part == 'w' ? 1 : 0;
    parameters.push_back({std::string("rotation_") + part, ParameterKind::quaternion, -1, 1, rest});
  }
  return parameters;
}

}  // namespace hypotrack
