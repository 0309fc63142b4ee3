#include "output_run.hpp"

#include <fstream>
#include <random>
#include <sstream>

#include "test_models.hpp"

namespace hypotrack::test {

std::unique_ptr<Scene> make_scene(
    const std::vector<std::pair<std::string, std::string>>& models_by_name) {
  PluginLoader loader;
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  for (const auto& [name, yaml] : models_by_name)
    models.emplace_back(name, loader.make<Model>(ConfigNode::parse(yaml, "scene.yaml")));
  return std::make_unique<Scene>(std::move(models));
}

Solution tracked(const Scene& scene, int frame, const Eigen::VectorXd& state) {
  Solution solution;
  solution.frame = frame;
  solution.time = frame / 30.0;
  solution.status = Status::tracked;
  solution.models.assign(scene.items().size(), Status::tracked);
  solution.probabilities.assign(scene.items().size(), 0.9);
  solution.state = state;
  solution.landmarks = scene.landmarks(state);
  return solution;
}

void set_status(Solution& solution, std::size_t model, Status status) {
  solution.models[model] = solution.status = status;
}

std::vector<Solution> random_solutions(const Scene& scene, int count) {
  std::mt19937_64 random(7);
  std::vector<Solution> solutions;
  for (int i = 0; i < count; ++i)
    solutions.push_back(tracked(scene, i, random_state(scene, random)));
  return solutions;
}

OutputRun::OutputRun(const Scene& scene) : scene_(scene), cameras_(2) {
  for (Camera& camera : cameras_) {
    camera.width = 640;
    camera.height = 480;
    camera.fx = camera.fy = 500;
    camera.cx = 319.5;
    camera.cy = 239.5;
  }
  cameras_[1].distortion_model = DistortionModel::brown;
  cameras_[1].distortion = {-0.2, 0.05, 0.001, 0.002};
  cameras_[1].camera_from_world.translation().x() = -0.1;
}

std::unique_ptr<Output> OutputRun::open(const std::string& yaml) const {
  PluginLoader loader;
  return loader.make<Output>(ConfigNode::parse(yaml, "scene.yaml"), &scene_);
}

std::unique_ptr<Output> OutputRun::begin(const std::string& yaml,
                                         const std::vector<Solution>& solutions) {
  std::unique_ptr<Output> output = open(yaml);
  output->begin(*this);
  for (const Solution& solution : solutions) {
    Frame frame;
    frame.index = solution.frame;
    frame.time = solution.time;
    if (stamp) frame.stamp = *stamp + solution.frame;
    output->online(frame, solution);
    output->frame(frame, solution);
  }
  return output;
}

void OutputRun::play(const std::string& yaml, const std::vector<Solution>& solutions,
                     bool complete) {
  begin(yaml, solutions)->finish(complete);
}

void OutputRun::play_killed(const std::string& yaml, const std::vector<Solution>& solutions) {
  begin(yaml, solutions);
}

std::string OutputRun::text(const std::string& name) const {
  std::stringstream text;
  text << std::ifstream(folder_.path() / name, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::string> OutputRun::lines(const std::string& name) const {
  std::stringstream stream(text(name));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    if (!line.starts_with('#')) lines.push_back(line);
  return lines;
}

}  // namespace hypotrack::test
