#include "hypotrack/api/tables.hpp"

#include <fmt/format.h>

#include "hypotrack/api/files.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Returns the header line of track.csv with columns of other outputs.
std::string track_header(const Scene& scene, const std::vector<std::string>& others) {
  std::string line = "frame,time,status,cost,evaluations,milliseconds";
  if (scene.items().size() == 1)
    line += ",probability";
  else
    for (const Scene::Item& item : scene.items())
      line += fmt::format(",{0}.status,{0}.probability", item.name);
  for (const Parameter& p : scene.parameters()) line += "," + p.name;
  line += ",hidden,stamp,fault";
  for (const std::string& name : others) line += "," + name;
  return line + "\n";
}

/// Returns the names of hidden landmarks, separated by spaces.
std::string hidden_names(const Scene& scene, const Solution& solution) {
  std::string names;
  for (std::size_t i = 0; i < solution.hidden.size(); ++i)
    if (solution.hidden[i]) names += (names.empty() ? "" : " ") + scene.landmark_names()[i];
  return names;
}

/// Returns a line of track.csv with values of other outputs.
std::string track_line(const Scene& scene, const Frame& frame, const Solution& solution,
                       const std::vector<double>& others) {
  std::string line = fmt::format("{},{},{},{},{},{:.3f}", solution.frame, solution.time,
                                 to_string(solution.status), solution.cost, solution.evaluations,
                                 1000 * solution.seconds);
  for (std::size_t m = 0; m < solution.models.size(); ++m) {
    if (solution.models.size() > 1) line += fmt::format(",{}", to_string(solution.models[m]));
    line += fmt::format(",{:.3f}", solution.probabilities[m]);
  }
  for (const double value : solution.state) line += fmt::format(",{}", value);
  line += ',' + hidden_names(scene, solution) + ',';
  if (frame.stamp) line += stamp_text(*frame.stamp);
  line += ',';
  if (solution.fault != FrameFault::none) line += to_string(solution.fault);
  for (const double value : others) line += fmt::format(",{}", value);
  return line + "\n";
}

/// A table of solutions and one of their landmarks.
class Pair {
 public:
  Pair(OutputContext& run, const std::string& solutions, const std::string& landmarks,
       const std::vector<std::string>& others)
      : scene_(&run.scene()), solutions_(run.file(solutions)), landmarks_(run.file(landmarks)) {
    solutions_.write(track_header(*scene_, others));
    landmarks_.write(landmarks_header(scene_->landmark_names()));
  }
  void add(const Frame& frame, const Solution& solution, const std::vector<double>& others) {
    solutions_.write(track_line(*scene_, frame, solution, others));
    landmarks_.write(
        table_line(solution.frame, solution.time, scene_->landmarks(solution.state).reshaped()));
  }

 private:
  const Scene* scene_;
  TextFile solutions_, landmarks_;
};

class Tables final : public Output {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  explicit Tables(const Params&) {}

 private:
  std::vector<std::string> do_file_names() const override {
    return {"track.csv", "joints.csv", "online.csv", "online_joints.csv"};
  }
  void do_begin(OutputContext& run) override {
    run_ = &run;
    track_.emplace(run, "track.csv", "joints.csv", run.columns());
    if (run.fixed_lag())
      online_.emplace(run, "online.csv", "online_joints.csv", std::vector<std::string>());
  }
  void do_online(const Frame& frame, const Solution& solution) override {
    if (online_) online_->add(frame, solution, {});
  }
  void do_frame(const Frame& frame, const Solution& solution) override {
    track_->add(frame, solution, run_->values(frame, solution));
  }

  OutputContext* run_ = nullptr;
  std::optional<Pair> track_, online_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Tables, "states and landmarks as CSV: track.csv and joints.csv", "")
