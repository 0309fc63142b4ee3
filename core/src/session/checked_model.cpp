#include "session/checked_model.hpp"

#include <fmt/format.h>

#include <utility>

#include "hypotrack/error.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {
namespace {

constexpr float kFarthest = 1e9F;  // metres; beyond, single precision may overflow

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
  return detail::call_plugin(who_, explains_, "", [&] { return model_->shape_parameters(); });
}

ModelData CheckedModel::shaped(std::span<const double> values) const {
  return detail::call_plugin(who_, explains_, "", [&] { return model_->shaped(values); });
}

std::shared_ptr<const Model> checked_model(std::shared_ptr<const Model> model, std::string who) {
  if (model->data().landmarks.empty())
    throw PluginError(fmt::format(
        "{}: has no landmarks, expected one at least, such as its centre; this is a bug in the "
        "model",
        who));
  const bool runs = detail::call_plugin(
      who, [&] { return model->poses_itself() || !model->shape_parameters().empty(); });
  if (!runs) return model;
  return std::make_shared<CheckedModel>(std::move(model), std::move(who));
}

}  // namespace hypotrack::internal
