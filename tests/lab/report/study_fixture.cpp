#include "study_fixture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

Scene open_scene(const std::string& models) {
  PluginLoader plugins;
  const ConfigNode list = ConfigNode::parse("models: " + models, "fixture").get("models");
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> made;
  for (std::size_t i = 0; i < list.size(); ++i)
    made.emplace_back(list.at(i).get("name").scalar(),
                      plugins.make<Model>(list.at(i), nullptr, {"name"}));
  return Scene(std::move(made));
}

/// A motion that moves and turns every model and bends every joint.
std::vector<StateRow> true_states(const Scene& scene, int frames) {
  std::vector<StateRow> rows;
  for (int frame = 0; frame < frames; ++frame) {
    StateRow row{frame, frame / 30.0, scene.rest_state()};
    const double phase = 0.21 * frame;
    for (const Scene::Item& item : scene.items()) {
      auto part = row.state.segment(item.offset, item.model->dimension());
      part.head<3>() << 0.15 * item.offset / 27 + 0.05 * std::sin(phase), 0.03 * std::cos(phase),
          0.5 + 0.04 * std::sin(0.5 * phase);
      part.segment<4>(3) << std::cos(1.5), std::sin(1.5), 0.2 * std::sin(0.4 * phase), 0;
      for (Eigen::Index k = 7; k < part.size(); ++k) {
        const Parameter& p = item.model->data().parameters[static_cast<std::size_t>(k)];
        part[k] = p.rest + (0.25 + 0.25 * std::sin(phase)) * (p.upper - p.rest);
      }
    }
    scene.normalize(row.state);
    rows.push_back(std::move(row));
  }
  return rows;
}

struct Noisy {
  std::vector<StateRow> tracked;
  std::vector<double> errors_mm;
};

/// The true states with every model moved by about the error.
Noisy tracked_states(const Scene& scene, const std::vector<StateRow>& truth,
                     const RunFixture& run) {
  std::mt19937 random(run.seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Noisy noisy;
  for (const StateRow& row : truth) {
    const bool lost = run.lost_from >= 0 && row.frame >= run.lost_from;
    const double error = run.error_mm * (0.5 + uniform()) + (lost ? 60 : 0);
    noisy.tracked.push_back(row);
    for (const Scene::Item& item : scene.items())
      noisy.tracked.back().state[item.offset + (row.frame / 5) % 3] += 1e-3 * error;
    noisy.errors_mm.push_back(error);
  }
  return noisy;
}

double cost_of(double error_mm) { return 0.2 + 0.01 * error_mm; }

std::string track_csv(const Scene& scene, const Noisy& noisy, const RunFixture& run) {
  std::string text = "frame,time,status,cost,evaluations,milliseconds";
  for (const Parameter& p : scene.parameters()) text += "," + p.name;
  text += "\n";
  for (std::size_t i = 0; i < noisy.tracked.size(); ++i) {
    const StateRow& row = noisy.tracked[i];
    const bool lost = run.lost_from >= 0 && row.frame >= run.lost_from;
    text += fmt::format("{},{},{},{},1024,{}", row.frame, row.time, lost ? "lost" : "tracked",
                        cost_of(noisy.errors_mm[i]), 20 + noisy.errors_mm[i]);
    for (const double value : row.state) text += fmt::format(",{}", value);
    text += "\n";
  }
  return text;
}

std::string errors_csv(const Scene& scene, const Noisy& noisy) {
  std::string text = "frame,time,mean_joint_error_mm";
  for (const Scene::Item& item : scene.items()) text += "," + item.name;
  text += "\n";
  for (std::size_t i = 0; i < noisy.tracked.size(); ++i) {
    text += fmt::format("{},{}", noisy.tracked[i].frame, noisy.tracked[i].time);
    for (std::size_t k = 0; k <= scene.items().size(); ++k)
      text += fmt::format(",{:.4f}", noisy.errors_mm[i]);
    text += "\n";
  }
  return text;
}

/// Searches of eight generations whose costs fall towards that of the truth, -1, and end above it
/// by about a per cent per millimetre of error.
std::string trace_csv(const Noisy& noisy, int generation) {
  std::string text =
      "frame,search,dimension,evaluations,cost,truth_cost,cpu_seconds,wall_seconds\n";
  for (std::size_t i = 0; i < noisy.tracked.size(); ++i)
    for (int k = 1; k <= 8; ++k)
      text += fmt::format("{},0,7,{},{},-1,{},{}\n", noisy.tracked[i].frame, generation * k,
                          -1 + 0.01 * noisy.errors_mm[i] + std::exp(-k), 0.01 * k, 0.005 * k);
  return text;
}

/// Truth that costs less than any answer, but in every fourth frame more.
std::string truth_costs_csv(const Noisy& noisy) {
  std::string text = "frame,cost,truth_cost,mean_joint_error_mm,outcome\n";
  for (std::size_t i = 0; i < noisy.tracked.size(); ++i) {
    const int frame = noisy.tracked[i].frame;
    const double error = noisy.errors_mm[i], cost = cost_of(error),
                 truth = frame % 4 == 3 ? 2 : 0.1;
    text += fmt::format("{},{},{},{},{}\n", frame, cost, truth, error,
                        error < 20     ? "found"
                        : truth < cost ? "search_failed"
                                       : "objective_failed");
  }
  return text;
}

Json metrics_json(const Scene& scene, std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  double sum = 0;
  for (const double error : errors) sum += error;
  const auto below = [&](double threshold) {
    return static_cast<double>(std::lower_bound(errors.begin(), errors.end(), threshold) -
                               errors.begin()) /
           n;
  };
  Json json{{"frames", errors.size()},
            {"mean_error_mm", sum / n},
            {"median_error_mm", errors[errors.size() / 2]},
            {"p95_error_mm", errors[errors.size() * 95 / 100]},
            {"max_error_mm", errors.back()},
            {"auc_20_50", below(35)},
            {"success_20mm", below(20)},
            {"lost_share", 1 - below(40)},
            {"time_to_loss_s", nullptr},
            {"jitter_mm", 0.1 * sum / n}};
  for (const Scene::Item& item : scene.items()) json["models"][item.name] = sum / n;
  for (const std::string& name : scene.landmark_names()) json["landmarks"][name] = sum / n;
  for (int threshold = 0; threshold <= 50; ++threshold) {
    json["success_curve"]["threshold_mm"].push_back(threshold);
    json["success_curve"]["share"].push_back(below(threshold));
  }
  return json;
}

void write_pictures(const fs::path& directory, int count) {
  for (int i = 0; i < count; ++i) {
    cv::Mat picture(180, 240, CV_8UC3, cv::Scalar(90, 80, 70));
    cv::circle(picture, {60 + 50 * i, 90}, 40, cv::Scalar(60, 120, 230), 4);
    write_image((directory / fmt::format("worst_{:06}.jpg", 1 + 10 * i)).string(), picture);
  }
}

}  // namespace

void write_run(const fs::path& directory, const RunFixture& run) {
  fs::create_directories(directory);
  const Scene scene = open_scene(run.models);
  const std::vector<StateRow> truth = true_states(scene, run.frames);
  const Noisy noisy = tracked_states(scene, truth, run);
  write_text(directory / "run.yaml", "models: " + run.models + "\n");
  write_text(directory / "track.csv", track_csv(scene, noisy, run));
  write_text(directory / "summary.json", Json{{"complete", true},
                                              {"frames", run.frames},
                                              {"fps", 20 + 0.1 * run.seed},
                                              {"evaluations_per_second", 20480},
                                              {"backend", "cuda (NVIDIA H200, GPU 1)"}}
                                             .dump());
  if (run.truth_states) write_states(directory / "truth_states.csv", scene, truth);
  if (run.truth_landmarks) {
    std::vector<LandmarkRow> rows;
    for (const StateRow& row : truth)
      rows.push_back({row.frame, row.time, scene.landmarks(row.state)});
    write_landmarks(directory / "truth_landmarks.csv", scene.landmark_names(), rows);
    write_text(directory / "errors.csv", errors_csv(scene, noisy));
    write_text(directory / "metrics.json", metrics_json(scene, noisy.errors_mm).dump(1));
  }
  if (run.trace) {
    write_text(directory / "trace.csv", trace_csv(noisy, run.generation));
    write_text(directory / "truth_costs.csv", truth_costs_csv(noisy));
  }
  write_pictures(directory, run.worst);
}

void write_study(const fs::path& directory, const StudyFixture& study) {
  fs::create_directories(directory / "runs");
  const auto list = [](const std::vector<int>& values) {
    return fmt::format("[{}]", fmt::join(values, ", "));
  };
  write_text(directory / "study.yaml", "title: " + Json(study.title).dump() +
                                           "\nabout: Made for a test.\n"
                                           "scenes:\n"
                                           "  stereo: {file: scene.yaml, label: \"SH, stereo\"}\n"
                                           "  rgbd: {file: scene.yaml, label: \"SH, RGBD\"}\n"
                                           "grid:\n"
                                           "  optimizer.particles: " +
                                           list(study.particles) +
                                           "\n  optimizer.generations: " + list(study.generations) +
                                           fmt::format("\nseeds: {}\n", study.seeds) +
                                           (study.plots.empty() ? "" : "plots:\n" + study.plots));
  int number = 0;
  fs::path last;
  for (const std::string scene : {"stereo", "rgbd"})
    for (const int particles : study.particles)
      for (const int generations : study.generations)
        for (int seed = 1; seed <= study.seeds; ++seed) {
          RunFixture run = study.run;
          if (seed == 1 || !study.same) ++number;
          run.seed = static_cast<unsigned>(number);
          run.trace = study.trace;
          run.generation = particles;
          run.error_mm *= std::sqrt(1024.0 / (particles * generations)) *
                          (scene == "rgbd" ? study.scene_gain : 1);
          last = directory / "runs" /
                 fmt::format("{}_p{}_g{}_s{}", scene, particles, generations, seed);
          write_run(last, run);
          const Json settings{{"optimizer.particles", particles},
                              {"optimizer.generations", generations}};
          write_text(last / "cell.json",
                     Json{{"scene", scene}, {"settings", settings}, {"seed", seed}}.dump());
        }
  if (study.failure_message.empty()) return;
  const std::string cell = "cell.json";
  for (const auto& entry : fs::directory_iterator(last))
    if (entry.path().filename() != cell) fs::remove(entry.path());
  write_text(last / "failure.json",
             Json{{"message", study.failure_message}, {"exit_code", 1}}.dump());
}

}  // namespace hypotrack::test
