// Hypotheses drawn with OpenGL against those that the CPU draws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "cost/cost.hpp"
#include "cost/draw/hypothesis_renderer.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack::test {
namespace {

constexpr float kDepthTolerance = 1e-4F;  // relative
// Pixels of a tile that an outline passes so closely that rounding decides: OpenGL snaps vertices
// to a grid of 1/256 pixel, the CPU does not.
constexpr int kEdgePixels = 8;
// Likewise the depth of triangles seen nearly edge-on moves when their corners are snapped.
constexpr double kSteepShare = 0.005;  // of the covered pixels

using Tiles = std::vector<std::vector<float>>;

/// Renders the columns and copies every tile, without the padding.
std::map<Eigen::Index, Tiles> render(HypothesisRenderer& renderer, const Eigen::MatrixXd& states) {
  std::map<Eigen::Index, Tiles> all;
  std::mutex mutex;
  renderer.render(states, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
    Tiles tiles;
    for (const DepthTile& tile : hypothesis.views) {
      std::vector<float>& pixels = tiles.emplace_back();
      for (int y = 0; y < tile.height; ++y) {
        const float* row = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
        pixels.insert(pixels.end(), row, row + tile.width);
      }
    }
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(all.emplace(index, std::move(tiles)).second) << "visited twice: " << index;
  });
  return all;
}

struct Agreement {
  int covered = 0;           // in both
  int coverage_differs = 0;  // in one only
  int depth_differs = 0;     // covered in both, other depth
};

void compare(const std::vector<float>& a, const std::vector<float>& b, Agreement& agreement) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a[i] > 0) != (b[i] > 0)) {
      ++agreement.coverage_differs;
    } else if (a[i] > 0) {
      ++agreement.covered;
      if (std::abs(a[i] - b[i]) > kDepthTolerance * b[i]) ++agreement.depth_differs;
    }
  }
}

Scene scene_of_hand_and_box() {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  models.emplace_back("hand", std::make_shared<Model>(make_test_hand()));
  models.emplace_back("box", std::make_shared<Model>(make_test_box()));
  return Scene(std::move(models));
}

/// Two views of unequal size; the second looks from the side.
Observation observation_of(const Scene& scene, int size = 128) {
  Observation observation;
  observation.scene = &scene;
  observation.views.resize(2);
  TileCamera& first = observation.views[0].camera;
  first = {size,
           size,
           2.2 * size,
           2.3 * size,
           0.5 * size,
           0.5 * size + 3,
           Eigen::Isometry3d::Identity()};
  first.camera_from_world.translation() << 0.01, -0.02, 0.03;
  TileCamera& second = observation.views[1].camera;
  second = {size - 21,
            size - 8,
            1.9 * size,
            1.9 * size,
            0.4 * size,
            0.45 * size,
            Eigen::Isometry3d::Identity()};
  second.camera_from_world = Eigen::Translation3d(0, 0, 0.5) *
                             Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()) *
                             Eigen::Translation3d(0, 0, -0.5);
  return observation;
}

Eigen::MatrixXd random_states(const Scene& scene, int count) {
  std::mt19937_64 random(11);
  Eigen::MatrixXd states(scene.dimension(), count);
  for (int i = 0; i < count; ++i) states.col(i) = random_state(scene, random);
  return states;
}

void expect_agreement(const Scene& scene, const Observation& observation,
                      const Eigen::MatrixXd& states) {
  const auto egl = make_egl_renderer(scene, 2), cpu = make_cpu_renderer(scene, true, 1);
  egl->prepare(observation);
  cpu->prepare(observation);
  const auto drawn = render(*egl, states), expected = render(*cpu, states);
  ASSERT_EQ(drawn.size(), static_cast<std::size_t>(states.cols()));
  for (const auto& [index, tiles] : drawn) {
    ASSERT_EQ(tiles.size(), observation.views.size());
    for (std::size_t v = 0; v < tiles.size(); ++v) {
      Agreement agreement;
      compare(tiles[v], expected.at(index)[v], agreement);
      EXPECT_GT(agreement.covered, 300) << "hypothesis " << index << ", view " << v;
      EXPECT_LE(agreement.coverage_differs, kEdgePixels)
          << "hypothesis " << index << ", view " << v;
      EXPECT_LE(agreement.depth_differs, kEdgePixels + kSteepShare * agreement.covered)
          << "hypothesis " << index << ", view " << v;
    }
  }
}

TEST(EglHypotheses, HaveTheDepthThatTheCpuDraws) {
  const Scene scene = scene_of_hand_and_box();
  expect_agreement(scene, observation_of(scene), random_states(scene, 12));
}

TEST(EglHypotheses, ComeInAnyNumber) {
  const Scene scene = scene_of_hand_and_box();
  // More tiles than are read back at once.
  expect_agreement(scene, observation_of(scene, 256), random_states(scene, 35));
  expect_agreement(scene, observation_of(scene), random_states(scene, 0));
}

TEST(EglHypotheses, FollowTheFrame) {
  const Scene scene = scene_of_hand_and_box();
  const auto egl = make_egl_renderer(scene, 1);
  const Eigen::MatrixXd states = random_states(scene, 1);
  for (const int size : {64, 128, 96}) {
    const Observation observation = observation_of(scene, size);
    egl->prepare(observation);
    const auto tiles = render(*egl, states);
    EXPECT_EQ(tiles.at(0)[0].size(), static_cast<std::size_t>(size) * size);
  }
  Observation single = observation_of(scene, 64);
  single.views.resize(1);
  egl->prepare(single);
  EXPECT_EQ(render(*egl, states).at(0).size(), 1U);
}

/// A box that is posed by its own code, twice as far as a skeleton would put it.
class SelfPosed final : public Model {
 public:
  SelfPosed() : Model(make_test_box()) {}

 private:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    const Eigen::Isometry3d pose = world_from_model(parameters);
    vertices = pose.cast<float>() * data().mesh.vertices;
    vertices.row(2).array() *= 1.5F;
    landmarks = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(data().landmarks.size()));
  }
};

TEST(EglHypotheses, DrawModelsThatPoseThemselves) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  models.emplace_back("own", std::make_shared<SelfPosed>());
  const Scene scene(std::move(models));
  expect_agreement(scene, observation_of(scene), random_states(scene, 5));
}

TEST(EglHypotheses, DrawNothingOfAStateThatIsOutOfReach) {
  const Scene scene = scene_of_hand_and_box();
  const auto egl = make_egl_renderer(scene, 1);
  const Observation observation = observation_of(scene);
  egl->prepare(observation);
  Eigen::MatrixXd states = random_states(scene, 3);
  states(0, 0) = states(27, 0) = 1e9;
  states(2, 1) = states(29, 1) = -0.5;  // behind the cameras
  const auto tiles = render(*egl, states);
  for (const Eigen::Index i : {0, 1}) {
    EXPECT_THAT(tiles.at(i)[0], testing::Each(0.0F)) << i;
  }
  EXPECT_THAT(tiles.at(2)[0], testing::Contains(testing::Gt(1.0F)));
}

TEST(EglHypotheses, CanBeDrawnFromAnyThreadAndPassExceptionsOn) {
  const Scene scene = scene_of_hand_and_box();
  const auto egl = make_egl_renderer(scene, 2);
  const Observation observation = observation_of(scene);
  egl->prepare(observation);
  const Eigen::MatrixXd states = random_states(scene, 4);
  const auto here = render(*egl, states);
  std::map<Eigen::Index, Tiles> there;
  std::thread([&] { there = render(*egl, states); }).join();
  EXPECT_EQ(here, there);
  EXPECT_THROW(egl->render(states, [](auto, const auto&) { throw DataError("from the visit"); }),
               DataError);
  EXPECT_EQ(render(*egl, states), here) << "usable after an exception";
}

TEST(EglHypotheses, NameTheTilesThatOpenglCannotDrawTo) {
  const Scene scene = scene_of_hand_and_box();
  const auto egl = make_egl_renderer(scene, 1);
  const Observation small = observation_of(scene, 64), large = observation_of(scene, 1 << 17);
  EXPECT_THAT([&] { egl->prepare(large); },
              testing::ThrowsMessage<DeviceError>(testing::AllOf(
                  testing::HasSubstr("131072x131072"), testing::HasSubstr("smaller tile.size"))));
  egl->prepare(small);
  EXPECT_EQ(render(*egl, random_states(scene, 1)).size(), 1U) << "usable after an exception";
}

TEST(EglHypotheses, LeaveNothingOfTheBatchBefore) {
  const Scene scene = scene_of_hand_and_box();
  const Observation observation = observation_of(scene);
  const auto used = make_egl_renderer(scene, 1), fresh = make_egl_renderer(scene, 1);
  used->prepare(observation);
  fresh->prepare(observation);
  const Eigen::MatrixXd states = random_states(scene, 12);
  render(*used, states);
  EXPECT_EQ(render(*used, states.rightCols(3)), render(*fresh, states.rightCols(3)));
}

/// Share of the first view that is covered; without a counterpart on the GPU.
class Coverage final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    const DepthTile& tile = hypothesis.views[0];
    int covered = 0;
    for (int i = 0; i < tile.height * tile.stride; ++i) covered += tile.inverse_depth[i] > 0;
    return static_cast<double>(covered) / (tile.width * tile.height);
  }
};

TEST(EglHypotheses, AreScoredOnTheCpuIfNeedBeAndTheBackendSaysWhy) {
  const Scene scene = scene_of_hand_and_box();
  EvaluateSettings settings;
  settings.backend = Backend::egl;
  const auto cost = make_cost(scene, {{1, std::make_shared<Coverage>(), "coverage"}}, settings);
  EXPECT_THAT(cost->backend(),
              testing::MatchesRegex(R"(egl \(.*OpenGL.*\); scored on the CPU: .+)"));
  const Observation observation = observation_of(scene);
  cost->prepare(observation);
  Eigen::VectorXd costs(1);
  cost->evaluate(random_states(scene, 1), costs);
  EXPECT_GT(costs[0], 0.01);
  EXPECT_LT(costs[0], 0.9);
}

}  // namespace
}  // namespace hypotrack::test
