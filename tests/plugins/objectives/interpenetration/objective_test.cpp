#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "expect_error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "interpenetration.hpp"
#include "make_model.hpp"
#include "session/opened_scene.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack::interpenetration {
namespace {

Scene two_hands() {
  return Scene{
      {{"right", make_model("type: hand\n")}, {"left", make_model("type: mirrored_hand\n")}}};
}
Scene hand_and_box() {
  return Scene{{{"hand", make_model("type: hand\n")},
                {"box", make_model("{type: rigid_box, size_mm: [100, 34, 30]}\n")}}};
}

double cost_of(const Interpenetration& objective, const Eigen::VectorXd& state) {
  return objective.cost({{state.data(), static_cast<std::size_t>(state.size())}, {}});
}

/// Both hands stand upright, their wrists `apart` metres from each other along x.
Eigen::VectorXd beside(const Scene& scene, double apart) {
  Eigen::VectorXd state = scene.rest_state();
  state[scene.items()[1].offset] = apart;
  return state;
}

/// The index of a parameter, `hand.index_flexion_1`.
Eigen::Index index_of(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.parameters().size(); ++i) {
    if (scene.parameters()[i].name == name) return static_cast<Eigen::Index>(i);
  }
  throw std::out_of_range(name);
}

TEST(Interpenetration, OfTheRestPoseIsNothingWithoutAnyTolerance) {
  for (const char* type : {"type: hand\n", "type: mirrored_hand\n"}) {
    const Scene scene{{{"hand", make_model(type)}}};
    const Interpenetration objective({.tolerance = 0}, scene);
    EXPECT_EQ(cost_of(objective, scene.rest_state()), 0);
  }
}

TEST(Interpenetration, OfModelsApartIsNothing) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  EXPECT_EQ(cost_of(objective, beside(scene, 0.3)), 0);
  EXPECT_EQ(cost_of(objective, beside(scene, -0.3)), 0);
}

TEST(Interpenetration, GrowsAsHandsGoIntoEachOther) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  double touching = 0.3;
  while (cost_of(objective, beside(scene, touching)) == 0) touching -= 0.001;
  double before = 0;
  for (double deeper = 0; deeper < 0.012; deeper += 0.001) {
    const double cost = cost_of(objective, beside(scene, touching - deeper));
    EXPECT_GT(cost, before) << deeper;
    before = cost;
  }
  EXPECT_GT(before, 100);  // mm^2
}

TEST(Interpenetration, GrowsAsABoxGoesIntoAPalm) {
  const Scene scene = hand_and_box();
  const Interpenetration objective({}, scene);
  const auto before_palm = [&](double z) {
    Eigen::VectorXd state = scene.rest_state();
    state.segment<3>(scene.items()[1].offset) << 0, 0.06, z;
    return cost_of(objective, state);
  };
  double touching = 0.2;
  while (before_palm(touching) == 0) touching -= 0.001;
  double before = 0;
  for (double deeper = 0; deeper < 0.012; deeper += 0.001) {
    const double cost = before_palm(touching - deeper);
    EXPECT_GT(cost, before) << deeper;
    before = cost;
  }
  EXPECT_GT(before, 50);
}

TEST(Interpenetration, PushesApart) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  constexpr double kStep = 1e-4;
  const double slope = (cost_of(objective, beside(scene, 0.10 + kStep)) -
                        cost_of(objective, beside(scene, 0.10 - kStep))) /
                       (2 * kStep);
  EXPECT_LT(slope, -1000);  // mm^2 per metre
}

TEST(Interpenetration, SeesFingersThatPassThroughEachOther) {
  const Scene scene{{{"hand", make_model("type: hand\n")}}};
  const Interpenetration objective({}, scene);
  Eigen::VectorXd state = scene.rest_state();
  state[index_of(scene, "hand.index_abduction")] -= 0.35;
  state[index_of(scene, "hand.middle_abduction")] += 0.35;
  Eigen::VectorXd other = scene.rest_state();
  other[index_of(scene, "hand.index_abduction")] += 0.35;
  other[index_of(scene, "hand.middle_abduction")] -= 0.35;
  EXPECT_GT(std::max(cost_of(objective, state), cost_of(objective, other)), 10);
  const Interpenetration without({.within_models = false}, scene);
  EXPECT_EQ(cost_of(without, state) + cost_of(without, other), 0);
}

TEST(Interpenetration, IsTheSameForTheMirrorImage) {
  const Scene right{{{"hand", make_model("type: hand\n")},
                     {"box", make_model("{type: rigid_box, size_mm: [100, 34, 30]}\n")}}};
  const Scene left{{{"hand", make_model("type: mirrored_hand\n")},
                    {"box", make_model("{type: rigid_box, size_mm: [100, 34, 30]}\n")}}};
  const Interpenetration a({}, right), b({}, left);
  std::mt19937_64 random(5);
  int colliding = 0;
  for (int round = 0; round < 50; ++round) {
    Eigen::VectorXd state = test::random_state(right, random, {0, 0, 0}, 0.06);
    state.segment<7>(0) << 0, 0, 0, 1, 0, 0, 0;
    Eigen::VectorXd mirrored = state;
    const int box = right.items()[1].offset;
    mirrored[box] = -state[box];
    mirrored[box + 5] = -state[box + 5];  // the mirror image of a rotation turns about the mirrored
    mirrored[box + 6] = -state[box + 6];  // axis the other way round
    const double cost = cost_of(a, state);
    EXPECT_NEAR(std::sqrt(cost_of(b, mirrored)), std::sqrt(cost), 1) << "millimetres";
    colliding += cost > 0;
  }
  EXPECT_GT(colliding, 10);
}

TEST(Interpenetration, DoesNotDependOnWhereTheSceneIs) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  const Eigen::VectorXd state = beside(scene, 0.09);
  Eigen::VectorXd moved = state;
  for (const Scene::Item& item : scene.items())
    moved.segment<3>(item.offset) += Eigen::Vector3d(0.1, -0.2, 0.6);
  const double cost = cost_of(objective, state);
  EXPECT_GT(cost, 1);
  EXPECT_NEAR(cost_of(objective, moved), cost, 1e-3 * cost);
}

TEST(Interpenetration, OfStatesThatAreNoNumbersIsANumber) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  for (const double bad : {std::nan(""), HUGE_VAL, 1e300}) {
    for (const Eigen::Index i : {0, 2, 10, 30}) {
      Eigen::VectorXd state = beside(scene, 0.09);
      state[i] = bad;
      EXPECT_TRUE(std::isfinite(cost_of(objective, state))) << bad << " at " << i;
    }
  }
}

TEST(Interpenetration, IsTheSumOfItsSquaredResiduals) {
  const Scene scene = two_hands();
  const Interpenetration objective({}, scene);
  const ResidualTerm* term = objective.residual_term();
  ASSERT_NE(term, nullptr);
  std::vector<float> residuals(static_cast<std::size_t>(term->residual_count()));
  std::mt19937_64 random(9);
  int colliding = 0;
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd state = test::random_state(scene, random, {0, 0, 0.5}, 0.03);
    term->write_residuals({{state.data(), static_cast<std::size_t>(state.size())}, {}}, residuals);
    double sum = 0;
    for (const float r : residuals) sum += double{r} * r;
    const double cost = cost_of(objective, state);
    EXPECT_NEAR(sum, cost, 1e-6 * cost);
    colliding += cost > 0;
  }
  EXPECT_GT(colliding, 10);
}

TEST(Interpenetration, RefusesModelsThatPoseThemselves) {
  class PosesItself final : public Model {
   public:
    PosesItself() : Model(test::make_test_box()) {}

   private:
    bool do_poses_itself() const override { return true; }
  };
  const Scene scene{{{"cloth", std::make_shared<PosesItself>()}}};
  const std::string message =
      test::message_of<ConfigError>([&] { Interpenetration({}, scene, "scene.yaml:7:3"); });
  EXPECT_THAT(message, testing::AllOf(testing::HasSubstr("scene.yaml:7:3"),
                                      testing::HasSubstr("'cloth' poses itself")));
}

/// The highest cost over the true states of a scene of configs.
double highest_cost_of_truth(const std::string& name) {
  PluginLoader plugins;
  const std::vector<std::string> small = {"source.cameras.width=32", "source.cameras.height=18",
                                          "source.cameras.focal_px=18"};
  const OpenedScene session =
      open_source(test::source_dir() / "configs/scenes" / name, small, plugins);
  const Interpenetration objective({}, *session.scene);
  double highest = 0;
  while (const auto frame = session.source->next()) {
    highest = std::max(highest, cost_of(objective, frame->truth->state));
  }
  return highest;
}

TEST(Interpenetration, OfTwoHandsThatPassBeforeEachOtherIsNothing) {
  EXPECT_EQ(highest_cost_of_truth("two_hands.yaml"), 0);
}

TEST(Interpenetration, OfAHandThatHoldsABoxIsNextToNothing) {
  EXPECT_LT(highest_cost_of_truth("hand_and_box.yaml"), 0.1);
}

TEST(Interpenetration, OfAHandThatPinchesIsNextToNothing) {
  EXPECT_LT(highest_cost_of_truth("demo.yaml"), 0.1);
}

}  // namespace
}  // namespace hypotrack::interpenetration
