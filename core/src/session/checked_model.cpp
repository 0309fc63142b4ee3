#include "session/checked_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/shape.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {
namespace {

constexpr float kFarthest = 1e9F;  // metres; beyond, single precision may overflow
constexpr double kSkew = 1e-6;     // of directions that count as unit vectors and perpendicular

}  // namespace

CheckedModel::CheckedModel(std::shared_ptr<const Model> model, std::string who)
    : Model(model->data()),
      model_(std::move(model)),
      who_(std::move(who)),
      explains_(detail::comes_with_hypotrack(model_.get())),
      poses_itself_(detail::call_plugin(who_, [&] { return model_->poses_itself(); })) {}

void CheckedModel::pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                        Eigen::Matrix3Xd& landmarks) const {
  detail::call_plugin(who_, [&] { model_->pose(parameters, vertices, landmarks); });
  check_points(vertices, data().mesh.vertices.cols(), "vertices");
  check_points(landmarks, static_cast<Eigen::Index>(data().landmarks.size()), "landmarks");
}

template <class Points>
void CheckedModel::check_points(const Points& points, Eigen::Index expected,
                                const char* what) const {
  if (points.cols() != expected)
    throw PluginError(fmt::format(
        "{}: its pose has {} {}, expected {} as in its data; this is a bug in the model", who_,
        points.cols(), what, expected));
  if (points.squaredNorm() <= kFarthest * kFarthest) return;  // NaN goes on
  for (Eigen::Index i = 0; i < expected; ++i) {
    const auto point = points.col(i);
    if ((point.array().abs() <= kFarthest).all()) continue;
    throw PluginError(fmt::format(
        "{}: its pose has {} {} {} m in place {} of its {}, expected finite numbers up to {:g}; "
        "this is a bug in the model",
        who_, point.x(), point.y(), point.z(), i, what, kFarthest));
  }
}

std::vector<ShapeParameter> CheckedModel::shape_parameters() const {
  auto all = detail::call_plugin(who_, explains_, "", [&] { return model_->shape_parameters(); });
  try {
    shape_correlations(all);
  } catch (const DataError& error) {
    throw PluginError(fmt::format("{}: {}; this is a bug in the model", who_, error.what()));
  }
  return all;
}

ModelData CheckedModel::shaped(std::span<const double> values) const {
  return detail::call_plugin(who_, explains_, "", [&] { return model_->shaped(values); });
}

std::vector<NamedDirection> CheckedModel::directions() const {
  const auto all = detail::call_plugin(who_, explains_, "", [&] { return model_->directions(); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto is_apart = [&](const NamedDirection& earlier) {
      return earlier.name != all[i].name && std::abs(earlier.axis.dot(all[i].axis)) < kSkew;
    };
    if (!all[i].name.empty() && std::abs(all[i].axis.norm() - 1) < kSkew &&
        std::all_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), is_apart))
      continue;
    throw PluginError(
        fmt::format("{}: its direction '{}' is {} {} {}, expected unit vectors of different names, "
                    "perpendicular to each other; this is a bug in the model",
                    who_, all[i].name, all[i].axis.x(), all[i].axis.y(), all[i].axis.z()));
  }
  return all;
}

std::vector<std::string> CheckedModel::clear_landmarks() const {
  return detail::call_plugin(who_, explains_, "", [&] { return model_->clear_landmarks(); });
}

std::shared_ptr<const Model> checked_model(std::shared_ptr<const Model> model, std::string who) {
  if (model->data().landmarks.empty())
    throw PluginError(fmt::format(
        "{}: has no landmarks, expected one at least, such as its centre; this is a bug in the "
        "model",
        who));
  const bool runs = detail::call_plugin(who, [&] {
    return model->poses_itself() || !model->shape_parameters().empty() ||
           !model->directions().empty() || !model->clear_landmarks().empty();
  });
  if (!runs) return model;
  return std::make_shared<CheckedModel>(std::move(model), std::move(who));
}

}  // namespace hypotrack::internal
