#include "greeting.hpp"

#include <nlohmann/json.hpp>

#include "hypotrack/api/calibration.hpp"

namespace hypotrack::stream {
namespace {

using Json = nlohmann::ordered_json;

const char* unit_of(ParameterKind kind) {
  if (is_in_metres(kind)) return "m";
  return kind == ParameterKind::angle ? "rad" : "1";
}

Json json_of(const Scene::Item& item) {
  Json parameters = Json::object(), landmarks = Json::array();
  for (const Parameter& p : item.model->data().parameters) parameters[p.name] = unit_of(p.kind);
  for (const auto& landmark : item.model->data().landmarks) landmarks.push_back(landmark.name);
  return {{"parameters", parameters}, {"landmarks", landmarks}};
}

Json json_of(const Camera& camera) {
  Json pose = Json::array();
  for (const auto& row : camera.camera_from_world.matrix().rowwise())
    pose.push_back({row[0], row[1], row[2], row[3]});
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"distortion_model",
           enum_names(camera.distortion_model)[static_cast<std::size_t>(camera.distortion_model)]},
          {"distortion", camera.distortion},
          {"camera_from_world", pose}};
}

}  // namespace

std::string greeting(const OutputContext& run, bool online) {
  Json json;
  json["stream"] = "hypotrack";
  json["version"] = 1;  // of these lines
  json["online"] = online;
  json["frame_rate"] = run.frame_rate();
  json["units"] = {{"time", "s"}, {"age", "s"}, {"landmarks", "m"}};
  for (const Scene::Item& item : run.scene().items()) json["models"][item.name] = json_of(item);
  for (const Camera& camera : run.cameras()) json["cameras"].push_back(json_of(camera));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hypotrack::stream
