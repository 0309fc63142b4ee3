#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "line_server.hpp"

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

/// Returns the first line of a stream as JSON: models with the names and units of their parameters
/// and landmarks, cameras, frames per second. `online`: solutions come before smoothing.
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

class Stream final : public Output {
 public:
  struct Params {
    std::optional<int> port;
    std::optional<std::filesystem::path> socket;
    std::optional<std::string> host;
    bool online = true;
    int queue = 64;
    void visit(ParamVisitor& v) {
      v("port", port, {.help = "TCP port to listen at", .min = 1, .max = 65535});
      v("socket", socket, {.help = "socket file to listen at, in place of a port"});
      v("host", host,
        {.help = "address to listen at with a port; default: 127.0.0.1, this machine only; "
                 "0.0.0.0: everyone who can reach this machine"});
      v("online", online,
        {.help = "send solutions as soon as they are there; false: after fixed-lag smoothing"});
      v("queue", queue,
        {.help = "lines that may wait for a slow reader; the oldest are dropped",
         .min = 1,
         .max = 1 << 20});
    }
  };

  Stream(const Params& params, const PluginContext& context)
      : params_(params), address_(checked(params, context.config())) {}

 private:
  std::vector<std::string> do_file_names() const override { return {}; }
  void do_begin(OutputContext& run) override {
    scene_ = &run.scene();
    constexpr std::chrono::seconds kHangs{5};
    server_.emplace(address_, greeting(run, params_.online),
                    Patience{static_cast<std::size_t>(params_.queue), kHangs});
  }
  void do_online(const Frame& frame, const Solution& solution) override {
    if (params_.online) send(frame, solution);
  }
  void do_frame(const Frame& frame, const Solution& solution) override {
    if (!params_.online) send(frame, solution);
  }
  void do_finish(bool complete) override {
    constexpr std::chrono::milliseconds kWait{1000}, kInterrupted{300};
    server_->finish(complete ? kWait : kInterrupted);
  }

  static Address checked(const Params& params, const ConfigNode& config);
  void send(const Frame& frame, const Solution& solution);

  Params params_;
  Address address_;
  const Scene* scene_ = nullptr;
  std::optional<LineServer> server_;
};

Address Stream::checked(const Params& params, const ConfigNode& config) {
  if (params.port.has_value() == params.socket.has_value())
    throw ConfigError(fmt::format("{}: stream has {}; expected one of port and socket",
                                  config.where(),
                                  params.port ? "a port and a socket" : "no port and no socket"));
  if (params.port) return {{}, params.host.value_or("127.0.0.1"), *params.port, config.where()};
  if (params.host)
    throw ConfigError(
        fmt::format("{}: host is given, but a socket file is of this machine; leave "
                    "it out, or write port in place of socket",
                    config.where_key("host")));
  constexpr std::size_t kLongest = 107;  // bytes, on Linux
  if (params.socket->string().size() > kLongest)
    throw ConfigError(fmt::format(
        "{}: the path {} has {} bytes; expected at most {}, the limit for sockets. Name a file in "
        "a shorter folder, such as /tmp",
        config.where_key("socket"), params.socket->string(), params.socket->string().size(),
        kLongest));
  return {*params.socket, {}, 0, config.where()};
}

void Stream::send(const Frame& frame, const Solution& solution) {
  std::string line = solution_json(*scene_, solution, frame.stamp);
  if (frame.taken) {
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - *frame.taken;
    line.pop_back();  // the brace
    line += fmt::format(",\"age\":{:.6f}}}", age.count());
  }
  server_->send(std::move(line));
}

}  // namespace

}  // namespace hypotrack::stream

HYPOTRACK_PLUGIN(hypotrack::stream::Stream,
                 "solutions as lines of JSON to every reader of a TCP port or socket file", "")
