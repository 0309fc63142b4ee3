// A real stereo pair with labelled joints: configs/scenes/stb_pair.yaml. What the paper's objective
// makes of it is recorded, not asserted; docs/results/real_pictures.md says what was found and why.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "hypotrack/plugin/landmark_fit.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

// Left over right on the hand at the labels, median over its pixels and the three channels.
constexpr double kRightGain = 0.8605;

struct Stb {
  OpenedScene session;
  Frame frame;
  Eigen::VectorXd fitted;  ///< the pose of the scene

  double distance(const Eigen::VectorXd& state) const {
    return frame_error(landmark_layout(session.scene->landmark_names()),
                       session.scene->landmarks(state), frame.truth->landmarks)
        .mean;
  }
};

Stb open_stb(PluginLoader& plugins, std::vector<std::string> overrides = {}) {
  const auto stb = test::shared_data() / "stereo" / "stb";
  overrides.push_back("source.left=" + (stb / "BB_left_%d.png").string());
  overrides.push_back("source.right=" + (stb / "BB_right_%d.png").string());
  overrides.push_back("source.truth_landmarks=" + (stb / "B1Counting_BB_rows000-499.csv").string());
  Stb out{
      open_scene(test::source_dir() / "configs/scenes/stb_pair.yaml", overrides, plugins), {}, {}};
  out.frame = out.session.source->next().value();
  out.fitted = initial_state(out.session, out.frame);
  return out;
}

/// The pair with the paper's objective.
Stb open_with_colors(PluginLoader& plugins, const std::string& beta) {
  return open_stb(plugins, {fmt::format("objective={{type: stereo_color, beta: {}}}", beta)});
}

/// The hand and its size fitted to the labels.
LandmarkFit fit_with_scale(const Stb& stb, const Eigen::VectorXd& start) {
  const Scene& scene = *stb.session.scene;
  const Scene::Item& hand = scene.items().front();
  return fit_landmarks(*hand.model, stb.frame.truth->landmarks, scene.part(hand, start),
                       {.scale = true});
}

/// The brightness of the right image brought to the left one's.
void match_brightness(Frame& frame) {
  cv::Mat matched;
  frame.views[1].color.convertTo(matched, CV_8U, kRightGain);
  frame.views[1].color = matched;
}

/// The pose moved by `metres` in a random direction and turned about its wrist by `radians`.
Eigen::VectorXd displaced(Eigen::VectorXd state, double metres, double radians,
                          std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::Vector3d(x, y, z).normalized();
  };
  const Eigen::Quaterniond q(state[3], state[4], state[5], state[6]);
  state.head<3>() += metres * direction();
  const Eigen::Quaterniond turned = q * Eigen::AngleAxisd(radians, direction());
  state.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  return state;
}

/// Searches the pair once from `start`, without a judge; the seed is the search's.
Solution search(const Stb& stb, const Frame& frame, const Eigen::VectorXd& start, int size,
                std::uint64_t seed, PluginLoader& plugins) {
  TrackerParts parts;
  parts.cameras = stb.session.parts.cameras;
  parts.objective = stb.session.parts.objective;
  parts.tile = stb.session.parts.tile;
  parts.photometric.match = false;  // as the caller has left the frame
  parts.optimizer = plugins.make<Optimizer>(ConfigNode::parse(
      fmt::format("{{type: pso, particles: {0}, generations: {0}}}", size), "stb test"));
  SceneTracker tracker(*stb.session.scene, std::move(parts), start, seed);
  return tracker.track(frame);
}

/// Costs of states on the tiles around the first of them.
Eigen::VectorXd costs(const Stb& stb, const Frame& frame, const Eigen::MatrixXd& states) {
  const TileMaker tiles(*stb.session.scene, stb.session.parts.cameras, stb.session.parts.tile);
  const auto cost =
      make_cost(*stb.session.scene, stb.session.parts.objective, stb.session.parts.evaluate);
  const Observation observation = tiles.make(frame, states.col(0));
  cost->prepare(observation);
  Eigen::VectorXd out(states.cols());
  cost->evaluate(states, out);
  return out;
}

TEST(StbPair, TheHandFitsTheLabelsAndTheSceneStartsThere) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  const Stb stb = open_stb(plugins);
  // As far off as a look at the image gets.
  Eigen::VectorXd start = stb.session.scene->rest_state();
  start.head<3>() << 0.129, 0.098, 0.660;
  const Eigen::Vector3d turn = kDegree * Eigen::Vector3d(172.4, -23.0, -10.4);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  start.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
  ASSERT_GT(stb.distance(start), 0.010);

  const LandmarkFit fit = fit_with_scale(stb, start);
  fmt::print("fit to the labels: {:.2f} mm from {:.1f} mm; the scene's pose: {:.2f} mm\n",
             1e3 * fit.mean_distance, 1e3 * stb.distance(start), 1e3 * stb.distance(stb.fitted));
  EXPECT_LT(fit.mean_distance, 0.004);
  EXPECT_NEAR(fit.scale, 1, 0.005) << "of the model with the scale in the scene";
  EXPECT_NEAR(stb.distance(stb.fitted), fit.mean_distance, 1e-4);
}

TEST(StbPair, TheWebxrHandFitsTheLabelsToo) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const auto folder = test::shared_data() / "hands" / "webxr";
  std::string mesh;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".glb") mesh = entry.path().string();
  PluginLoader plugins;
  const Stb stb = open_stb(plugins, {"models.0.of.mesh=" + mesh, "models.0.of.rig=webxr",
                                     "models.0.of.scale=1", "init.pose.hand.angles_deg={}"});
  const LandmarkFit fit = fit_with_scale(stb, stb.fitted);
  fmt::print("WebXR hand: {:.2f} mm at scale {:.3f}\n", 1e3 * fit.mean_distance, fit.scale);
  EXPECT_LT(fit.mean_distance, 0.005);
  EXPECT_NEAR(fit.scale, 0.936, 0.01);
}

TEST(StbPair, WithEqualBrightnessTheScorePeaksAtTheLabelledDepth) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  for (const char* beta : {"100", "25"}) {
    const Stb stb = open_with_colors(plugins, beta);
    Frame frame = stb.frame;
    match_brightness(frame);
    Eigen::MatrixXd states = stb.fitted.replicate(1, 13);
    for (int i = 1; i < 13; ++i) states(2, i) += 0.005 * (i <= 6 ? i : 6 - i);
    const Eigen::VectorXd score = -costs(stb, frame, states);
    Eigen::Index best = 0;
    score.maxCoeff(&best);
    EXPECT_LE(std::abs(states(2, best) - stb.fitted[2]), 0.0051) << "beta " << beta;
    EXPECT_LT(score[6], 0.5 * score[0]) << "30 mm behind";
    EXPECT_LT(score[12], 0.5 * score[0]) << "30 mm before";
  }
}

/// What the right image shows on the hand: blue, green and red, medians.
std::array<float, 3> right_levels(const Stb& stb, const TileMaker& tiles) {
  ColorSampler sampler(*stb.session.scene);
  sampler.draw(tiles.plan(stb.frame, stb.fitted).header, stb.fitted);
  ColorSamples samples = sampler.take(stb.frame, tiles.resamplers(), 1);
  std::array<float, 3> levels{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::sort(samples.other[i].begin(), samples.other[i].end());
    levels[i] = samples.other[i].at(samples.size() / 2);
  }
  return levels;
}

TEST(StbPair, ThePhotometricMatchFindsTheBrightness) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  const Stb stb = open_stb(plugins);
  const TileMaker tiles(*stb.session.scene, stb.session.parts.cameras, stb.session.parts.tile);
  const std::array<float, 3> levels = right_levels(stb, tiles);
  std::mt19937_64 random(3);
  for (const double away : {0.0, 0.010, 0.020, 0.030}) {
    const Eigen::VectorXd state = displaced(stb.fitted, away, 500 * away * kDegree, random);
    TilePlan plan = tiles.plan(stb.frame, state);
    PhotometricMatch match(*stb.session.scene, {});
    match.learn(tiles, stb.frame, plan, state);
    ASSERT_TRUE(match.knows()) << away;
    match.apply(plan);
    const ColorMap& map = plan.views[1].colors;
    for (std::size_t i = 0; i < 3; ++i) {
      const float gain = map.gain[i] + map.offset[i] / levels[i];
      fmt::print("{:.0f} mm away, channel {}: {:.3f} v {:+.1f}, so {:.3f} at {:.0f}\n", 1e3 * away,
                 i, map.gain[i], map.offset[i], gain, levels[i]);
      EXPECT_NEAR(gain, kRightGain, away == 0 ? 0.015 : 0.06) << away << " m, channel " << i;
    }
  }
}

/// Records where the search goes from the fitted pose and from 10 mm and 5 degrees away.
void record_searches(const Stb& stb, const Frame& frame, const std::string& name, int size,
                     PluginLoader& plugins) {
  constexpr int kDraws = 3;
  for (const bool away : {false, true}) {
    std::mt19937_64 random(7);
    double before = 0, after = 0;
    int above = 0;
    for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
      const Eigen::VectorXd start =
          away ? displaced(stb.fitted, 0.010, 5 * kDegree, random) : stb.fitted;
      ASSERT_NEAR((start - stb.fitted).head<3>().norm(), away ? 0.010 : 0, 1e-9);
      ASSERT_NEAR(std::abs(start.segment<4>(3).dot(stb.fitted.segment<4>(3))),
                  std::cos(away ? 2.5 * kDegree : 0), 1e-9);
      Eigen::MatrixXd states(start.size(), 2);
      states << start, stb.fitted;
      const Eigen::VectorXd known = costs(stb, frame, states);
      const Solution solution = search(stb, frame, start, size, seed, plugins);
      ASSERT_EQ(solution.evaluations, size * size);
      ASSERT_LE(solution.cost, known[0]) << "worse than its own start";
      ASSERT_TRUE(std::isfinite(stb.distance(solution.state)));
      before += 1e3 * stb.distance(start) / kDraws;
      after += 1e3 * stb.distance(solution.state) / kDraws;
      above += solution.cost < known[1];
    }
    const std::string line = fmt::format("{:.1f} -> {:.1f} mm, {} of {} score above the labels",
                                         before, after, above, kDraws);
    const std::string key = fmt::format("{}_pso_{}_{}", name, size, away ? "10mm_5deg" : "fitted");
    testing::Test::RecordProperty(key, line);
    fmt::print("{}: {}\n", key, line);
  }
}

TEST(StbPair, SearchesEndAndAreRecorded) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  for (const char* beta : {"100", "25"}) {
    const Stb stb = open_with_colors(plugins, beta);
    Frame matched = stb.frame;
    match_brightness(matched);
    for (const int size : {32, 64}) {
      record_searches(stb, stb.frame, std::string("as_it_is_beta_") + beta, size, plugins);
      record_searches(stb, matched, std::string("matched_beta_") + beta, size, plugins);
      if (HasFatalFailure()) return;
    }
  }
}

/// Mean distance to the labels, mm, after one search per seed from that far away; the colours are
/// learned there, too. `settings` override the scene's.
double mean_found(PluginLoader& plugins, int away_mm, int away_deg, int draws,
                  const std::vector<std::string>& settings = {}) {
  double mean = 0;
  for (int seed = 1; seed <= draws; ++seed) {
    std::vector<std::string> overrides = settings;
    overrides.push_back(fmt::format("init.away_mm={}", away_mm));
    overrides.push_back(fmt::format("init.away_deg={}", away_deg));
    overrides.push_back(fmt::format("seed={}", seed));
    overrides.push_back("evaluate.threads=1");
    Stb stb = open_stb(plugins, std::move(overrides));
    const Eigen::VectorXd start = stb.fitted;
    SceneTracker tracker(*stb.session.scene, std::move(stb.session.parts), start, stb.session.seed);
    const Solution solution = tracker.track(stb.frame);
    EXPECT_LE(solution.evaluations, 8 * 1024);  // eight starts
    mean += 1e3 * stb.distance(solution.state) / draws;
  }
  return mean;
}

TEST(StbPair, IsFoundByPatchesAndSkinFromFarAway) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  for (const int steps : {1, 2, 3}) {
    const double found = mean_found(plugins, 10 * steps, 5 * steps, 8);
    fmt::print("from {} mm, {} degrees: {:.1f} mm\n", 10 * steps, 5 * steps, found);
    EXPECT_LE(found, 8) << "from " << 10 * steps << " mm away";
  }
}

/// The recommended tracker, as overrides of another scene.
std::vector<std::string> recommended_tracker() {
  return {"tracker=@" + (test::source_dir() / "configs/trackers/recommended.yaml").string()};
}

TEST(StbPair, IsFoundByTheRecommendedTrackerFromFarAway) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  PluginLoader plugins;
  const std::vector<std::string> tracker = recommended_tracker();
  for (const int steps : {1, 2, 3}) {
    const double found = mean_found(plugins, 10 * steps, 5 * steps, 8, tracker);
    fmt::print("from {} mm, {} degrees: {:.1f} mm\n", 10 * steps, 5 * steps, found);
    EXPECT_LE(found, 9) << "from " << 10 * steps << " mm away";
  }
}

}  // namespace
}  // namespace hypotrack
