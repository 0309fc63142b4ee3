#include <gmock/gmock.h>

#include "model_plugins.hpp"

namespace hypotrack::test {
namespace {

using Eigen::Vector3d;

struct HandCase {
  std::string name;
  std::string mesh;  ///< below the shared data; empty: the project's own
  std::string rig;
  bool left = false;
};

void PrintTo(const HandCase& hand, std::ostream* out) { *out << hand.name; }

const std::vector<std::string> kFingers = {"index", "middle", "ring", "little"};

/// What holds for every rigged hand, whatever its file was like.
class RiggedHand : public ::testing::TestWithParam<HandCase> {
 protected:
  void SetUp() override {
    const HandCase& hand = GetParam();
    if (hand.mesh.empty()) {
      model_ = make_model("type: hand");
      return;
    }
    HYPOTRACK_NEEDS_SHARED_DATA();
    model_ = make_model("{type: hand, mesh: '" + (shared_data() / "hands" / hand.mesh).string() +
                        "', rig: " + hand.rig + "}");
  }
  /// In the frame of a right hand.
  Vector3d at(const std::string& landmark, const Degrees& degrees = {}) const {
    Vector3d p = model_landmark(*model_, landmark, degrees);
    if (GetParam().left) p.x() = -p.x();
    return p;
  }
  std::unique_ptr<Model> model_;
};

TEST_P(RiggedHand, HasThePapersParametersAndOurLandmarks) {
  EXPECT_EQ(model_->dimension(), 27);
  EXPECT_EQ(model_->data().landmarks.size(), 21u);
  EXPECT_EQ(model_->data().landmarks[0].name, "wrist");
  EXPECT_TRUE(at("wrist").isZero(1e-9));
}

TEST_P(RiggedHand, MovesAsAPoseAndFiveFingers) {
  const auto groups = parameter_groups(model_->data());
  ASSERT_EQ(groups.size(), 6u);
  EXPECT_EQ(groups[0].size(), 7u);
  for (std::size_t g = 1; g < 6; ++g) {
    ASSERT_EQ(groups[g].size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string& name =
          model_->data().parameters[static_cast<std::size_t>(groups[g][i])].name;
      EXPECT_EQ(groups[g][i], static_cast<int>(3 + 4 * g + i));
      EXPECT_TRUE(name.starts_with(g == 1 ? "thumb" : kFingers[g - 2])) << name;
    }
  }
}

TEST_P(RiggedHand, ZeroIsAFlatStraightHandAlongY) {
  for (const std::string& finger : kFingers) {
    const Vector3d mcp = at(finger + "_mcp");
    const Vector3d whole = at(finger + "_tip") - mcp;
    EXPECT_GT(whole.normalized().y(), std::cos(16 * kDegree)) << finger << " " << whole.transpose();
    const double length = (at(finger + "_pip") - mcp).norm() +
                          (at(finger + "_dip") - at(finger + "_pip")).norm() +
                          (at(finger + "_tip") - at(finger + "_dip")).norm();
    EXPECT_GT(whole.norm(), 0.98 * length) << finger << " is bent";
  }
  const Vector3d metacarpal = at("thumb_mcp") - at("thumb_cmc");
  EXPECT_TRUE(metacarpal.normalized().isApprox(Vector3d(1, 1, 0).normalized(), 1e-6));
}

TEST_P(RiggedHand, HasAHandsProportions) {
  const double length = at("middle_tip").norm();
  EXPECT_GT(length, 0.16);
  EXPECT_LT(length, 0.22);
  EXPECT_GT(at("index_mcp").x(), at("middle_mcp").x());
  EXPECT_GT(at("middle_mcp").x(), at("ring_mcp").x());
  EXPECT_GT(at("ring_mcp").x(), at("little_mcp").x());
  EXPECT_GT(at("thumb_cmc").z(), -0.01);
  for (const std::string& finger : kFingers) {
    EXPECT_GT((at(finger + "_tip") - at(finger + "_mcp")).norm(), 0.25 * length) << finger;
    EXPECT_LT((at(finger + "_tip") - at(finger + "_mcp")).norm(), 0.6 * length) << finger;
  }
}

TEST_P(RiggedHand, FlexionBringsTipsPalmarAndNearerTheWrist) {
  for (const std::string& finger : kFingers) {
    for (const std::string joint : {"_flexion_1", "_flexion_2", "_flexion_3"}) {
      const Vector3d straight = at(finger + "_tip");
      const Vector3d bent = at(finger + "_tip", {{finger + joint, 60}});
      EXPECT_GT(bent.z(), straight.z() + 0.005) << finger << joint;
      EXPECT_LT(bent.norm(), straight.norm()) << finger << joint;
      EXPECT_LT(std::abs(bent.x() - straight.x()), 0.025) << finger << joint << " goes sideways";
    }
  }
}

TEST_P(RiggedHand, FistClosesOnThePalm) {
  Degrees fist;
  for (const std::string& finger : kFingers) {
    fist[finger + "_flexion_1"] = 80;
    fist[finger + "_flexion_2"] = 100;
    fist[finger + "_flexion_3"] = 60;
  }
  for (const std::string& finger : kFingers) {
    const Vector3d mcp = at(finger + "_mcp", fist);
    const Vector3d tip = at(finger + "_tip", fist);
    EXPECT_LT(tip.y(), mcp.y()) << finger;
    EXPECT_GT(tip.z(), mcp.z() - 0.01) << finger;
    EXPECT_LT((tip - mcp).norm(), 0.06) << finger;
  }
}

TEST_P(RiggedHand, AbductionIsPositiveTowardsTheThumb) {
  for (const std::string& finger : kFingers) {
    EXPECT_GT(at(finger + "_tip", {{finger + "_abduction", 15}}).x(),
              at(finger + "_tip").x() + 0.01)
        << finger;
  }
}

TEST_P(RiggedHand, ThumbFlexesAcrossThePalmAndAbductsOutOfIt) {
  const Vector3d zero = at("thumb_tip");
  const Vector3d across =
      at("thumb_tip", {{"thumb_flexion_1", 35}, {"thumb_flexion_2", 50}, {"thumb_flexion_3", 60}});
  EXPECT_LT(across.x(), zero.x() - 0.03);
  EXPECT_GT(at("thumb_tip", {{"thumb_abduction", 45}}).z(), zero.z() + 0.03);
}

TEST_P(RiggedHand, RestIsWithinTheBoundsAndSoIsTheBindPoseByAFewDegrees) {
  for (const BoneMotion& rotation : model_->data().motions) {
    const Parameter& p = model_->data().parameters[static_cast<std::size_t>(rotation.parameter)];
    EXPECT_LE(p.lower, p.rest) << p.name;
    EXPECT_GE(p.upper, p.rest) << p.name;
    EXPECT_LE(p.lower, rotation.zero + 1 * kDegree) << p.name;
    EXPECT_GE(p.upper, rotation.zero - 1 * kDegree) << p.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, RiggedHand,
    ::testing::Values(HandCase{"own", "", "", false},
                      HandCase{"libhand", "libhand/libhand_1500.glb", "libhand", false},
                      HandCase{"webxr", "webxr/right.glb", "webxr", false},
                      HandCase{"godot", "godot_xr_tools/hand_r.gltf", "godot_xr", false},
                      HandCase{"godot_left", "godot_xr_tools/hand_l.gltf", "godot_xr_left", true}),
    [](const auto& hand) { return hand.param.name; });

TEST(MirroredHand, IsTheMirrorImageInEveryPose) {
  const auto right = make_model("type: hand");
  const auto left = make_model("type: mirrored_hand");
  const Degrees pose = {{"index_abduction", 15},   {"index_flexion_1", 40}, {"ring_flexion_2", 70},
                        {"thumb_abduction", 30},   {"thumb_flexion_1", 20}, {"thumb_flexion_3", 40},
                        {"little_abduction", -20}, {"middle_flexion_3", 50}};
  const Vector3d flip(-1, 1, 1);
  const Eigen::Matrix3Xd expected =
      flip.asDiagonal() * posed_landmarks(*right, model_state(*right, pose));
  EXPECT_TRUE(posed_landmarks(*left, model_state(*left, pose)).isApprox(expected, 1e-9));
  const Eigen::Matrix3Xf vertices =
      flip.cast<float>().asDiagonal() * posed_vertices(*right, model_state(*right, pose));
  EXPECT_TRUE(posed_vertices(*left, model_state(*left, pose)).isApprox(vertices, 1e-5f));
  for (int i = 0; i < 27; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(left->data().parameters[k].name, right->data().parameters[k].name);
    EXPECT_EQ(left->data().parameters[k].upper, right->data().parameters[k].upper);
  }
}

TEST(MirroredHand, MirrorsAnyModelThatIsNamed) {
  const auto box =
      make_model("{type: mirrored_hand, of: {type: rigid_box, size_mm: [10, 20, 30]}}");
  EXPECT_EQ(box->data().mesh.vertices.cols(), 8);
  EXPECT_THAT(model_error("{type: mirrored_hand, of: {type: hnad}}"), ::testing::HasSubstr("hnad"));
}

TEST(MirroredHand, DefaultModelLeavesAllItsParametersInTheRecord) {
  PluginLoader loader;
  const ConfigNode scene = ConfigNode::parse("models: [{type: mirrored_hand}]", "scene.yaml");
  std::string resolved;
  loader.make<Model>(scene.get("models").at(0), nullptr, {}, &resolved);
  const ConfigNode of = ConfigNode::parse(resolved, "run.yaml").get("of");
  EXPECT_EQ(of.get("type").scalar(), "hand") << resolved;
  for (const char* key : {"mesh", "rig", "scale"}) {
    EXPECT_TRUE(of.get(key).defined()) << key << " is not in:\n" << resolved;
  }
}

TEST(MirroredHand, OfTheRightFileIsTheLeftFile) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const std::string folder = (shared_data() / "hands" / "godot_xr_tools").string();
  const auto mirrored = make_model("{type: mirrored_hand, of: {type: hand, mesh: " + folder +
                                   "/hand_r.gltf, rig: godot_xr}}");
  const auto left =
      make_model("{type: hand, mesh: " + folder + "/hand_l.gltf, rig: godot_xr_left}");
  const Degrees pose = {{"index_flexion_1", 40}, {"ring_flexion_2", 70}, {"thumb_abduction", 30}};
  const Eigen::Matrix3Xd a = posed_landmarks(*mirrored, model_state(*mirrored, pose));
  const Eigen::Matrix3Xd b = posed_landmarks(*left, model_state(*left, pose));
  EXPECT_LT((a - b).colwise().norm().maxCoeff(), 1e-4);
}

TEST(Hand, ScaleAndCutChangeTheMeshAsTheySay) {
  const auto normal = make_model("type: hand");
  const auto large = make_model("{type: hand, scale: 1.2}");
  EXPECT_NEAR(model_landmark(*large, "middle_tip", {}).norm(),
              1.2 * model_landmark(*normal, "middle_tip", {}).norm(), 1e-6);
  const auto cut = make_model("{type: hand, cut_mm: -20}");
  EXPECT_NEAR(cut->data().mesh.vertices.row(1).minCoeff(), 0.02, 1e-6);
  EXPECT_TRUE(model_landmark(*cut, "middle_tip", {})
                  .isApprox(model_landmark(*normal, "middle_tip", {}), 1e-9));
}

}  // namespace
}  // namespace hypotrack::test
