#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <tuple>

#include "expect_error.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "imported_motion.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::ImportedMotion;
using test::message_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Returns the JSON of a GLB file, and checks the lengths that its headers state.
nlohmann::json json_of(const std::string& glb) {
  const auto number_at = [&](std::size_t offset) {
    std::uint32_t number = 0;
    std::memcpy(&number, glb.data() + offset, sizeof(number));
    return number;
  };
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(number_at(4), 2U);
  EXPECT_EQ(number_at(8), glb.size());
  const std::uint32_t text = number_at(12);
  EXPECT_EQ(text % 4, 0U);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  EXPECT_EQ(number_at(20 + text), glb.size() - 28 - text);
  EXPECT_EQ(glb.substr(24 + text, 4), std::string("BIN\0", 4));
  nlohmann::json content = nlohmann::json::parse(glb.substr(20, text));
  EXPECT_EQ(content["buffers"][0]["byteLength"], glb.size() - 28 - text);
  return content;
}

/// Returns the vertex of a model for each vertex of the file, by its position at the bind pose.
std::vector<int> vertices_of_model(const aiMesh& drawn, const Mesh& mesh) {
  std::map<std::tuple<float, float, float>, int> known;
  for (int v = 0; v < mesh.vertices.cols(); ++v)
    known[{mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)}] = v;
  std::vector<int> out;
  for (unsigned v = 0; v < drawn.mNumVertices; ++v)
    out.push_back(known.at({drawn.mVertices[v].x, drawn.mVertices[v].y, drawn.mVertices[v].z}));
  return out;
}

const aiMesh& mesh_of(const ImportedMotion& motion, std::string_view name) {
  for (unsigned m = 0; m < motion.scene().mNumMeshes; ++m)
    if (name == motion.scene().mMeshes[m]->mName.C_Str()) return *motion.scene().mMeshes[m];
  throw std::runtime_error("the file has no mesh " + std::string(name));
}

/// Returns the largest distance of a vertex of the file from that of the posed model, in metres.
double error_of(const ImportedMotion& motion, const Scene::Item& item, double ticks,
                std::span<const double> parameters) {
  const aiMesh& mesh = mesh_of(motion, item.name);
  const std::vector<int> vertices = vertices_of_model(mesh, item.model->data().mesh);
  const Eigen::Matrix3Xd expected = Eigen::Vector3d(1, -1, -1).asDiagonal() *
                                    posed_vertices(*item.model, parameters).cast<double>();
  const Eigen::Matrix3Xd found = motion.vertices_at(ticks, mesh);
  return (found - expected(Eigen::all, vertices)).colwise().norm().maxCoeff();
}

TEST(Gltf, VerticesAreWhereThoseOfThePosedModelsAre) {
  const auto scene = test::make_scene({{"right", "type: hand"},
                                       {"left", "type: mirrored_hand"},
                                       {"box", "{type: rigid_box, size_mm: [60, 90, 40]}"}});
  test::OutputRun run(*scene);
  const std::vector<Solution> solutions = test::random_solutions(*scene, 5);
  run.play("type: gltf", solutions);
  const ImportedMotion motion(run.file("track.glb"));
  for (const Solution& solution : solutions)
    for (const Scene::Item& item : scene->items())
      EXPECT_LT(error_of(motion, item, solution.time * motion.ticks_per_second(),
                         scene->part(item, solution.state)),
                1e-4)
          << item.name << ", frame " << solution.frame;
}

TEST(Gltf, VerticesFollowJointsOfAllKinds) {
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  test::OutputRun run(scene);
  const std::vector<Solution> solutions = test::random_solutions(scene, 5);
  run.play("type: gltf", solutions);
  const ImportedMotion motion(run.file("track.glb"));
  for (const Solution& solution : solutions)
    EXPECT_LT(error_of(motion, scene.items()[0], solution.time * motion.ticks_per_second(),
                       scene.part(scene.items()[0], solution.state)),
              1e-4)
        << "frame " << solution.frame;
}

TEST(Gltf, FilesSayHowLongTheirPartsAre) {
  const auto scene = test::make_scene({{"box", "{type: rigid_box, size_mm: [60, 90, 40]}"}});
  test::OutputRun run(*scene);
  run.play("type: gltf", test::random_solutions(*scene, 3));
  const nlohmann::json content = json_of(run.text("track.glb"));
  for (const auto& view : content["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<int>() % 4, 0);
    EXPECT_LE(view["byteOffset"].get<int>() + view["byteLength"].get<int>(),
              content["buffers"][0]["byteLength"].get<int>());
  }
  EXPECT_EQ(content["asset"]["version"], "2.0");
  const auto& times =
      content["accessors"][content["animations"][0]["samplers"][0]["input"].get<int>()];
  EXPECT_EQ(times["min"][0], 0.0);
  EXPECT_NEAR(times["max"][0], 2 / 30.0, 1e-7);
}

TEST(Gltf, TextureAndItsCoordinatesReadBack) {
  const auto scene = test::make_scene({{"box", "{type: rigid_box, size_mm: [60, 90, 40]}"}});
  test::OutputRun run(*scene);
  run.play("type: gltf", test::random_solutions(*scene, 1));
  const Mesh& mesh = scene->items()[0].model->data().mesh;
  const Mesh read = import_mesh(run.file("track.glb")).mesh;
  ASSERT_EQ(read.texture.size(), mesh.texture.size());
  EXPECT_EQ(cv::norm(read.texture, mesh.texture, cv::NORM_INF), 0);
  ASSERT_EQ(read.uv_triangles.cols(), mesh.uv_triangles.cols());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(
          (read.uv.col(read.uv_triangles(k, t)) - mesh.uv.col(mesh.uv_triangles(k, t))).norm(),
          1e-5F);
}

TEST(Gltf, EdgesOfABoxAreSharpAndAHandIsSmooth) {
  const Scene scene{{{"hand", std::make_shared<Model>(test::make_test_hand())},
                     {"box", std::make_shared<Model>(test::make_test_box())}}};
  test::OutputRun run(scene);
  run.play("type: gltf", test::random_solutions(scene, 1));
  const ImportedMotion motion(run.file("track.glb"));
  EXPECT_EQ(mesh_of(motion, "box").mNumVertices, 24U) << "a corner has three normals";
  const aiMesh& hand = mesh_of(motion, "hand");
  EXPECT_LT(hand.mNumVertices, 2 * scene.items()[0].model->data().mesh.vertices.cols());
  for (unsigned v = 0; v < hand.mNumVertices; ++v) EXPECT_NEAR(hand.mNormals[v].Length(), 1, 1e-5);
}

class GltfHandTest : public ::testing::Test {
 protected:
  double error_at(const ImportedMotion& motion, double seconds, const Solution& solution) const {
    const Scene::Item& item = scene_.items()[0];
    return error_of(motion, item, seconds * motion.ticks_per_second(),
                    scene_.part(item, solution.state));
  }

  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};
  test::OutputRun run_{scene_};
};

TEST_F(GltfHandTest, AModelThatIsNotSeenKeepsItsLastPose) {
  std::vector<Solution> solutions = test::random_solutions(scene_, 4);
  test::set_status(solutions[2], 0, Status::lost);
  run_.play("type: gltf", solutions);
  const ImportedMotion motion(run_.file("track.glb"));
  EXPECT_LT(error_at(motion, solutions[2].time, solutions[1]), 1e-4);
  EXPECT_LT(error_at(motion, solutions[3].time, solutions[3]), 1e-4);
}

TEST_F(GltfHandTest, BetweenFramesTheHandTurnsTheShortWay) {
  Eigen::VectorXd state = scene_.rest_state();
  const Solution first = test::tracked(scene_, 0, state);
  state.segment<4>(3) = -state.segment<4>(3);  // the same rotation
  run_.play("type: gltf", {first, test::tracked(scene_, 1, state)});
  EXPECT_LT(error_at(ImportedMotion(run_.file("track.glb")), 0.5 / 30, first), 1e-4);
}

TEST_F(GltfHandTest, AnInterruptedRunLeavesAWholeFile) {
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  run_.play("type: gltf", solutions, false);
  EXPECT_LT(error_at(ImportedMotion(run_.file("track.glb")), solutions[1].time, solutions[1]),
            1e-4);
}

TEST_F(GltfHandTest, ARunWithoutFramesLeavesTheModelsAtRest) {
  run_.play("type: gltf", {});
  const nlohmann::json content = json_of(run_.text("track.glb"));
  EXPECT_FALSE(content.contains("animations"));
  EXPECT_EQ(content["skins"][0]["joints"].size(), 21U);
}

/// A model whose vertices no skeleton moves.
class Jelly final : public Model {
 public:
  Jelly() : Model(test::make_test_box()) {}

 private:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> /*parameters*/, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    vertices = data().mesh.vertices;
    landmarks.setZero(3, static_cast<Eigen::Index>(data().landmarks.size()));
  }
};

TEST(Gltf, ModelsThatPoseThemselvesAreRefused) {
  const Scene scene{{{"jelly", std::make_shared<Jelly>()}}};
  const test::OutputRun run(scene);
  EXPECT_THAT(message_of<ConfigError>([&] { run.open("type: gltf"); }),
              AllOf(HasSubstr("scene.yaml:1:1"), HasSubstr("'jelly' has no skeleton"),
                    HasSubstr("leave gltf out")));
}

}  // namespace
}  // namespace hypotrack
