#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "hypotrack/api/error.hpp"
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
State ask(Starter& start, const StarterContext& context, std::string* refusal = nullptr) {
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

/// Proposes a model's rest pose at three places.
class ThreePlaces final : public GlobalSearch {
 public:
  explicit ThreePlaces(const Model& model) : model_(model) {}
  void find(const GlobalSearchSettings& /*settings*/, const TakePose& take) override {
    for (const double depth : {0.4, 0.5, 0.6}) {
      Eigen::VectorXd pose(model_.dimension());
      for (Eigen::Index i = 0; i < pose.size(); ++i)
        pose[i] = model_.data().parameters[static_cast<std::size_t>(i)].rest;
      pose[2] = depth;
      if (!take(pose)) return;
    }
  }

 private:
  const Model& model_;
};

using Poses = std::vector<Eigen::VectorXd>;

/// Returns what a starter proposes for every model; at most `most` poses for each.
Poses proposals(Starter& start, const StarterContext& context, std::size_t most) {
  Poses all;
  for (std::size_t m = 0; m < context.scene.items().size(); ++m) {
    ThreePlaces search(*context.scene.items()[m].model);
    std::size_t taken = 0;
    start.find({context.scene, context.cameras, context.frame, &search}, m,
               [&](const Eigen::VectorXd& pose) {
                 require(taken < most, "it goes on after the tracker has enough");
                 all.push_back(pose);
                 return ++taken < most;
               });
  }
  return all;
}

void check_looking(Report& report, const Subject& subject, const StarterContext& context) {
  constexpr std::size_t kAll = 1000;
  const Scene& scene = context.scene;
  const auto start = subject.make<Starter>();
  Poses poses;
  std::string refusal;
  const auto ask_all = [&](Starter& of, std::size_t most) {
    try {
      return proposals(of, context, most);
    } catch (const Error& e) {
      require(std::string(e.what()).size() > 0, "it refuses a frame without a message");
      refusal = e.what();
      return Poses();
    }
  };
  report.row("it proposes poses of the models, or none", [&] {
    poses = ask_all(*start, kAll);
    for (const Eigen::VectorXd& pose : poses) {
      require(pose.size() == scene.dimension(), "a pose has another number of parameters");
      check_state(scene, pose);
    }
    if (poses.empty()) throw Skipped("it finds nothing in plain pictures: " + refusal);
  });
  report.row("asked twice it proposes the same",
             [&] { require(ask_all(*start, kAll) == poses, "it proposes others"); });
  report.row("a second object proposes the same", [&] {
    require(ask_all(*subject.make<Starter>(), kAll) == poses, "it proposes others");
  });
  report.row("it stops when the tracker has enough", [&] { ask_all(*start, 1); });
}

}  // namespace

void check_starter(Report& report, const Subject& subject) {
  if (!check_parameters<Starter>(report, subject, true)) return;
  const Scene& scene = *subject.scene;
  const Surroundings with_truth(scene, true), without(scene, false);
  const StarterContext first{scene, with_truth.cameras, &with_truth.frame};
  const StarterContext bare{scene, without.cameras, &without.frame};
  const StarterContext none{scene, with_truth.cameras, nullptr};
  const auto start = subject.make<Starter>();
  if (start->looks()) return check_looking(report, subject, bare);
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
    const auto second = subject.make<Starter>();
    const State again = ask(*second, first);
    require(again && *again == *state, "it gives another one");
  });
}

}  // namespace hypotrack::contract
