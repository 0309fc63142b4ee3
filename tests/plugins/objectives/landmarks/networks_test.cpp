// With the networks of the hand detector: what they see in rendered tiles.
#include "expect_error.hpp"
#include "hands_in_view.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "pictures.hpp"
#include "test_paths.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::landmarks {
namespace {

using ::testing::HasSubstr;

/// The rendered hand of configs/scenes/demo.yaml in tiles.
class RenderedLandmarks : public ::testing::Test {
 protected:
  void look(int frame, const std::string& model = "hand", int tile = 128) {
    PluginLoader plugins;
    scene_ =
        std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
            {"hand",
             plugins.make<Model>(ConfigNode::parse("type: " + model + "\n", "scene.yaml"))}});
    const auto pictures = hypotrack::test::rendered_hand(frame);
    truth_ = pictures.frame.truth->state;
    const TileMaker tiles(*scene_, pictures.cameras, {.size = tile});
    observation_ = tiles.make(pictures.frame, truth_);
    objective_ = std::make_unique<Landmarks>(params_, *scene_, networks(params_, *scene_));
    objective_->prepare(observation_);
  }
  double cost(const Eigen::VectorXd& state) const {
    return objective_->cost(test::hypothesis(state));
  }
  Eigen::VectorXd bent(const std::string& joint) const {
    Eigen::VectorXd state = truth_;
    for (std::size_t i = 0; i < scene_->parameters().size(); ++i) {
      if (scene_->parameters()[i].name == joint) state[static_cast<Eigen::Index>(i)] += 1;
    }
    return state;
  }

  LandmarksParams params_;
  std::unique_ptr<Scene> scene_;
  Eigen::VectorXd truth_;
  Observation observation_;
  std::unique_ptr<Landmarks> objective_;
};

TEST_F(RenderedLandmarks, CostLessInTruthThanWithABentFinger) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  for (const int tile : {64, 128, 256}) {
    look(0, "hand", tile);
    EXPECT_LT(cost(truth_), 0.1 * 21) << tile;
    for (const char* finger : {"index", "middle", "ring", "little"}) {
      const std::string joint = std::string("hand.") + finger + "_flexion_1";
      EXPECT_GT(cost(bent(joint)), cost(truth_) + 0.5) << joint << ", tiles of " << tile;
    }
  }
}

TEST_F(RenderedLandmarks, OfAFistCostMoreWithOpenedFingers) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  look(50);
  Eigen::VectorXd open = truth_;
  open.tail(open.size() - kPoseSize).setZero();
  EXPECT_GT(cost(open), cost(truth_) + 3);
}

TEST_F(RenderedLandmarks, OfARightHandAreNotThoseOfALeftModel) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  look(0, "mirrored_hand");
  EXPECT_EQ(cost(truth_), 0);
}

TEST_F(RenderedLandmarks, CostTheSameInEqualCalls) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  look(0);
  const double before = cost(bent("hand.index_flexion_1"));
  objective_->prepare(observation_);
  EXPECT_EQ(cost(bent("hand.index_flexion_1")), before);
  look(0);
  EXPECT_EQ(cost(bent("hand.index_flexion_1")), before);
}

TEST_F(RenderedLandmarks, OfTilesThatShowNoHandCostNothing) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  look(0);
  observation_.frame = 1;
  for (TileView& view : observation_.views) view.color.setTo(cv::Scalar(90, 100, 110));
  objective_->prepare(observation_);
  EXPECT_EQ(cost(bent("hand.index_flexion_1")), 0);
}

TEST(LandmarksNetworks, ThatAreMissingAreNamedWithTheRemedy) {
  const hypotrack::test::TemporaryDirectory folder;
  LandmarksParams params;
  params.folder = folder.path();
  EXPECT_THAT(hypotrack::test::message_of<DataError>([&] { networks(params, test::two_hands()); }),
              HasSubstr("run `hypotrack get detector`"));
}

}  // namespace
}  // namespace hypotrack::landmarks
