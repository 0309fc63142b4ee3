#include "shape/shape_targets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/shape.hpp"

namespace hypotrack::internal {
namespace {

std::vector<std::string> names_of(const std::vector<ShapeParameter>& parameters) {
  std::vector<std::string> names;
  for (const ShapeParameter& p : parameters) names.push_back(p.name);
  return names;
}

std::vector<int> find_models(const Scene& scene, const std::vector<std::string>& wanted) {
  std::vector<int> found;
  std::vector<std::string> with_shape;
  for (std::size_t i = 0; i < scene.items().size(); ++i) {
    const Scene::Item& item = scene.items()[i];
    if (item.model->shape_parameters().empty()) continue;
    with_shape.push_back(item.name);
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), item.name) != wanted.end())
      found.push_back(static_cast<int>(i));
  }
  for (const std::string& name : wanted) {
    if (std::find(with_shape.begin(), with_shape.end(), name) != with_shape.end()) continue;
    throw ConfigError(fmt::format("shape: '{}' is no model of this scene with shape parameters{}",
                                  name, did_you_mean(name, with_shape)));
  }
  if (found.empty()) {
    throw ConfigError(
        "shape: no model of this scene has shape parameters; `hypotrack plugins info TYPE` "
        "lists those of a model");
  }
  return found;
}

/// Computes unit normals of the vertices, outwards, weighted by the areas of their triangles (3xV).
Eigen::Matrix3Xf vertex_normals(const Mesh& mesh) {
  Eigen::Matrix3Xf normals = Eigen::Matrix3Xf::Zero(3, mesh.vertices.cols());
  for (const auto& corners : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(corners[0]);
    const Eigen::Vector3f b = mesh.vertices.col(corners[1]), c = mesh.vertices.col(corners[2]);
    for (const int v : corners) normals.col(v) += (b - a).cross(c - a);
  }
  for (auto n : normals.colwise()) n.normalize();
  return normals;
}

/// A model with another individual's shape.
class Reshaped final : public Model {
 public:
  explicit Reshaped(ModelData data) : Model(std::move(data)) {}
};

}  // namespace

ShapeTargets::ShapeTargets(const Scene& scene, const std::vector<std::string>& models,
                           const std::vector<std::string>& parameters)
    : models_(find_models(scene, models)) {
  const auto& items = scene.items();
  const Scene::Item& first = items[static_cast<std::size_t>(models_.front())];
  all_ = first.model->shape_parameters();
  for (const int i : models_) {
    const Scene::Item& item = items[static_cast<std::size_t>(i)];
    if (item.model->poses_itself())
      throw ConfigError(fmt::format("shape: '{}' poses itself and cannot be reshaped", item.name));
    if (names_of(item.model->shape_parameters()) == names_of(all_)) continue;
    throw ConfigError(
        fmt::format("shape: '{}' and '{}' have different shape parameters; name those models that "
                    "are of one shape",
                    first.name, item.name));
  }
  const std::vector<std::string> known = names_of(all_);
  for (const std::string& name : parameters) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw ConfigError(fmt::format("shape: '{}' is no shape parameter of '{}'{}", name, first.name,
                                  did_you_mean(name, known)));
  }
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!parameters.empty() &&
        std::find(parameters.begin(), parameters.end(), known[i]) == parameters.end())
      continue;
    wanted_.push_back(all_[i]);
    place_.push_back(i);
  }
}

std::vector<ShapeParameter> ShapeTargets::with(const Eigen::VectorXd& values) const {
  std::vector<ShapeParameter> shape = all_;
  for (std::size_t i = 0; i < place_.size(); ++i)
    shape[place_[i]].value = values[static_cast<Eigen::Index>(i)];
  return shape;
}

ShapePrior ShapeTargets::prior(double weight) const {
  ShapePrior prior;
  Eigen::VectorXd deviation;
  for (Eigen::VectorXd* v : {&prior.mean, &deviation, &prior.lower, &prior.upper})
    v->resize(static_cast<Eigen::Index>(wanted_.size()));
  for (std::size_t k = 0; k < wanted_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    prior.mean[i] = wanted_[k].neutral;
    deviation[i] = wanted_[k].deviation;
    prior.lower[i] = wanted_[k].lower;
    prior.upper[i] = wanted_[k].upper;
  }
  const Eigen::MatrixXd correlations = shape_correlations(all_)(place_, place_);
  const Eigen::MatrixXd covariance = deviation.asDiagonal() * correlations * deviation.asDiagonal();
  prior.precision = covariance.inverse();
  prior.weight = weight;
  return prior;
}

Eigen::VectorXd ShapeTargets::values() const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(wanted_.size()));
  for (std::size_t i = 0; i < wanted_.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = wanted_[i].value;
  return values;
}

std::unique_ptr<Scene> ShapeTargets::reshaped(const Scene& scene, const Eigen::VectorXd& values,
                                              double thinner) const {
  std::vector<double> shape;
  for (const ShapeParameter& p : with(values)) shape.push_back(p.value);
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  for (const Scene::Item& item : scene.items()) models.emplace_back(item.name, item.model);
  for (const int i : models_) {
    auto& model = models[static_cast<std::size_t>(i)].second;
    ModelData data = model->shaped(shape);
    for (Mesh* mesh : {&data.mesh, &data.simplified})
      if (mesh->triangles.cols() > 0)
        mesh->vertices -= static_cast<float>(thinner) * vertex_normals(*mesh);
    model = std::make_shared<Reshaped>(std::move(data));
  }
  return std::make_unique<Scene>(std::move(models));
}

}  // namespace hypotrack::internal
