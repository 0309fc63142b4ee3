#include <nlohmann/json.hpp>

#include "hypotrack/api/solution.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack {
namespace {

using Json = nlohmann::ordered_json;

Json parameters(const Model& model, std::span<const double> values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) json[model.data().parameters[i].name] = values[i];
  return json;
}

Json landmarks(const Model& model, const Eigen::Ref<const Eigen::Matrix3Xd>& points) {
  Json json = Json::object();
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    json[model.data().landmarks[static_cast<std::size_t>(i)].name] = {points(0, i), points(1, i),
                                                                      points(2, i)};
  return json;
}

/// Returns the names of a model's hidden landmarks; its first one is the scene's number `first`.
Json hidden(const Model& model, const std::vector<bool>& flags, Eigen::Index first) {
  Json json = Json::array();
  auto flag = flags.begin() + first;
  for (const Landmark& landmark : model.data().landmarks)
    if (*flag++) json.push_back(landmark.name);
  return json;
}

}  // namespace

std::string solution_json(const Scene& scene, const Solution& solution,
                          std::optional<std::int64_t> stamp) {
  Json json;
  json["frame"] = solution.frame;
  json["time"] = solution.time;
  json["status"] = to_string(solution.status);
  json["cost"] = solution.cost;
  json["fault"] = solution.fault == FrameFault::none ? Json() : Json(to_string(solution.fault));
  Json& models = json["models"] = Json::object();
  const Eigen::Matrix3Xd points = scene.landmarks(solution.state);
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Scene::Item& item = scene.items()[m];
    const auto count = static_cast<Eigen::Index>(item.model->data().landmarks.size());
    Json& model = models[item.name];
    model["status"] = m < solution.models.size() ? Json(to_string(solution.models[m])) : Json();
    model["probability"] =
        m < solution.probabilities.size() ? Json(solution.probabilities[m]) : Json();
    model["parameters"] = parameters(*item.model, scene.part(item, solution.state));
    model["landmarks"] = landmarks(*item.model, points.middleCols(first, count));
    if (!solution.hidden.empty()) model["hidden"] = hidden(*item.model, solution.hidden, first);
    first += count;
  }
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  // A double would lose the last digits.
  if (stamp) text.insert(text.find(",\"status\""), ",\"stamp\":" + stamp_text(*stamp));
  return text;
}

}  // namespace hypotrack
