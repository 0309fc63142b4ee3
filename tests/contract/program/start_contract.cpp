#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "hypotrack/error.hpp"
#include "subject.hpp"
#include "test_models.hpp"

namespace hypotrack::contract {
namespace {

/// A plain pair of views of a hand, with its ground truth or without.
struct Surroundings {
  std::vector<Camera> cameras;
  Frame frame;

  Surroundings(const Scene& scene, bool truth) {
    Camera camera;
    camera.width = 64;
    camera.height = 48;
    camera.fx = camera.fy = 60;
    camera.cx = 31.5;
    camera.cy = 23.5;
    cameras = {camera, camera};
    cameras[1].camera_from_world.translation().x() = -0.06;
    for (int i = 0; i < 2; ++i)
      frame.views.push_back({.color = cv::Mat(48, 64, CV_8UC3, cv::Scalar(80, 90, 120))});
    if (!truth) return;
    std::mt19937_64 random(1);
    const Eigen::VectorXd state = test::random_state(scene, random);
    frame.truth = GroundTruth{state, scene.landmarks(state)};
  }
};

using State = std::optional<Eigen::VectorXd>;

/// Asks a start about a frame that may lack what it needs. Returns nothing if it refuses the frame
/// with an error of hypotrack, whose text goes to `refusal`.
State ask(Start& start, const StartContext& context, std::string* refusal = nullptr) {
  try {
    return start.state(context);
  } catch (const Error& e) {
    require(std::string(e.what()).size() > 0, "it refuses a frame without a message");
    if (refusal) *refusal = e.what();
    return std::nullopt;
  }
}

void check_state(const Scene& scene, const Eigen::VectorXd& state) {
  try {
    scene.check(state, "the state");
  } catch (const ConfigError& e) {
    throw Violation(e.what());
  }
  for (const Scene::Item& item : scene.items()) {
    const double norm = state.segment<4>(item.offset + 3).norm();
    require(std::abs(norm - 1) < 1e-9, "the quaternion of '" + item.name + "' has the length " +
                                           std::to_string(norm) + ", expected 1");
  }
}

}  // namespace

void check_start(Report& report, const Subject& subject) {
  if (!check_parameters<Start>(report, subject, true)) return;
  const Scene& scene = *subject.scene;
  const Surroundings with_truth(scene, true), without(scene, false);
  const StartContext first{scene, with_truth.cameras, &with_truth.frame};
  const StartContext bare{scene, without.cameras, &without.frame};
  const StartContext none{scene, with_truth.cameras, nullptr};
  const auto start = subject.make<Start>();
  State state;
  report.row("it gives a state for a frame", [&] {
    std::string refusal;
    state = ask(*start, first, &refusal);
    require(state || !refusal.empty(), "it gives nothing and throws nothing");
    if (!state) throw Skipped("it refuses plain pictures: " + refusal);
  });
  if (state) report.row("its state fits the scene", [&] { check_state(scene, *state); });
  report.row("it gives a state or an error of hypotrack for a frame without ground truth", [&] {
    std::string refusal;
    const State other = ask(*start, bare, &refusal);
    require(other || !refusal.empty(), "it gives nothing and throws nothing");
    if (other) check_state(scene, *other);
  });
  report.row("without a frame it gives that state or nothing", [&] {
    const State early = ask(*start, none);
    if (!early) throw Skipped("it gives nothing");
    require(state && *early == *state, "it gives another one");
  });
  if (!state) return;
  report.row("asked twice it gives the same", [&] {
    const State again = ask(*start, first);
    require(again && *again == *state, "it gives another one");
  });
  report.row("a second object gives the same", [&] {
    const auto second = subject.make<Start>();
    const State again = ask(*second, first);
    require(again && *again == *state, "it gives another one");
  });
}

}  // namespace hypotrack::contract
