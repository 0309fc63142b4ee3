// Least squares on the residuals of stereo_patch and skin, on a rendered hand.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

struct Found {
  double cost_before, cost_after;
  double error_before, error_after;  ///< mean joint error, m
};

/// Costs of some states (DxN) in a frame whose tiles are cut around the first.
Eigen::VectorXd costs_of(const OpenedScene& session, const Frame& frame,
                         const Eigen::MatrixXd& states) {
  const TileMaker tiles(*session.scene, session.parts.cameras, session.parts.tile);
  const auto cost = make_cost(*session.scene, session.parts.objective, session.parts.evaluate);
  const Observation observation = tiles.make(frame, states.col(0));
  cost->prepare(observation);
  Eigen::VectorXd costs(states.cols());
  cost->evaluate(states, costs);
  return costs;
}

double error_of(const Scene& scene, const Frame& frame, const Eigen::VectorXd& state) {
  return frame_error(landmark_layout(scene.landmark_names()), scene.landmarks(state),
                     scene.landmarks(frame.truth->state))
      .mean;
}

/// One search of the first frame of configs/scenes/demo.yaml, whose right camera is 16 % brighter,
/// from 6 mm and 3 degrees away.
Found search(PluginLoader& plugins, const std::string& objective, const std::string& optimizer,
             int seed, int evaluations = 512) {
  const auto open = [&] {
    return open_scene(
        test::source_dir() / "configs/scenes/demo.yaml",
        std::vector<std::string>{"objective=" + objective, "optimizer=" + optimizer,
                                 fmt::format("budget.evaluations={}", evaluations),
                                 "search={rotation_as: tangent}", "source.sensor.gain=[1, 1.16]",
                                 "evaluate.backend=cpu", "judge=none", "init.away_mm=6",
                                 "init.away_deg=3", fmt::format("seed={}", seed)},
        plugins);
  };
  OpenedScene session = open();
  const Scene& scene = *session.scene;
  const Frame frame = session.source->next().value();
  const Eigen::VectorXd start = initial_state(session, frame);
  SceneTracker tracker(scene, std::move(session.parts), start, session.seed);
  const Solution solution = tracker.track(frame);
  Eigen::MatrixXd states(start.size(), 2);
  states << start, solution.state;
  const Eigen::VectorXd costs = costs_of(open(), frame, states);
  return {costs[0], costs[1], error_of(scene, frame, start),
          error_of(scene, frame, solution.state)};
}

TEST(PatchAndSkinResiduals, OneJacobianLowersTheCostOfEitherTerm) {
  PluginLoader plugins;
  for (const char* objective :
       {"{type: stereo_patch}", "{type: stereo_patch, measure: census}",
        "{type: skin, foreground: color}", "{type: skin, foreground: mask}"}) {
    const Found found = search(plugins, objective, "{type: levenberg_marquardt, iterations: 1}", 1);
    EXPECT_LT(found.cost_after, found.cost_before) << objective;
  }
}

TEST(PatchAndSkinResiduals, LeadLeastSquaresToTheHandFromNearby) {
  PluginLoader plugins;
  for (const int seed : {1, 2}) {
    const Found found = search(plugins, "[{type: stereo_patch}, {type: skin, foreground: color}]",
                               "{type: levenberg_marquardt, jacobian: numerical}", seed);
    EXPECT_GT(found.error_before, 0.005);
    EXPECT_LT(found.error_after, 0.0025) << "seed " << seed;
  }
}

TEST(PatchAndSkinSlopes, LeadLeastSquaresNearlyAsFarWithFewEvaluations) {
  PluginLoader plugins;
  for (const int seed : {1, 2}) {
    const Found found = search(plugins, "[{type: stereo_patch}, {type: skin, foreground: color}]",
                               "{type: levenberg_marquardt, jacobian: analytic}", seed, 100);
    EXPECT_GT(found.error_before, 0.005);
    EXPECT_LT(found.error_after, 0.0030) << "seed " << seed;
  }
}

}  // namespace
}  // namespace hypotrack
