#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/model.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The message about a hand that `damage` was done to.
template <class F>
std::string message(F&& damage) {
  ModelData data = test::make_test_hand();
  damage(data);
  try {
    validate(data, "hand.glb");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Validate, AcceptsTheTestModels) {
  validate(test::make_test_hand(), "hand");
  validate(test::make_test_box(), "box");
}

TEST(Validate, IsDoneByEveryModel) {
  ModelData data = test::make_test_box();
  data.mesh.triangles.resize(3, 0);
  try {
    Model model(data);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_STREQ(error.what(), "model: the mesh has no faces");
  }
}

TEST(Validate, Geometry) {
  EXPECT_EQ(message([](ModelData& d) { d.mesh.triangles.resize(3, 0); }),
            "hand.glb: the mesh has no faces");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.vertices(1, 5) = static_cast<float>(kNan); }),
            "hand.glb: vertex 5 has NaN or infinite coordinates");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.vertices(1, 6) = static_cast<float>(kInfinity); }),
            "hand.glb: vertex 6 has NaN or infinite coordinates");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.triangles(2, 7) = 1500; }),
            "hand.glb: triangle 7 refers to vertex 1500, but the mesh has 1500 vertices");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.triangles(0, 8) = -1; }),
            "hand.glb: triangle 8 refers to vertex -1, but the mesh has 1500 vertices");
}

TEST(Validate, Weights) {
  EXPECT_EQ(
      message([](ModelData& d) { d.mesh.bone_weights.resize(4, 3); }),
      "hand.glb: the mesh has 1500 vertices but bone weights for 3 and bone indices for 1500");
  EXPECT_EQ(
      message([](ModelData& d) { d.mesh.bone_indices.resize(4, 0); }),
      "hand.glb: the mesh has 1500 vertices but bone weights for 1500 and bone indices for 0");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.bone_indices(3, 9) = 21; }),
            "hand.glb: vertex 9 refers to bone 21, expected 0 to 20");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.bone_indices(0, 9) = -1; }),
            "hand.glb: vertex 9 refers to bone -1, expected 0 to 20");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.bone_weights(0, 9) = static_cast<float>(kNan); }),
            "hand.glb: vertex 9 has a bone weight that is NaN or infinite");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.bone_weights.col(9) << 1.5f, -0.5f, 0, 0; }),
            "hand.glb: vertex 9 has the negative bone weight -0.5");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.bone_weights.col(9) << 0.5f, 0.25f, 0, 0; }),
            "hand.glb: the bone weights of vertex 9 sum to 0.75, expected 1");
}

TEST(Validate, Texture) {
  EXPECT_EQ(message([](ModelData& d) { d.mesh.uv = Eigen::Matrix2Xf::Constant(2, 3, NAN); }),
            "hand.glb: the texture coordinates contain NaN or infinity");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.color[1] = NAN; }),
            "hand.glb: the colour of the mesh contains NaN or infinity");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.uv_triangles = Eigen::Matrix3Xi::Zero(3, 5); }),
            "hand.glb: the mesh has 2976 triangles but texture coordinates for 5");
  EXPECT_EQ(message([](ModelData& d) {
              d.mesh.uv = Eigen::Matrix2Xf::Zero(2, 3);
              d.mesh.uv_triangles = Eigen::Matrix3Xi::Zero(3, 2976);
              d.mesh.uv_triangles(1, 4) = 3;
            }),
            "hand.glb: triangle 4 refers to texture coordinate 3, but there are 3");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.texture = cv::Mat::zeros(4, 4, CV_8UC1); }),
            "hand.glb: the texture is no 8-bit BGR image");
  EXPECT_EQ(message([](ModelData& d) { d.mesh.texture = cv::Mat::zeros(4, 4, CV_8UC3); }),
            "hand.glb: the mesh has a texture but no texture coordinates");
}

TEST(Validate, Bones) {
  EXPECT_EQ(message([](ModelData& d) { d.bones.clear(); }),
            "hand.glb: the model has no bones; a rigid object has one");
  EXPECT_EQ(message([](ModelData& d) { d.bones[2].name.clear(); }), "hand.glb: bone 2 has no name");
  EXPECT_EQ(message([](ModelData& d) { d.bones[2].name = "wrist"; }),
            "hand.glb: two bones are called 'wrist': names must be unique");
  for (const int parent : {2, 3, -2}) {
    EXPECT_EQ(message([&](ModelData& d) { d.bones[2].parent = parent; }),
              "hand.glb: bone 'thumb_2' (2) has parent " + std::to_string(parent) +
                  ": parents must come before their children (-1: none)");
  }
  EXPECT_EQ(message([](ModelData& d) { d.bones[2].parent_from_bone.translation().x() = kNan; }),
            "hand.glb: bone 'thumb_2' has a transform with NaN or infinity");
  const std::string no_rotation =
      "hand.glb: the transform of bone 'thumb_2' is no rotation and translation: scale, shear and "
      "mirrors belong into the vertices";
  EXPECT_EQ(message([](ModelData& d) { d.bones[2].parent_from_bone.linear() *= 1.01; }),
            no_rotation);
  EXPECT_EQ(message([](ModelData& d) { d.bones[2].parent_from_bone.linear().col(0) *= -1; }),
            no_rotation);
}

TEST(Validate, Parameters) {
  EXPECT_EQ(message([](ModelData& d) { d.parameters.resize(6); }),
            "hand.glb: the model has 6 parameters, but every model begins with 3 of a position and "
            "4 of a quaternion");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[9].name.clear(); }),
            "hand.glb: parameter 9 has no name");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[9].name = d.parameters[8].name; }),
            "hand.glb: two parameters are called 'thumb_flexion_1': names must be unique");
  for (const std::size_t i : {0u, 3u, 9u}) {
    EXPECT_EQ(message([&](ModelData& d) {
                d.parameters[i].kind = i == 0 ? ParameterKind::angle : ParameterKind::position;
              }),
              "hand.glb: parameter " + std::to_string(i) + " ('" +
                  test::make_test_hand().parameters[i].name +
                  "') is of the wrong kind: a model's parameters are 3 of a position, 4 of a "
                  "quaternion, then angles and lengths");
  }
  EXPECT_EQ(
      message([](ModelData& d) { d.parameters[8].lower = 2; }),
      "hand.glb: parameter 'thumb_flexion_1' has the lower bound 2 and the upper bound 1: the "
      "wrong way round or NaN");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[8].lower = kNan; }),
            "hand.glb: parameter 'thumb_flexion_1' has the lower bound nan and the upper bound 1: "
            "the wrong way round or NaN");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[8].upper = kInfinity; }),
            "hand.glb: parameter 'thumb_flexion_1' is an angle with one infinite bound: give both, "
            "or none");
  EXPECT_EQ(message([](ModelData& d) {
              d.parameters[8].kind = ParameterKind::length;
              d.parameters[8].upper = kInfinity;
            }),
            "hand.glb: parameter 'thumb_flexion_1' is a length with an infinite bound");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[8].rest = 1.25; }),
            "hand.glb: parameter 'thumb_flexion_1' has the rest value 1.25, expected a number from "
            "-0.2 to 1");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[0].rest = kInfinity; }),
            "hand.glb: parameter 'position_x' has the rest value inf, expected a number from -inf "
            "to inf");
}

TEST(Validate, Motions) {
  EXPECT_EQ(message([](ModelData& d) { d.motions[3].bone = 21; }),
            "hand.glb: motion 3 refers to bone 21, expected 0 to 20");
  for (const int parameter : {6, 27}) {
    EXPECT_EQ(message([&](ModelData& d) { d.motions[3].parameter = parameter; }),
              "hand.glb: motion 3 refers to parameter " + std::to_string(parameter) +
                  ", expected a joint (7 to 26)");
  }
  EXPECT_EQ(message([](ModelData& d) {
              d.motions[3].axis = {0, 0, 2};
            }),
            "hand.glb: motion 3 has an axis of length 2, expected 1");
  EXPECT_EQ(message([](ModelData& d) {
              d.motions[3].axis = {0, 0, kNan};
            }),
            "hand.glb: motion 3 has an axis of length nan, expected 1");
  EXPECT_EQ(message([](ModelData& d) { d.motions[3].scale = kInfinity; }),
            "hand.glb: motion 3 has a zero or a scale that is NaN or infinite");
  EXPECT_EQ(message([](ModelData& d) { d.motions[3].zero = kNan; }),
            "hand.glb: motion 3 has a zero or a scale that is NaN or infinite");
}

TEST(Validate, NamesFitIntoTheHeaderOfATable) {
  for (const char* name : {"a,b", "a\"b", "a\nb", "a\tb"}) {
    std::string shown = name;
    if (std::iscntrl(shown[1])) shown[1] = ' ';
    const std::string refused = "'" + shown +
                                "' may not contain commas, quotes or control characters: it is "
                                "written into the headers of CSV tables";
    EXPECT_EQ(message([&](ModelData& d) { d.landmarks[1].name = name; }),
              "hand.glb: the name of landmark 1 " + refused);
    EXPECT_EQ(message([&](ModelData& d) { d.parameters[9].name = name; }),
              "hand.glb: the name of parameter 9 " + refused);
    EXPECT_EQ(message([&](ModelData& d) { d.bones[2].name = name; }), "no error") << "in no table";
  }
}

TEST(Validate, ParametersDoNotTakeTheNamesOfOtherColumns) {
  for (const std::string name : {"status", "probability"})
    EXPECT_EQ(message([&](ModelData& d) { d.parameters[9].name = name; }),
              "hand.glb: a parameter is called '" + name +
                  "', as a column of track.csv is: give it another name");
}

TEST(Validate, NamesAreUtf8) {
  EXPECT_EQ(message([](ModelData& d) { d.parameters[9].name = "j\xE9"; }),
            "hand.glb: the name of parameter 9 is no UTF-8: write the file in UTF-8");
  EXPECT_EQ(message([](ModelData& d) { d.parameters[9].name = "j\xC3\xA9"; }), "no error");
}

TEST(Validate, Landmarks) {
  EXPECT_EQ(message([](ModelData& d) { d.landmarks[1].name.clear(); }),
            "hand.glb: landmark 1 has no name");
  EXPECT_EQ(message([](ModelData& d) { d.landmarks[1].name = "wrist"; }),
            "hand.glb: two landmarks are called 'wrist': names must be unique");
  EXPECT_EQ(message([](ModelData& d) { d.landmarks[1].bone = -1; }),
            "hand.glb: landmark 'thumb_1' refers to bone -1, expected 0 to 20");
  EXPECT_EQ(message([](ModelData& d) { d.landmarks[1].position.x() = kNan; }),
            "hand.glb: landmark 'thumb_1' has NaN or infinite coordinates");
}

TEST(RigidModel, TakesGivenLandmarks) {
  const ModelData box = rigid_model(test::make_test_box().mesh, {{"handle", 0, {1, 2, 3}}});
  ASSERT_EQ(box.landmarks.size(), 1u);
  EXPECT_EQ(box.landmarks[0].name, "handle");
}

TEST(RigidModel, PutsAnchorsOnTheTwoLongestAxesOfTheBoundingBox) {
  const ModelData box = test::make_test_box({0.1, 0.4, 0.2});
  ASSERT_EQ(box.landmarks.size(), 3u);
  EXPECT_EQ(box.landmarks[0].name, "center");
  EXPECT_EQ(box.landmarks[1].name, "end_y");
  EXPECT_EQ(box.landmarks[2].name, "end_z");
  EXPECT_TRUE(box.landmarks[1].position.isApprox(Eigen::Vector3d(0, 0.2, 0), 1e-6));
  EXPECT_TRUE(box.landmarks[2].position.isApprox(Eigen::Vector3d(0, 0, 0.1), 1e-6));
  EXPECT_EQ(box.parameters.size(), 7u);
  EXPECT_EQ(box.bones.size(), 1u);
}

}  // namespace
}  // namespace hypotrack
