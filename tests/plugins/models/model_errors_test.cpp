#include <gmock/gmock.h>

#include <fstream>

#include "model_plugins.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ModelErrors, MeshWithoutRigNamesTheReadyRigs) {
  EXPECT_THAT(model_error("{type: hand, mesh: a.glb}"),
              AllOf(HasSubstr("scene.yaml:1:1"), HasSubstr("`mesh` needs a `rig`"),
                    HasSubstr("godot_xr, godot_xr_left, hypotrack_hand, libhand, webxr")));
}

TEST(ModelErrors, UnknownReadyRigSuggestsTheNearest) {
  EXPECT_THAT(
      model_error("{type: hand, mesh: a.glb, rig: libhnad}"),
      AllOf(HasSubstr("there is no ready rig 'libhnad'"), HasSubstr("did you mean 'libhand'?")));
  EXPECT_THAT(model_error("{type: hand, mesh: a.glb, rig: mine.yaml}"),
              AllOf(HasSubstr("the rig file"), HasSubstr("mine.yaml does not exist")));
}

TEST(ModelErrors, MissingMeshIsNamed) {
  EXPECT_THAT(model_error("{type: hand, mesh: no/such.glb, rig: webxr}"),
              AllOf(HasSubstr("no/such.glb"), HasSubstr("there is no such mesh file")));
  EXPECT_THAT(model_error("{type: rigid_mesh}"), HasSubstr("mesh"));
}

TEST(ModelErrors, RigOfAnotherMeshNamesBothFiles) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  EXPECT_THAT(model_error("{type: hand, rig: libhand, mesh: '" +
                          (shared_data() / "hands/webxr/right.glb").string() + "'}"),
              AllOf(HasSubstr("libhand.yaml (for right.glb)"), HasSubstr("metacarpals"),
                    HasSubstr("which the mesh file does not have")));
}

TEST(ModelErrors, BoxParametersAreChecked) {
  EXPECT_THAT(model_error("{type: rigid_box, size_mm: [1, 2]}"), HasSubstr("size_mm"));
  EXPECT_THAT(model_error("{type: rigid_box, size_mm: [0.06, 0.12, 0.03]}"), HasSubstr("size_mm"))
      << "metres where millimetres belong";
  EXPECT_THAT(model_error("{type: rigid_box, color: [1, 1]}"),
              HasSubstr("`color` must be three numbers"));
  EXPECT_THAT(model_error("{type: rigid_box, texture: none.png}"),
              AllOf(HasSubstr("none.png"), HasSubstr("missing or no image")));
}

}  // namespace
}  // namespace hypotrack::test
