#include "hypotrack/api/clicks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A cube of 8 vertices; its landmarks are the anchors of any rigid model.
ModelData cube() {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.col(i) << (i & 1 ? 0.05F : -0.05F), (i & 2 ? 0.03F : -0.03F),
        (i & 4 ? 0.02F : -0.02F);
  mesh.triangles.resize(3, 12);
  mesh.triangles.transpose() << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7,
      3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  return rigid_model(std::move(mesh));
}

Scene scene_of(std::vector<ModelData> models) {
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> out;
  for (ModelData& data : models) {
    const char* name = data.parameters.size() == kPoseSize ? "box" : "hand";
    out.emplace_back(name, std::make_shared<Model>(std::move(data)));
  }
  return Scene(std::move(out));
}

/// Two cameras with bent lenses, somewhat turned to each other.
std::vector<Camera> bent_pair() {
  Camera left;
  left.width = 640;
  left.height = 480;
  left.fx = left.fy = 500;
  left.cx = 319.5;
  left.cy = 239.5;
  left.distortion_model = DistortionModel::brown;
  left.distortion = {-0.2, 0.05, 0.001, -0.001, 0};
  Camera right = left;
  right.distortion = {-0.15, 0.02, 0, 0, 0};
  right.camera_from_world =
      Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(-0.1, 0.005, 0);
  return {left, right};
}

/// A hand 45 cm away, and what of it is clicked.
class ClickedHand : public ::testing::Test {
 protected:
  ClickedHand() {
    state_ = scene_.rest_state();
    state_.head<3>() << 0.02, 0.05, 0.45;
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(2.9, Eigen::Vector3d(1, 0.2, 0.1).normalized()));
    state_.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  }

  Click click(const std::string& name) const {
    const auto& landmarks = scene_.items()[0].model->data().landmarks;
    const Eigen::Matrix3Xd posed = scene_.landmarks(state_);
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      if (landmarks[i].name != name) continue;
      const Eigen::Vector3d at = posed.col(static_cast<Eigen::Index>(i));
      return {name, project(cameras_[0], at), project(cameras_[1], at)};
    }
    ADD_FAILURE() << "the hand has no landmark " << name;
    return {};
  }
  std::vector<Click> clicks(const std::vector<std::string>& names) const {
    std::vector<Click> out;
    for (const std::string& name : names) out.push_back(click(name));
    return out;
  }
  ClickFit fit(const std::vector<Click>& clicks) const {
    return fit_clicks(scene_, cameras_, clicks, 8, "clicks.yaml");
  }

  Scene scene_ = scene_of({test::make_test_hand()});
  std::vector<Camera> cameras_ = bent_pair();
  Eigen::VectorXd state_;
};

TEST_F(ClickedHand, IsPlacedThroughBentLenses) {
  const ClickFit found = fit(clicks({"wrist", "index_1", "little_1", "middle_1"}));
  EXPECT_LT((scene_.landmarks(found.state) - scene_.landmarks(state_)).colwise().norm().maxCoeff(),
            0.5e-3);
  ASSERT_EQ(found.residuals.size(), 4);
  EXPECT_EQ(found.residuals[1].landmark, "hand.index_1");
  for (const ClickResidual& r : found.residuals) {
    EXPECT_LT(r.distance, 0.3e-3);
    EXPECT_LT(r.pixels, 0.5);
  }
}

TEST_F(ClickedHand, StaysAtRestWhereNothingIsClicked) {
  state_.tail(20).array() += 0.2;
  const ClickFit found = fit(clicks({"wrist", "index_1", "little_1", "middle_1", "middle_tip"}));
  const auto& parameters = scene_.parameters();
  int compared = 0;
  for (std::size_t i = kPoseSize; i < parameters.size(); ++i) {
    if (parameters[i].name.find("middle") != std::string::npos) continue;
    if (parameters[i].name.find("ring") == std::string::npos) continue;
    EXPECT_NEAR(found.state[static_cast<Eigen::Index>(i)], parameters[i].rest, 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST_F(ClickedHand, HasResidualsOfSloppyClicks) {
  std::vector<Click> all = clicks({"wrist", "index_1", "little_1", "middle_1", "ring_1"});
  all[1].left.x() += 5;
  all[1].right.x() += 5;
  const ClickFit found = fit(all);
  EXPECT_GT(found.residuals[1].pixels, 1);
  EXPECT_LT(found.residuals[1].pixels, 5);
  EXPECT_GT(found.residuals[1].distance, 1e-3);
  EXPECT_THAT(describe(found), AllOf(HasSubstr("5 clicks"), HasSubstr("hand.index_1"),
                                     HasSubstr(" mm, "), HasSubstr(" px")));
}

TEST_F(ClickedHand, IsRefusedWithTheNamesOfClicksThatDoNotMeet) {
  std::vector<Click> all = clicks({"wrist", "index_1", "little_1", "middle_1"});
  all[1].right.y() += 20;
  EXPECT_THAT(message_of<DataError>([&] { fit(all); }),
              AllOf(HasSubstr("clicks.yaml: the clicks of 'index_1' (20.0 px) do not meet"),
                    HasSubstr("at most 8 px"), Not(HasSubstr("'wrist'"))));
}

TEST_F(ClickedHand, IsRefusedIfTheViewsAreExchanged) {
  std::vector<Click> all = clicks({"wrist", "index_1", "little_1", "middle_1"});
  for (Click& c : all) std::swap(c.left, c.right);
  EXPECT_THAT(message_of<DataError>([&] { fit(all); }), HasSubstr("do not meet"));
}

TEST_F(ClickedHand, NeedsFourLandmarksNotOnALine) {
  EXPECT_THAT(message_of<ConfigError>([&] {
                fit(clicks({"wrist", "index_1", "little_1"}));
              }),
              HasSubstr("3 landmarks of 'hand' are clicked; expected 4 or more"));
  EXPECT_THAT(message_of<ConfigError>([&] { fit({}); }), HasSubstr("holds no click"));
  EXPECT_THAT(message_of<ConfigError>([&] {
                fit(clicks({"wrist", "index_1", "little_1", "wrist"}));
              }),
              HasSubstr("'wrist' is clicked twice"));
  const std::vector<Click> wrist = clicks({"wrist"});
  std::vector<Click> line;
  for (const char* name : {"wrist", "index_1", "middle_1", "ring_1"}) {
    const Eigen::Vector3d at(0.01 * static_cast<double>(line.size()), 0.02, 0.45);
    line.push_back({name, project(cameras_[0], at), project(cameras_[1], at)});
  }
  EXPECT_THAT(message_of<DataError>([&] { fit(line); }), HasSubstr("lie on a line"));
}

TEST_F(ClickedHand, IsRefusedIfTheClicksFitNoHand) {
  std::vector<Click> all = clicks({"wrist", "index_tip", "little_1", "middle_1"});
  std::swap(all[0].landmark, all[2].landmark);
  std::swap(all[1].landmark, all[3].landmark);
  EXPECT_THAT(message_of<DataError>([&] { fit(all); }),
              HasSubstr("the clicks do not fit the model 'hand'"));
}

TEST_F(ClickedHand, RefusesWhatIsNoLandmarkOrNotInThePicture) {
  std::vector<Click> all = clicks({"wrist", "index_1", "little_1", "middle_1"});
  all[1].landmark = "indx_1";
  EXPECT_THAT(message_of<ConfigError>([&] { fit(all); }),
              AllOf(HasSubstr("'indx_1' is no landmark"), HasSubstr("did you mean 'index_1'?")));
  all[1] = click("index_1");
  all[1].left.x() = 700;
  EXPECT_THAT(message_of<ConfigError>([&] { fit(all); }),
              HasSubstr("lies outside of the left picture, which has 640x480 pixels"));
  cameras_.pop_back();
  EXPECT_THAT(message_of<DataError>([&] { fit(all); }), HasSubstr("need two views"));
}

TEST(ClickedBox, IsPlacedByThreeCorners) {
  const Scene scene = scene_of({cube(), test::make_test_hand()});
  const std::vector<Camera> cameras = bent_pair();
  Eigen::VectorXd state = scene.rest_state();
  state.head<3>() << 0.03, -0.02, 0.5;
  const Eigen::Quaterniond turned(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, 1, -0.4).normalized()));
  state.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  const auto box = clickable(scene.items()[0].model);
  const Eigen::Matrix3Xd posed = posed_landmarks(*box, scene.part(scene.items()[0], state));
  std::vector<Click> clicks;
  for (const char* name : {"corner_000", "corner_100", "corner_011"})
    for (std::size_t i = 0; i < box->data().landmarks.size(); ++i)
      if (box->data().landmarks[i].name == name) {
        const Eigen::Vector3d at = posed.col(static_cast<Eigen::Index>(i));
        clicks.push_back({name, project(cameras[0], at), project(cameras[1], at)});
      }
  ASSERT_EQ(clicks.size(), 3);
  const ClickFit fit = fit_clicks(scene, cameras, clicks, 8, "clicks.yaml");
  EXPECT_LT((fit.state.head<3>() - state.head<3>()).norm(), 1e-4);
  EXPECT_GT(std::abs(fit.state.segment<4>(3).dot(state.segment<4>(3))), 0.99999);
  EXPECT_EQ(fit.state.tail(27), scene.rest_state().tail(27)) << "the hand stays at rest";
}

TEST(Clicks, AreReadAsTheyAreWritten) {
  const std::vector<Click> clicks{{"hand.wrist", {412.5, 300}, {371.25, 301}},
                                  {"index_mcp", {0, 1}, {2, 3}}};
  const ClickedFrame all =
      read_clicks(ConfigNode::parse(clicks_yaml({clicks, 12, {"00ff", "7f80"}}), "clicks.yaml"));
  EXPECT_EQ(all.frame, 12);
  EXPECT_EQ(all.pictures, (std::vector<std::string>{"00ff", "7f80"}));
  const std::vector<Click>& read = all.clicks;
  ASSERT_EQ(read.size(), 2);
  EXPECT_EQ(read[0].landmark, "hand.wrist");
  EXPECT_LT((read[0].right - clicks[0].right).norm(), 0.1);
  EXPECT_EQ(read[1].left, clicks[1].left);
}

TEST(Clicks, KnowTheFrameThatWasClickedByItsPictures) {
  cv::Mat picture(96, 128, CV_8UC3, cv::Scalar::all(90)), noisy, other;
  cv::rectangle(picture, {40, 30, 30, 30}, cv::Scalar(120, 160, 220), cv::FILLED);
  noisy = picture + cv::Scalar::all(4);
  other = picture.clone();
  cv::rectangle(other, {70, 30, 30, 30}, cv::Scalar(120, 160, 220), cv::FILLED);
  Frame frame;
  frame.index = 7;
  frame.views = {{picture, {}}, {picture, {}}};
  ClickedFrame clicked{{}, 12, summaries(frame)};
  ASSERT_EQ(clicked.pictures.size(), 2u);
  EXPECT_EQ(clicked.pictures[0].size(), 96u);
  const auto message = [&] {
    return message_of<DataError>([&] { expect_clicked_frame(clicked, frame, "c.yaml"); });
  };
  EXPECT_NO_THROW(expect_clicked_frame(clicked, frame, "c.yaml"));
  frame.views[1].color = noisy;
  EXPECT_NO_THROW(expect_clicked_frame(clicked, frame, "c.yaml"));
  frame.views[1].color = other;
  EXPECT_THAT(message(), AllOf(HasSubstr("c.yaml: "), HasSubstr("clicked in frame 12"),
                               HasSubstr("not those of frame 7")));
  clicked.pictures[1] = "no number";
  frame.views[1].color = picture;
  EXPECT_THAT(message(), HasSubstr("c.yaml: "));
  clicked.pictures.clear();
  EXPECT_NO_THROW(expect_clicked_frame(clicked, frame, "c.yaml"));
}

TEST(Clicks, AreRefusedWithTheirPlaceInTheFile) {
  const auto message = [](const std::string& text) {
    return message_of<ConfigError>([&] { read_clicks(ConfigNode::parse(text, "c.yaml")); });
  };
  EXPECT_THAT(message("clicks: [{landmark: wrist, left: [1, 2]}]"),
              AllOf(HasSubstr("c.yaml:1:"), HasSubstr("right")));
  EXPECT_THAT(message("clicks: [{landmark: wrist, left: [1], right: [1, 2]}]"),
              HasSubstr("c.yaml:1:"));
  EXPECT_THAT(message("{}"), HasSubstr("clicks"));
}

}  // namespace
}  // namespace hypotrack
