#include "hypotrack/plugin/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "model/posing.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack {
namespace {

std::string label_of(const Model& model) { return detail::label_or(model, "the model"); }

template <class Points>
void check_points(const Model& model, const Points& points, Eigen::Index expected,
                  const char* what) {
  constexpr float kFarthest = 1e9F;  // metres; beyond, single precision may overflow
  if (points.cols() != expected)
    throw PluginError(fmt::format(
        "{}: its pose has {} {}, expected {} as in its data; this is a bug in the model",
        label_of(model), points.cols(), what, expected));
  if (points.squaredNorm() <= kFarthest * kFarthest) return;  // NaN goes on
  for (Eigen::Index i = 0; i < expected; ++i) {
    const auto point = points.col(i);
    if ((point.array().abs() <= kFarthest).all()) continue;
    throw PluginError(fmt::format(
        "{}: its pose has {} {} {} m in place {} of its {}, expected finite numbers up to {:g}; "
        "this is a bug in the model",
        label_of(model), point.x(), point.y(), point.z(), i, what, kFarthest));
  }
}

void check_directions(const Model& model, const std::vector<NamedDirection>& all) {
  constexpr double kSkew = 1e-6;  // of directions that count as unit vectors and perpendicular
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto is_apart = [&](const NamedDirection& earlier) {
      return earlier.name != all[i].name && std::abs(earlier.axis.dot(all[i].axis)) < kSkew;
    };
    if (!all[i].name.empty() && std::abs(all[i].axis.norm() - 1) < kSkew &&
        std::all_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), is_apart))
      continue;
    throw PluginError(fmt::format(
        "{}: its direction '{}' is {} {} {}, expected unit vectors of different names, "
        "perpendicular to each other; this is a bug in the model",
        label_of(model), all[i].name, all[i].axis.x(), all[i].axis.y(), all[i].axis.z()));
  }
}

}  // namespace

Model::Model(ModelData data) : data_(std::move(data)) { validate(data_, "model"); }

Model::~Model() = default;

bool Model::poses_itself() const {
  return detail::call_plugin(*this, [&] { return do_poses_itself(); });
}

void Model::pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                 Eigen::Matrix3Xd& landmarks) const {
  detail::call_plugin(*this, [&] { do_pose(parameters, vertices, landmarks); });
  check_points(*this, vertices, data_.mesh.vertices.cols(), "vertices");
  check_points(*this, landmarks, static_cast<Eigen::Index>(data_.landmarks.size()), "landmarks");
}

std::vector<ShapeParameter> Model::shape_parameters() const {
  auto all = detail::call_explained(*this, "", [&] { return do_shape_parameters(); });
  try {
    shape_correlations(all);
  } catch (const DataError& error) {
    throw PluginError(
        fmt::format("{}: {}; this is a bug in the model", label_of(*this), error.what()));
  }
  return all;
}

ModelData Model::shaped(std::span<const double> values) const {
  return detail::call_explained(*this, "", [&] { return do_shaped(values); });
}

std::vector<NamedDirection> Model::directions() const {
  auto all = detail::call_explained(*this, "", [&] { return do_directions(); });
  check_directions(*this, all);
  return all;
}

std::vector<std::string> Model::clear_landmarks() const {
  return detail::call_explained(*this, "", [&] { return do_clear_landmarks(); });
}

void Model::do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                    Eigen::Matrix3Xd& landmarks) const {
  const auto bones = world_from_bones(data_, parameters);
  vertices = skin(data_, data_.mesh, bones);
  landmarks = place_landmarks(data_, bones);
}

ModelData Model::do_shaped(std::span<const double> values) const {
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
