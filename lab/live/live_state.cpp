#include "lab/live/live_state.hpp"

#include <cmath>

#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "lab/report/replay.hpp"

namespace hypotrack::internal {
namespace {

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json rounded(double value, double step) {
  return std::isfinite(value) ? Json(std::round(value / step) * step) : Json();
}

Json millimetres(double metres) { return rounded(1000 * metres, 0.001); }

/// Returns the rotations (x, y, z, w) and translations of all bones from the bind pose to the
/// world, or the landmarks of a model that poses itself.
Json motion_of(const Model& model, std::span<const double> parameters) {
  constexpr double kStep = 1e-6;
  if (model.poses_itself()) {
    const Eigen::Matrix3Xd points = posed_landmarks(model, parameters);
    Json p = Json::array();
    for (const double x : points.reshaped()) p.push_back(rounded(x, kStep));
    return {{"points", points.cols()}, {"p", std::move(p)}};
  }
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(model.data());
  const std::vector<Eigen::Isometry3d> posed = world_from_bones(model.data(), parameters);
  Json rotations = Json::array(), translations = Json::array();
  for (std::size_t b = 0; b < bind.size(); ++b) {
    const Eigen::Isometry3d moved = posed[b] * bind[b].inverse();
    const Eigen::Quaterniond q = Eigen::Quaterniond(moved.linear()).normalized();
    for (const double x : q.coeffs()) rotations.push_back(rounded(x, kStep));
    for (const double x : moved.translation()) translations.push_back(rounded(x, kStep));
  }
  return {{"bones", bind.size()}, {"q", std::move(rotations)}, {"t", std::move(translations)}};
}

Json models_of(const Scene& scene, const LiveFrame& frame) {
  const Solution& solution = frame.solution;
  Json models = Json::array();
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Scene::Item& item = scene.items()[m];
    models.push_back({{"name", item.name},
                      {"status", to_string(solution.models[m])},
                      {"probability", rounded(solution.probabilities[m], 1e-4)},
                      {"sigma_mm", millimetres(frame.sigmas[m])},
                      {"motion", motion_of(*item.model, scene.part(item, solution.state))}});
  }
  return models;
}

/// Returns a state's numbers for plots.
Json sample_of(const Json& state, double seconds) {
  Json sample = {{"seconds", rounded(seconds, 0.001)},
                 {"milliseconds", state["milliseconds"]},
                 {"error_mm", state["error_mm"]},
                 {"probability", Json::array()},
                 {"sigma_mm", Json::array()}};
  for (const Json& model : state["models"]) {
    sample["probability"].push_back(model["probability"]);
    sample["sigma_mm"].push_back(model["sigma_mm"]);
  }
  return sample;
}

}  // namespace

void LiveState::begin(const Scene& scene, std::optional<int> frames) {
  Json models = Json::array();
  for (const Scene::Item& item : scene.items())
    models.push_back({{"name", item.name},
                      {"shape", replay_shape(*item.model)},
                      {"motion", motion_of(*item.model, scene.part(item, scene.rest_state()))}});
  const std::lock_guard lock(mutex_);
  scene_["frames"] = frames ? Json(*frames) : Json();
  scene_["models"] = std::move(models);
  runs_ = true;
  publish();
}

void LiveState::add(const Scene& scene, const LiveFrame& frame) {
  constexpr std::chrono::milliseconds kSampled{100};
  constexpr std::size_t kSamples = 3000;
  const Solution& solution = frame.solution;
  solutions_.put(solution_json(scene, solution, frame.stamp));
  Json models = models_of(scene, frame);
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - begun_).count();
  newest_ = {{"frame", solution.frame},
             {"time", rounded(solution.time, 1e-6)},
             {"status", to_string(solution.status)},
             {"seconds", rounded(seconds, 0.001)},
             {"fps", rounded(frame.fps, 0.01)},
             {"milliseconds", rounded(1000 * solution.seconds, 0.01)},
             {"error_mm", millimetres(frame.error)},
             {"models", std::move(models)}};
  if (history_.empty() || now - sampled_ >= kSampled) {
    history_.push_back(sample_of(newest_, seconds));
    if (history_.size() > kSamples) history_.pop_front();
    sampled_ = now;
  }
  publish();
}

void LiveState::set_paused(bool paused) {
  const std::lock_guard lock(mutex_);
  if (paused_ == paused) return;
  paused_ = paused;
  publish();
}

void LiveState::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  text_ = text;
  publish();
}

void LiveState::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  publish();
  states_.close();
  solutions_.close();
}

void LiveState::publish() {
  Json state = {{"run", ended_    ? "ended"
                        : paused_ ? "paused"
                        : runs_   ? "runs"
                                  : "waits"},
                {"text", text_}};
  state.update(newest_);
  states_.put(one_line(state));
}

std::string LiveState::scene_json() const {
  const std::lock_guard lock(mutex_);
  return one_line(scene_);
}

std::string LiveState::history_json() const {
  const std::lock_guard lock(mutex_);
  return one_line({{"samples", history_}});
}

}  // namespace hypotrack::internal
