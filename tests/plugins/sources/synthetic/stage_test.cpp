// What the pictures show instead of the tracked models, and below a hand.

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "synthetic_fixture.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kFlat =
    std::string(kCameras) + kQuiet + kPlain + "light: {ambient: 1, diffuse: 0, specular: 0}\n";

/// The hand upright, its palm to the camera, the wrist in the middle of the picture.
const std::string kUpright = R"(
keyframes:
  - time: 0
    pose: {hand: {position_mm: [0, 0, 400], rotation_deg: [180, 0, 0]}, box: {position_mm: [900, 0, 900]}}
)";

Frame first_frame(const std::string& yaml) { return load(yaml).frames().at(0); }

/// Where the left camera sees a point of the hand's frame.
cv::Point pixel_of(const Loaded& loaded, const Frame& frame, const Eigen::Vector3d& point) {
  const Scene::Item& hand = loaded.scene.items()[0];
  const Eigen::Vector3d world =
      world_from_model(loaded.scene.part(hand, frame.truth->state)) * point;
  const Eigen::Vector2d p = project(loaded.source->cameras()[0], world);
  return {cvRound(p.x()), cvRound(p.y())};
}

TEST(Forearm, GoesOnBelowTheWristAndIsBackground) {
  Loaded without(kFlat + kUpright);
  Loaded with(kFlat + kUpright + "forearm: {kind: sleeve}\n");
  const Frame bare = without.frames().at(0), sleeved = with.frames().at(0);
  for (const double below : {0.05, 0.10, 0.18}) {
    const cv::Point pixel = pixel_of(with, sleeved, {0, -below, 0});
    EXPECT_EQ(bare.views[0].color.at<cv::Vec3b>(pixel), cv::Vec3b(30, 20, 10));
    EXPECT_NEAR(sleeved.views[0].color.at<cv::Vec3b>(pixel)[0], 24, 8) << below;
    EXPECT_NEAR(sleeved.views[0].color.at<cv::Vec3b>(pixel)[2], 20, 8) << below;
    EXPECT_EQ(sleeved.views[0].mask.at<unsigned char>(pixel), 0) << below;
  }
  const cv::Point palm = pixel_of(with, sleeved, {0, 0.06, 0});
  EXPECT_EQ(sleeved.views[0].mask.at<unsigned char>(palm), 255);
  EXPECT_EQ(sleeved.truth->state, bare.truth->state);
  EXPECT_EQ(sleeved.truth->landmarks.size(), 0) << "what is tracked is what is drawn";
}

TEST(Forearm, HasTheColourOfTheSkinOrTheOneItIsGiven) {
  Loaded bare(kFlat + kUpright + "forearm: {kind: bare}\n");
  const Frame skin = bare.frames().at(0);
  const cv::Point pixel = pixel_of(bare, skin, {0, -0.10, 0});
  const cv::Vec3b color = skin.views[0].color.at<cv::Vec3b>(pixel);
  EXPECT_NEAR(color[2], 0.70 * 255, 20);
  EXPECT_NEAR(color[0], 0.47 * 255, 20);
  const Frame red =
      first_frame(kFlat + kUpright + "forearm: {kind: sleeve, color: [200, 40, 40]}\n");
  EXPECT_NEAR(red.views[0].color.at<cv::Vec3b>(pixel)[2], 200, 8);
  EXPECT_NEAR(red.views[0].color.at<cv::Vec3b>(pixel)[0], 40, 8);
}

TEST(Forearm, HidesWhatIsBehindIt) {
  std::string away = kUpright;  // fingers from the camera, the arm towards it
  away.replace(away.find("[180, 0, 0]"), 11, "[90, 0, 0]");
  const Frame without = first_frame(kFlat + away);
  const Frame with = first_frame(kFlat + away + "forearm: {kind: bare, length_mm: 150}\n");
  EXPECT_LT(cv::countNonZero(with.views[0].mask), cv::countNonZero(without.views[0].mask) / 2);
}

TEST(Forearm, IsASurfaceToADepthCamera) {
  Loaded loaded(kFlat + kUpright + "forearm: {kind: bare}\ndepth: true\n");
  const Frame frame = loaded.frames().at(0);
  const cv::Point pixel = pixel_of(loaded, frame, {0, -0.10, 0});
  EXPECT_GT(frame.views[0].depth.at<float>(pixel), 0.33F);
  EXPECT_LT(frame.views[0].depth.at<float>(pixel), 0.40F);
}

const std::string kCard =
    "cards: [{frames: [1, 3], at_mm: [0, -60, 300], by_mm: [0, 40, 0], size_mm: [100, 40], "
    "color: [10, 200, 30]}]\nframes: 5\ndepth: true\n";

TEST(Card, HidesWhatIsBehindItInItsFramesOnly) {
  const std::vector<Frame> without = load(kFlat + kUpright + "frames: 5\n").frames();
  Loaded loaded(kFlat + kUpright + kCard);
  const std::vector<Frame> with = loaded.frames();
  const Camera& camera = loaded.source->cameras()[0];
  for (const std::size_t i : {0u, 4u})
    EXPECT_TRUE(same(with[i].views[0].color, without[i].views[0].color)) << i;
  for (const std::size_t i : {1u, 3u}) {
    const Eigen::Vector2d p = project(camera, Eigen::Vector3d(0, i == 1 ? -0.06 : -0.02, 0.3));
    const cv::Point at(cvRound(p.x()), cvRound(p.y()));
    const View& view = with[i].views[0];
    EXPECT_EQ(view.color.at<cv::Vec3b>(at), cv::Vec3b(30, 200, 10)) << i;
    EXPECT_EQ(view.mask.at<unsigned char>(at), 0) << i;
    EXPECT_NEAR(view.depth.at<float>(at), 0.3F, 0.002F) << i;
    EXPECT_LT(cv::countNonZero(view.mask), cv::countNonZero(without[i].views[0].mask)) << i;
    EXPECT_EQ(with[i].truth->state, without[i].truth->state) << i;
  }
}

TEST(Card, SaysWhatIsWrongWithIt) {
  const std::string motion = kPlain + kUpright;
  EXPECT_THAT(message_of(motion + "cards: [{frames: [3, 1], at_mm: [0, 0, 300]}]\n"),
              HasSubstr("frames are 3 to 1; expected the numbers of the first and the last frame"));
  EXPECT_THAT(message_of(motion + "cards: [{frames: [0, 1]}]\n"), HasSubstr("at_mm"));
  EXPECT_THAT(
      message_of(motion + "cards: [{frames: [0, 1], at_mm: [0, 0, 300], pattern: 1, file: x}]\n"),
      HasSubstr("a card has a `pattern` or a `file`, not both"));
  EXPECT_THAT(message_of(motion + "cards: [{frames: [0, 1], at_mm: [0, 0, 300], file: x.png}]\n"),
              HasSubstr("is no readable image; a card needs a PNG or JPEG file"));
}

TEST(RenderModels, ShowAnotherModelAndMakeItTheTruth) {
  const std::string larger = "render_models: {box: {type: rigid_box, size_mm: [120, 80, 240]}}\n";
  Loaded own(kFlat + kMotion), other(kFlat + kMotion + larger);
  const Frame as_tracked = own.frames().at(5), drawn = other.frames().at(5);
  EXPECT_EQ(drawn.truth->state, as_tracked.truth->state);
  EXPECT_GT(cv::countNonZero(drawn.views[0].mask), cv::countNonZero(as_tracked.views[0].mask));
  const std::vector<std::string>& names = own.scene.landmark_names();
  const Eigen::Matrix3Xd tracked = own.scene.landmarks(as_tracked.truth->state);
  ASSERT_EQ(drawn.truth->landmarks.cols(), tracked.cols());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double off = (drawn.truth->landmarks.col(column) - tracked.col(column)).norm();
    const double expected = names[i] == "box.end_z" ? 0.06 : names[i] == "box.end_x" ? 0.03 : 0;
    EXPECT_NEAR(off, expected, 1e-6) << names[i];
  }
}

TEST(RenderModels, MoveAsTheTrackedOneDoesParameterByParameter) {
  const std::string longer = "render_models: {hand: {type: hand, finger_scale: [1.3]}}\n";
  Loaded loaded(kFlat + kMotion + longer);
  const Frame frame = loaded.frames().at(5);  // a fist
  const auto model = loaded.plugins.make<Model>(
      ConfigNode::parse("{type: hand, finger_scale: [1.3]}", "test"), nullptr);
  std::vector<double> parameters;
  for (const Parameter& p : model->data().parameters) {
    parameters.push_back(frame.truth->state[parameter(loaded.scene, "hand." + p.name)]);
  }
  const Eigen::Matrix3Xd expected = posed_landmarks(*model, parameters);
  for (std::size_t i = 0; i < model->data().landmarks.size(); ++i) {
    for (std::size_t k = 0; k < loaded.scene.landmark_names().size(); ++k) {
      if (loaded.scene.landmark_names()[k] != "hand." + model->data().landmarks[i].name) continue;
      EXPECT_TRUE(frame.truth->landmarks.col(static_cast<Eigen::Index>(k))
                      .isApprox(expected.col(static_cast<Eigen::Index>(i)), 1e-9));
    }
  }
}

TEST(RenderModels, LeaveLandmarksThatTheyDoNotHaveUnknown) {
  // The anchors are on the two longest axes: y and x, where the tracked box has z and x.
  const Frame frame = first_frame(
      kFlat + kMotion + "render_models: {box: {type: rigid_box, size_mm: [200, 240, 60]}}\n");
  const Scene scene = hand_and_box();
  for (std::size_t i = 0; i < scene.landmark_names().size(); ++i) {
    const bool unknown = std::isnan(frame.truth->landmarks(0, static_cast<Eigen::Index>(i)));
    EXPECT_EQ(unknown, scene.landmark_names()[i] == "box.end_z") << scene.landmark_names()[i];
  }
}

TEST(RenderModels, JoinWhatTheSourceResolvedTo) {
  Loaded loaded(kFlat + kMotion);
  std::string resolved;
  loaded.plugins.make<Source>(
      ConfigNode::parse("type: synthetic\n" + kFlat + kMotion +
                            "render_models: {box: {type: rigid_box, size_mm: [120, 80, 240]}}\n",
                        "a.yaml"),
      &loaded.scene, {}, &resolved);
  EXPECT_THAT(resolved, AllOf(HasSubstr("size_mm: [120, 80, 240]"), HasSubstr("pattern:")));
}

TEST(RenderModels, AreRefusedWhereTheyCannotMoveAlike) {
  const std::string motion = kMotion;
  EXPECT_THAT(
      message_of(motion + "render_models: {foot: {type: rigid_box}}\n"),
      AllOf(HasSubstr("scene.yaml"), HasSubstr("'foot' is no model"), HasSubstr("hand, box")));
  EXPECT_THAT(message_of(motion + "render_models: {box: {type: hand}}\n"),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("'thumb_abduction'"),
                    HasSubstr("the tracked 'box' has not")));
  EXPECT_THAT(message_of(motion + "render_models: {hand: {type: rigid_box}}\n"),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("the tracked 'hand' has"),
                    HasSubstr("'thumb_abduction' and this model has not")));
  EXPECT_THAT(message_of(motion + "render_models: box\n"), HasSubstr("expected a map"));
  EXPECT_THAT(message_of(motion + "forearm: {kind: bare, color: [1, 2]}\n"),
              HasSubstr("forearm.color has 2 numbers, expected three"));
}

TEST(Forearm, NeedsAHand) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  models.emplace_back("box", std::make_shared<Model>(make_test_box()));
  const Scene scene(std::move(models));
  PluginLoader plugins;
  const std::string yaml =
      "type: synthetic\nforearm: {kind: sleeve}\nkeyframes: [{time: 0, pose: "
      "{box: {position_mm: [0, 0, 400]}}}]\n";
  try {
    plugins.make<Source>(ConfigNode::parse(yaml, "scene.yaml"), &scene);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a forearm needs a hand"));
  }
}

TEST(Background, HasDarkFlatRegionsWhereWanted) {
  const auto dark_share = [](const std::string& background) {
    const Frame frame = first_frame(std::string(kCameras) + kQuiet + kMotion + "frames: 1\n" +
                                    "background: " + background + "\n");
    cv::Mat bright;
    cv::inRange(frame.views[0].color, cv::Scalar(0, 0, 0), cv::Scalar(24, 24, 24), bright);
    return static_cast<double>(cv::countNonZero(bright)) / static_cast<double>(bright.total());
  };
  EXPECT_LT(dark_share("{kind: procedural, clutter: 0}"), 0.01);
  const double with = dark_share("{kind: procedural, clutter: 0, dark_regions: 3}");
  EXPECT_GT(with, 0.05);
  EXPECT_LT(with, 0.8);
}

/// Pixels of a picture that are near a colour (blue, green, red).
int count_near(const cv::Mat& picture, const cv::Scalar& color) {
  cv::Mat near;
  cv::inRange(picture, color - cv::Scalar::all(14), color + cv::Scalar::all(14), near);
  return cv::countNonZero(near);
}

TEST(Person, WearsTheShirtBehindTheModelsAndIsBackground) {
  const std::string person =
      "background: {kind: color, color: [10, 20, 30], person: {shirt: [40, 60, 200]}}\n";
  const std::string rest =
      std::string(kCameras) + kQuiet + "light: {ambient: 1, diffuse: 0, specular: 0}\n" + kMotion;
  Loaded plain(rest + kPlain), loaded(rest + person);
  const Frame without = plain.frames().at(0), with = loaded.frames().at(0);
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_TRUE(same(with.views[v].mask, without.views[v].mask));
    EXPECT_GT(count_near(with.views[v].color, {200, 60, 40}), 3000);
    EXPECT_GT(count_near(with.views[v].color, {0.47 * 255, 0.55 * 255, 0.70 * 255}), 200)
        << "face and neck have the hand's skin";
    cv::Mat changed;
    cv::absdiff(with.views[v].color, without.views[v].color, changed);
    cv::Mat inside;
    cv::erode(without.views[v].mask, inside, cv::Mat());
    EXPECT_EQ(cv::mean(changed, inside), cv::Scalar::all(0));
  }
}

TEST(Person, IsASurfaceInTheWorldUnderTheLightOfTheModels) {
  const auto frame = [](const std::string& light, const std::string& person) {
    return first_frame(std::string(kCameras) + kUpright + "depth: true\n" + light +
                       "sensor: {noise_sigma: 0, depth_step_mm: 0}\n"
                       "background: {kind: procedural, clutter: 0, distance_mm: 1500, person: " +
                       person + "}\n");
  };
  const std::string dark = "light: {ambient: 0.3, diffuse: 0, specular: 0}\n";
  const Frame dim = frame(dark, "{offset_mm: [-120, -250], shirt: [200, 200, 200]}");
  const cv::Point chest(115, 130);  // beside the hand
  EXPECT_NEAR(dim.views[0].depth.at<float>(chest), 0.92, 0.03);
  EXPECT_NEAR(dim.views[0].color.at<cv::Vec3b>(chest)[1], 60, 6);
  // f b / z = 175 * 0.12 / 0.92 = 22.8 px
  EXPECT_NEAR(dim.views[1].depth.at<float>(130, 115 - 23), 0.92, 0.03);
  const Frame no_chair = frame(dark, "{offset_mm: [-120, -250], chair: false}");
  const cv::Mat fewer = no_chair.views[0].depth > 1.3, more = dim.views[0].depth > 1.3;
  EXPECT_GT(cv::countNonZero(fewer), cv::countNonZero(more));
}

TEST(Person, IsRefusedBehindTheWallOrWithHalfAColour) {
  EXPECT_THAT(message_of(std::string(kMotion) +
                         "background: {kind: procedural, distance_mm: 800, person: {}}\n"),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("person.distance_mm is 900"),
                    HasSubstr("the wall, 800")));
  EXPECT_THAT(message_of(std::string(kMotion) + "background: {person: {skin: [1, 2]}}\n"),
              HasSubstr("person.skin has 2 numbers, expected three"));
}

}  // namespace
}  // namespace hypotrack::test
