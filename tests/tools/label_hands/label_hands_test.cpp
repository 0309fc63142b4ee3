// Labels of hands, and the program that writes them.
#include <cmath>
#include <fstream>
#include <string>

#include "base/subprocess.hpp"
#include "expect_error.hpp"
#include "hand_labeler.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "pictures.hpp"
#include "test_paths.hpp"

namespace hypotrack::hands {
namespace {

constexpr const char* kRight = "type: hand";
constexpr const char* kLeft = "{type: mirrored_hand, of: {type: hand}}";

/// A scene of models, named by their numbers.
Scene scene_of(const std::vector<std::string>& models) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> out;
  for (const std::string& model : models)
    out.emplace_back("model" + std::to_string(out.size()),
                     PluginLoader().make<Model>(ConfigNode::parse(model, "test"), nullptr));
  return Scene(std::move(out));
}

double error(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& truth) {
  double sum = 0;
  int known = 0;
  for (Eigen::Index i = 0; i < truth.cols(); ++i)
    if (truth.col(i).allFinite()) sum += (found.col(i) - truth.col(i)).norm(), ++known;
  return sum / known;
}

TEST(LabelHands, GivesARenderedRightHandToTheModelOfItsSide) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const Scene scene = scene_of({kLeft, "type: rigid_box", kRight});
  const test::HandPictures pictures = test::rendered_hand();
  HandLabeler labeler(scene, pictures.cameras);
  const LandmarkRow row = labeler.label(pictures.frame);
  ASSERT_EQ(row.landmarks.cols(), std::ssize(scene.landmark_names()));
  EXPECT_LT(error(row.landmarks.rightCols(21), pictures.frame.truth->landmarks), 0.015);
  EXPECT_TRUE(row.landmarks.leftCols(row.landmarks.cols() - 21).array().isNaN().all());
  EXPECT_EQ(labeler.labelled(), (std::vector<int>{0, 0, 1}));
}

TEST(LabelHands, LeavesOutWhatBothViewsDoNotShow) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const Scene scene = scene_of({kRight});
  test::HandPictures pictures = test::rendered_hand();
  HandLabeler labeler(scene, pictures.cameras);
  pictures.frame.views[1].color = cv::Scalar(90, 100, 110);
  EXPECT_TRUE(labeler.label(pictures.frame).landmarks.array().isNaN().all());
  pictures.frame.views.clear();
  EXPECT_TRUE(labeler.label(pictures.frame).landmarks.array().isNaN().all());
  EXPECT_EQ(labeler.labelled(), std::vector<int>{0});
}

TEST(LabelHands, RefuseScenesThatTheyCannotLabel) {
  const std::vector<Camera> two(2);
  const auto refusal = [&](const std::vector<std::string>& models, const auto& cameras) {
    return test::message_of<ConfigError>([&] { HandLabeler(scene_of(models), cameras); });
  };
  EXPECT_THAT(refusal({"type: rigid_box"}, two),
              testing::HasSubstr("no model of the scene is a hand"));
  EXPECT_THAT(refusal({kRight, kRight}, two),
              testing::HasSubstr("'model0' and 'model1' are both right hands"));
  EXPECT_THAT(refusal({kRight}, std::vector<Camera>(1)), testing::HasSubstr("has one view"));
}

TEST(LabelHands, TheProgramWritesATableThatIsNearTheLabelsOfARealHand) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  const test::TemporaryDirectory folder;
  const auto stb = test::shared_data() / "stereo/stb";
  const Subprocess::Command command{
      .program = LABEL_HANDS,
      .arguments = {(test::source_dir() / "configs/scenes/stb_pair.yaml").string(), "--out",
                    (folder.path() / "labels.csv").string(), "--set",
                    "source.left=" + (stb / "BB_left_%d.png").string(), "--set",
                    "source.right=" + (stb / "BB_right_%d.png").string(), "--set",
                    "source.truth_landmarks=" + (stb / "B1Counting_BB_rows000-499.csv").string()},
      .output = folder.path() / "said"};
  ASSERT_EQ(Subprocess(command).wait().code, 0);
  std::string said;
  std::ifstream output(folder.path() / "said");
  std::getline(output, said);
  EXPECT_EQ(said, "hand: labelled in 1 of 1 frames");
  const test::HandPictures pictures = test::stb_pair();
  std::vector<std::string> names;
  for (const auto name : kHandPointNames) names.push_back("hand." + std::string(name));
  const std::vector<LandmarkRow> rows = read_landmarks(folder.path() / "labels.csv", names);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LT(error(rows[0].landmarks, pictures.frame.truth->landmarks), 0.015);
}

}  // namespace
}  // namespace hypotrack::hands
