// The plugin on pictures, rendered and real.
#include <cmath>

#include "hypotrack/plugin/plugin.hpp"
#include "pictures.hpp"
#include "plugin/plugin_notes.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// A scene of one model, and the starter.
struct Search {
  explicit Search(const std::string& model)
      : scene({{"hand", PluginLoader().make<Model>(ConfigNode::parse(model, "test"), nullptr)}}) {}

  /// Returns the landmarks of the first pose that is proposed; none if there is none.
  Eigen::Matrix3Xd first(const test::HandPictures& pictures) {
    Eigen::Matrix3Xd out(3, 0);
    starter->find({scene, pictures.cameras, &pictures.frame}, 0, [&](const Eigen::VectorXd& pose) {
      scene.check(pose, "the pose");
      out = scene.landmarks(pose);
      return false;
    });
    return out;
  }

  Scene scene;
  std::shared_ptr<PluginNotes> notes = std::make_shared<PluginNotes>();
  std::unique_ptr<Starter> starter = PluginLoader().make<Starter>(
      ConfigNode::parse("type: hand_landmarks", "test"), &scene, {}, nullptr, notes);
};

double mean_error(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& truth) {
  double sum = 0;
  int known = 0;
  for (Eigen::Index i = 0; i < truth.cols(); ++i)
    if (truth.col(i).allFinite()) sum += (found.col(i) - truth.col(i)).norm(), ++known;
  return sum / known;
}

TEST(HandLandmarks, ProposeAPoseNearARenderedHand) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  Search search("type: hand");
  const test::HandPictures pictures = test::rendered_hand();
  const Eigen::Matrix3Xd found = search.first(pictures);
  ASSERT_GT(found.cols(), 0);
  EXPECT_LT(mean_error(found, pictures.frame.truth->landmarks), 0.025);
}

TEST(HandLandmarks, AModelOfTheOtherSideIsSaidOnce) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  test::HandPictures pictures = test::rendered_hand();
  for (const std::string model : {"hand", "mirrored_hand"}) {
    const Search search("type: " + model);
    for (int frame = 0; frame < 6; ++frame) {
      pictures.frame.index = frame;
      search.starter->find({search.scene, pictures.cameras, &pictures.frame}, 0,
                           [](const Eigen::VectorXd&) { return true; });
    }
    const std::vector<PluginNote> said = search.notes->all();
    ASSERT_EQ(said.size(), model == "mirrored_hand" ? 1 : 0) << model;
    for (const PluginNote& note : said)
      EXPECT_NE(note.text.find("right hands only, but 'hand' is a left one"), std::string::npos)
          << note.text;
  }
}

TEST(HandLandmarks, TellHowLargeARenderedHandIs) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const test::HandPictures pictures = test::rendered_hand();
  for (const double scale : {0.8, 1.0, 1.2}) {
    Search search("{type: hand, scale: " + std::to_string(1 / scale) + "}");
    const auto size = search.starter->size({search.scene, pictures.cameras, &pictures.frame}, 0);
    ASSERT_TRUE(size);
    EXPECT_NEAR(*size / scale, 1, 0.06);
  }
}

TEST(HandLandmarks, TellNoSizeOfWhatTheyDoNotSee) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  test::HandPictures pictures = test::rendered_hand();
  const auto size_of = [&](const std::string& model) {
    Search search(model);
    return search.starter->size({search.scene, pictures.cameras, &pictures.frame}, 0);
  };
  EXPECT_FALSE(size_of("{type: mirrored_hand, of: {type: hand}}")) << "it is a right hand";
  for (View& view : pictures.frame.views) view.color = cv::Scalar(90, 100, 110);
  EXPECT_FALSE(size_of("type: hand"));
}

TEST(HandLandmarks, ProposeNoPoseOfAnObjectNorInAnEmptyPicture) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  test::HandPictures pictures = test::rendered_hand();
  EXPECT_EQ(Search("{type: rigid_box, size_mm: [60, 80, 100]}").first(pictures).cols(), 0);
  for (View& view : pictures.frame.views) view.color = cv::Scalar(90, 100, 110);
  EXPECT_EQ(Search("type: hand").first(pictures).cols(), 0);
}

TEST(HandLandmarks, ProposeAPoseNearTheLabelsOfARealHand) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  Search search("{type: mirrored_hand, of: {type: hand}}");
  const test::HandPictures pictures = test::stb_pair();
  const Eigen::Matrix3Xd found = search.first(pictures);
  ASSERT_GT(found.cols(), 0);
  EXPECT_LT(mean_error(found, pictures.frame.truth->landmarks), 0.020);
}

}  // namespace
}  // namespace hypotrack
