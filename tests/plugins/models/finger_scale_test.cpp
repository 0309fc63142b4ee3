#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "model_plugins.hpp"

namespace hypotrack::test {
namespace {

using ::testing::HasSubstr;

const Degrees kCurled = {{"index_flexion_1", 40},
                         {"index_flexion_2", 60},
                         {"index_abduction", 8},
                         {"thumb_flexion_2", 20},
                         {"middle_flexion_1", 15}};

double distance(const Model& model, const std::string& a, const std::string& b) {
  return (model_landmark(model, a, kCurled) - model_landmark(model, b, kCurled)).norm();
}

TEST(FingerScale, StretchesEveryBoneOfAFingerAndLeavesThePalm) {
  const auto plain = make_model("type: hand");
  const auto longer = make_model("{type: hand, finger_scale: [1.1, 1.2, 1, 0.9, 0.8]}");
  const std::vector<std::pair<std::string, double>> fingers = {
      {"index", 1.2}, {"middle", 1.0}, {"ring", 0.9}, {"little", 0.8}};
  for (const auto& [finger, factor] : fingers) {
    for (const auto& [from, to] :
         {std::pair("_mcp", "_pip"), std::pair("_pip", "_dip"), std::pair("_dip", "_tip")}) {
      EXPECT_NEAR(distance(*longer, finger + from, finger + to),
                  factor * distance(*plain, finger + from, finger + to), 1e-6)
          << finger << to;
    }
    EXPECT_NEAR(distance(*longer, "wrist", finger + "_mcp"),
                distance(*plain, "wrist", finger + "_mcp"), 1e-9);
  }
  EXPECT_NEAR(distance(*longer, "thumb_cmc", "thumb_mcp"),
              1.1 * distance(*plain, "thumb_cmc", "thumb_mcp"), 1e-6);
}

TEST(FingerScale, OneNumberIsForAllFingers) {
  const auto one = make_model("{type: hand, finger_scale: [1.15]}");
  const auto five = make_model("{type: hand, finger_scale: [1.15, 1.15, 1.15, 1.15, 1.15]}");
  EXPECT_EQ(one->data().mesh.vertices, five->data().mesh.vertices);
  EXPECT_NE(one->data().mesh.vertices, make_model("type: hand")->data().mesh.vertices);
}

TEST(FingerScale, TakesTheFleshAlongWithoutFolds) {
  const Mesh before = make_model("type: hand")->data().mesh;
  const Mesh after = make_model("{type: hand, finger_scale: [1.25]}")->data().mesh;
  EXPECT_NEAR(after.vertices.row(1).minCoeff(), before.vertices.row(1).minCoeff(), 1e-7);
  for (Eigen::Index t = 0; t < before.triangles.cols(); ++t) {
    const auto normal = [&](const Mesh& mesh) -> Eigen::Vector3f {
      const Eigen::Vector3f a = mesh.vertices.col(mesh.triangles(0, t));
      return (mesh.vertices.col(mesh.triangles(1, t)) - a)
          .cross(mesh.vertices.col(mesh.triangles(2, t)) - a);
    };
    const Eigen::Vector3f n = normal(before), m = normal(after);
    EXPECT_GT(m.dot(n), 0.8F * m.norm() * n.norm()) << "triangle " << t;
    EXPECT_LT(m.norm(), 1.6F * n.norm()) << "triangle " << t;
  }
}

TEST(FingerScale, WantsOneNumberOrFive) {
  EXPECT_THAT(model_error("{type: hand, finger_scale: [1, 1.1]}"),
              HasSubstr("finger_scale has 2 numbers, expected one for all fingers or five"));
  EXPECT_THAT(model_error("{type: hand, finger_scale: [9]}"), HasSubstr("finger_scale"));
}

}  // namespace
}  // namespace hypotrack::test
