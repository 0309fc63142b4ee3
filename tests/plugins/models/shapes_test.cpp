// Models built with other proportions.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "model_plugins.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Degrees kBent = {{"index_flexion_1", 40},
                       {"index_flexion_2", 60},
                       {"thumb_flexion_2", 20},
                       {"little_abduction", -10}};

Eigen::Matrix3Xd bent_landmarks(const Model& model) {
  return posed_landmarks(model, model_state(model, kBent));
}

TEST(Shape, ScaleMakesEverythingLargerAboutTheWrist) {
  const auto plain = make_model("type: hand");
  const auto larger = make_model("{type: hand, shape: {scale: 1.2}}");
  EXPECT_TRUE(larger->data().mesh.vertices.isApprox(1.2F * plain->data().mesh.vertices, 1e-6F));
  EXPECT_TRUE(bent_landmarks(*larger).isApprox(1.2 * bent_landmarks(*plain), 1e-9));
}

TEST(Shape, FingerLengthsAreWhatFingerScaleDoes) {
  const auto by_shape = make_model(
      "{type: hand, shape: {thumb: 1.1, index: 1.2, middle: 1, ring: 0.9, little: 0.8}}");
  const auto by_scale = make_model("{type: hand, finger_scale: [1.1, 1.2, 1, 0.9, 0.8]}");
  EXPECT_TRUE(by_shape->data().mesh.vertices.isApprox(by_scale->data().mesh.vertices, 1e-6F));
  EXPECT_TRUE(bent_landmarks(*by_shape).isApprox(bent_landmarks(*by_scale), 1e-9));
}

TEST(Shape, WidthMakesFingersThickerAndLeavesTheJoints) {
  const auto plain = make_model("type: hand");
  const auto wider = make_model("{type: hand, shape: {width: 1.2}}");
  EXPECT_TRUE(bent_landmarks(*wider).isApprox(bent_landmarks(*plain), 1e-9));
  const auto thickness = [](const Model& model) {
    const ModelData& data = model.data();
    const auto bone = std::find_if(data.bones.begin(), data.bones.end(),
                                   [](const Bone& b) { return b.name == "middle_2"; });
    const auto index = static_cast<int>(bone - data.bones.begin());
    const auto bind = bind_transforms(data)[static_cast<std::size_t>(index)];
    double low = 0, high = 0;
    for (Eigen::Index v = 0; v < data.mesh.vertices.cols(); ++v) {
      if (data.mesh.bone_indices(0, v) != index || data.mesh.bone_weights(0, v) < 0.95F) continue;
      const double x = (bind.inverse() * data.mesh.vertices.col(v).cast<double>()).x();
      low = std::min(low, x);
      high = std::max(high, x);
    }
    return high - low;
  };
  EXPECT_GT(thickness(*plain), 0.01);
  EXPECT_NEAR(thickness(*wider), 1.2 * thickness(*plain), 0.02 * thickness(*plain));
}

TEST(Shape, ParametersSayTheirValuesBoundsAndOrder) {
  const auto hand = make_model("{type: hand, shape: {ring: 1.05}}");
  std::vector<std::string> names;
  for (const ShapeParameter& p : hand->shape_parameters()) {
    names.push_back(p.name);
    EXPECT_EQ(p.value, p.name == "ring" ? 1.05 : 1) << p.name;
    EXPECT_EQ(p.neutral, 1) << p.name;
  }
  EXPECT_THAT(names, ::testing::ElementsAre("scale", "thumb", "index", "middle", "ring", "little",
                                            "width"));
}

TEST(Shape, ShapedGivesTheModelThatASceneWouldBuild) {
  const auto hand = make_model("{type: hand, shape: {ring: 1.05}}");
  const std::vector<double> values = {0.95, 1, 1, 1.1, 1, 1, 1.02};
  const auto built = make_model("{type: hand, shape: {scale: 0.95, middle: 1.1, width: 1.02}}");
  const ModelData shaped = hand->shaped(values);
  EXPECT_EQ(shaped.mesh.vertices, built->data().mesh.vertices);
  EXPECT_EQ(shaped.landmarks.back().position, built->data().landmarks.back().position);
  EXPECT_THROW(hand->shaped(std::vector<double>{1, 1}), Error);
  EXPECT_THROW(make_model("type: rigid_box")->shaped(values), Error);
}

TEST(Shape, AMirroredHandHasTheShapeOfItsOriginal) {
  const std::string shape = "shape: {scale: 1.1, index: 0.9}";
  const auto right = make_model("{type: hand, " + shape + "}");
  for (const std::string& yaml : {"{type: mirrored_hand, " + shape + "}",
                                  "{type: mirrored_hand, of: {type: hand, " + shape + "}}"}) {
    const auto left = make_model(yaml);
    EXPECT_EQ(left->data().mesh.vertices, mirrored(right->data()).mesh.vertices) << yaml;
    EXPECT_EQ(left->shape_parameters()[2].value, 0.9) << yaml;
    EXPECT_EQ(left->shaped(std::vector<double>(7, 1.0)).mesh.vertices,
              make_model("type: mirrored_hand")->data().mesh.vertices)
        << yaml;
  }
  EXPECT_THAT(model_error("{type: mirrored_hand, " + shape + ", of: {type: hand, " + shape + "}}"),
              HasSubstr("both the mirrored hand and the one in `of` are given a shape"));
}

TEST(Shape, AnyRiggedMeshHasIt) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const std::string webxr = "type: hand, rig: webxr, mesh: '" +
                            (shared_data() / "hands" / "webxr" / "right.glb").string() + "'";
  const auto plain = make_model("{" + webxr + "}");
  const auto longer = make_model("{" + webxr + ", shape: {index: 1.1}}");
  const auto length = [](const Model& model) {
    return (model_landmark(model, "index_dip", kBent) - model_landmark(model, "index_pip", kBent))
        .norm();
  };
  EXPECT_NEAR(length(*longer), 1.1 * length(*plain), 1e-6);
}

TEST(Shape, AFileGivesItAndTheSceneMayChangeIt) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "shape.yaml";
  const auto hand = make_model("{type: hand, shape: {scale: 0.97, thumb: 1.04, width: 1.1}}");
  std::ofstream(file) << shape_yaml(hand->shape_parameters());
  const auto same = make_model("{type: hand, shape_file: '" + file.string() + "'}");
  EXPECT_EQ(same->data().mesh.vertices, hand->data().mesh.vertices);
  const auto changed =
      make_model("{type: hand, shape_file: '" + file.string() + "', shape: {thumb: 1}}");
  EXPECT_EQ(changed->shape_parameters()[0].value, 0.97);
  EXPECT_EQ(changed->shape_parameters()[1].value, 1);
}

TEST(Shape, ARigidMeshHasASize) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "corner.obj";
  std::ofstream(file) << "v 0 0 0\nv 60 0 0\nv 0 80 0\nv 0 0 100\n"
                         "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string object = "type: rigid_mesh, units: mm, mesh: '" + file.string() + "'";
  const auto plain = make_model("{" + object + "}");
  const auto larger = make_model("{" + object + ", shape: {scale: 1.25}}");
  EXPECT_TRUE(larger->data().mesh.vertices.isApprox(1.25F * plain->data().mesh.vertices, 1e-6F));
  EXPECT_TRUE(larger->data().landmarks[1].position.isApprox(
      1.25 * plain->data().landmarks[1].position, 1e-9));
}

TEST(Shape, RefusesWhatNoHandIs) {
  EXPECT_THAT(model_error("{type: hand, shape: {indx: 1.1}}"),
              AllOf(HasSubstr("indx"), HasSubstr("index"), HasSubstr("scene.yaml")));
  EXPECT_THAT(model_error("{type: hand, shape: {index: 2}}"),
              AllOf(HasSubstr("index"), HasSubstr("1.3")));
  EXPECT_THAT(model_error("{type: hand, shape_file: none.yaml}"), HasSubstr("none.yaml"));
}

}  // namespace
}  // namespace hypotrack::test
