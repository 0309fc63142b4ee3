#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/config_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/search.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Value = ConfigValue;

/// A coloured cuboid in memory, in millimetres.
MeshArrays cuboid() {
  MeshArrays mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.col(i) << (i & 1 ? 30.f : -30.f), (i & 2 ? 45.f : -45.f), (i & 4 ? 20.f : -20.f);
  mesh.triangles.resize(3, 12);
  mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  mesh.colors.resize(3, 8);
  for (int i = 0; i < 8; ++i)
    mesh.colors.col(i) << (i & 1 ? 250 : 20), (i & 2 ? 240 : 30), (i & 4 ? 230 : 40);
  return mesh;
}

Value at(double x, double y, double z) {
  return Value::map({{"box", Value::map({{"position_mm", Value::list({x, y, z})},
                                         {"rotation_deg", Value::list({20, 30, 0})}})}});
}

Value source() {
  return Value::map(
      {{"type", "synthetic"},
       {"frames", 3},
       {"cameras",
        Value::map({{"width", 320}, {"height", 240}, {"focal_px", 300}, {"baseline_mm", 100}})},
       {"keyframes", Value::list({Value::map({{"frame", 0}, {"pose", at(0, 0, 400)}}),
                                  Value::map({{"frame", 2}, {"pose", at(10, 5, 410)}})})}});
}

Value::Map scene_of(const Value& model) {
  return {{"models", Value::list({model})},
          {"source", source()},
          {"objective", Value::map({{"type", "stereo_color"}})},
          {"optimizer", Value::map({{"type", "pso"}, {"particles", 16}, {"generations", 8}})},
          {"tile", Value::map({{"size", 64}})},
          {"init", Value::map({{"pose", at(0, 0, 400)}})}};
}

Value box() {
  return Value::map(
      {{"name", "box"}, {"type", "rigid_box"}, {"size_mm", Value::list({60, 90, 40})}});
}
Value mesh_box() {
  return Value::map(
      {{"name", "box"}, {"type", "rigid_mesh"}, {"mesh", "attached:cuboid"}, {"units", "mm"}});
}

struct BuiltRun : RunWatcher {
  void frame(const Frame& /*frame*/, const Solution& solution, double error) override {
    states.push_back(solution.state);
    errors.push_back(error);
  }
  std::vector<Eigen::VectorXd> states;
  std::vector<double> errors;
};

std::vector<Eigen::VectorXd> states_of(Session session, const std::filesystem::path& out = {}) {
  BuiltRun recorder;
  session.run({.out = out}, recorder);
  return recorder.states;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class BuiltScene : public ::testing::Test {
 protected:
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::string error(const Value::Map& scene, SessionOptions options = {}) {
    return message_of<Error>(
        [&] { Session(Value::map(scene).document("my scene"), std::move(options)); });
  }
  static Value::Map with(Value::Map scene, const std::string& key, const Value& value) {
    for (auto& entry : scene)
      if (entry.first == key) entry.second = value;
    return scene;
  }

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(BuiltScene, TracksAsTheSameSceneInAFile) {
  const ConfigNode scene = Value::map(scene_of(box())).document("my scene");
  std::ofstream(folder() / "scene.yaml") << scene.to_yaml();
  const auto states = states_of(Session(scene));
  ASSERT_EQ(states.size(), 3U);
  EXPECT_EQ(states, states_of(Session(folder() / "scene.yaml")));
  EXPECT_EQ(states, states_of(Session(ConfigNode::parse(scene.to_yaml(), "text"))));
}

TEST_F(BuiltScene, ItsRunYamlRepeatsTheRun) {
  const auto states =
      states_of(Session(Value::map(scene_of(box())).document("my scene")), folder() / "out");
  EXPECT_THAT(text_of(folder() / "out" / "run.yaml"), Not(HasSubstr("#")));
  EXPECT_EQ(states, states_of(Session(folder() / "out" / "run.yaml")));
}

TEST_F(BuiltScene, MistakesNameTheDocumentAndTheKeyPath) {
  const Value::Map scene = scene_of(box());
  EXPECT_EQ(error(with(scene, "tile", Value::map({{"size", "big"}}))),
            "my scene: tile.size: expected an integer from 16 to 1024, found the text \"big\"");
  EXPECT_THAT(error(with(scene, "optimizer", Value::map({{"type", "psa"}}))),
              StartsWith("my scene: optimizer.type: there is no optimizer 'psa'"));
  EXPECT_THAT(error(with(scene, "optimizer", Value::map({{"type", "pso"}, {"particle", 3}}))),
              StartsWith("my scene: optimizer.particle: unknown key"));
  EXPECT_THAT(error(with(scene, "models", Value::list({box(), box()}))),
              StartsWith("my scene: models.1.name: two models are called 'box'"));
  EXPECT_THAT(error(scene, {.set = {"tile.size=9"}}), StartsWith("--set tile.size=9: tile.size"));
}

TEST_F(BuiltScene, TracksAMeshInMemory) {
  const ConfigNode scene = Value::map(scene_of(mesh_box())).document("my scene");
  BuiltRun recorder;
  Session session(scene, {.meshes = {{"cuboid", cuboid()}}});
  session.run({}, recorder);
  ASSERT_EQ(recorder.errors.size(), 3U);
  EXPECT_LT(recorder.errors.back(), 0.01);
  const Mesh& mesh = session.scene().items()[0].model->data().mesh;
  EXPECT_EQ(mesh.vertices.cols(), 8);
  EXPECT_NEAR(mesh.vertices.row(1).maxCoeff(), 0.045, 1e-6) << "in metres";
  EXPECT_FALSE(mesh.texture.empty()) << "its colours";
}

TEST_F(BuiltScene, AMeshInMemoryIsTheModelOfTheSameFile) {
  const MeshArrays mesh = cuboid();
  std::ofstream file(folder() / "cuboid.obj");
  for (const auto& v : mesh.vertices.colwise()) file << "v " << v.transpose() << "\n";
  for (const auto& t : mesh.triangles.colwise())
    file << "f " << (t.array() + 1).transpose() << "\n";
  file.close();
  Value::Map scene = scene_of(mesh_box());
  MeshArrays plain = mesh;
  plain.colors.resize(3, 0);
  const Session in_memory(Value::map(scene).document("my scene"), {.meshes = {{"cuboid", plain}}});
  const Session in_file(Value::map(scene).document("my scene", folder()),
                        {.set = {"models.0.mesh=" + (folder() / "cuboid.obj").string()}});
  const ModelData& a = in_memory.scene().items()[0].model->data();
  const ModelData& b = in_file.scene().items()[0].model->data();
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
}

TEST_F(BuiltScene, RunYamlSaysWhichMeshItCannotRepeat) {
  const SessionOptions options{.meshes = {{"cuboid", cuboid()}, {"other", cuboid()}}};
  const auto states = states_of(
      Session(Value::map(scene_of(mesh_box())).document("my scene"), options), folder() / "out");
  const auto protocol = folder() / "out" / "run.yaml";
  EXPECT_THAT(text_of(protocol),
              StartsWith("# This file repeats the run only in a program that holds the mesh "
                         "attached:cuboid, as"));
  EXPECT_THAT(message_of<ConfigError>([&] { Session{protocol}; }),
              AllOf(HasSubstr("run.yaml:"), HasSubstr("'attached:cuboid' is a mesh in the memory"),
                    HasSubstr("attached is none")));
  EXPECT_EQ(states, states_of(Session(protocol, options)));
}

TEST_F(BuiltScene, RefusesMeshesInMemoryThatAreNone) {
  const auto refusal = [&](const auto& change) {
    MeshArrays mesh = cuboid();
    change(mesh);
    return error(scene_of(mesh_box()), {.meshes = {{"cuboid", mesh}}});
  };
  EXPECT_THAT(refusal([](MeshArrays& m) { m.triangles(1, 3) = 8; }), HasSubstr("attached:cuboid"));
  EXPECT_THAT(refusal([](MeshArrays& m) { m.triangles(1, 3) = -1; }), HasSubstr("the vertex -1"));
  EXPECT_THAT(refusal([](MeshArrays& m) { m.vertices(0, 0) = NAN; }), HasSubstr("attached:cuboid"));
  EXPECT_THAT(refusal([](MeshArrays& m) { m.triangles.resize(3, 0); }), HasSubstr("no faces"));
  EXPECT_THAT(refusal([](MeshArrays& m) { m.colors.conservativeResize(3, 7); }),
              HasSubstr("7 colours for 8 vertices"));
  EXPECT_THAT(error(scene_of(mesh_box()), {.meshes = {{"cube", cuboid()}}}),
              AllOf(StartsWith("my scene: models.0"), HasSubstr("attached are cube")));
}

/// Samples around the start; a plugin of the program.
class Sampler final : public Optimizer {
 public:
  struct Params {
    int count = 64;
    void visit(ParamVisitor& v) { v("count", count, {.help = "points", .min = 1, .max = 1000}); }
  };
  explicit Sampler(const Params& params) : params_(params) {}
  std::int64_t default_evaluations() const override { return params_.count; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t seed) override {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    Eigen::MatrixXd points = region.start.replicate(1, params_.count);
    for (Eigen::Index k = 1; k < points.cols(); ++k)
      for (Eigen::Index i = 0; i < points.rows(); ++i)
        points(i, k) += 0.2 * unit(random) * region.spread[i];
    for (auto point : points.colwise()) point = within_bounds(point, region);
    Eigen::VectorXd costs(points.cols());
    cost.evaluate(points, costs);
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    return {points.col(best), lowest, points.cols()};
  }

 private:
  Params params_;
};

TEST_F(BuiltScene, UsesAPluginOfTheProgram) {
  const SessionOptions options{
      .plugins = {program_plugin<Optimizer>("sampler", [](PluginContext& context) {
        return std::make_unique<Sampler>(context.read<Sampler::Params>());
      })}};
  const Value::Map scene = with(scene_of(box()), "optimizer", Value::map({{"type", "sampler"}}));
  const auto states =
      states_of(Session(Value::map(scene).document("my scene"), options), folder() / "out");
  EXPECT_EQ(states.size(), 3U);
  const std::string protocol = text_of(folder() / "out" / "run.yaml");
  EXPECT_THAT(protocol, AllOf(HasSubstr("holds the optimizer 'sampler',"), HasSubstr("count: 64")));
  EXPECT_THAT(
      error(with(scene, "optimizer", Value::map({{"type", "sampler"}, {"count", 0}})), options),
      StartsWith("my scene: optimizer.count: 0 is out of range"));
  EXPECT_THAT(error(with(scene, "optimizer", Value::map({{"type", "simpler"}})), options),
              HasSubstr("did you mean 'sampler'?"));
}

TEST_F(BuiltScene, RefusesPluginsThatNoSceneCouldName) {
  const auto make = [](PluginContext&) -> void* { return nullptr; };
  const auto refusal = [&](const ProgramPlugin& plugin) {
    return message_of<PluginError>([&] { PluginLoader().add(plugin); });
  };
  EXPECT_THAT(refusal({"optimiser", "mine", make}), HasSubstr("no kind of plugin 'optimiser'"));
  EXPECT_THAT(refusal({"optimizer", "Mine!", make}), HasSubstr("'Mine!' cannot be the optimizer"));
  EXPECT_THAT(refusal({"optimizer", "mine", nullptr}), HasSubstr("a function that makes it"));
}

}  // namespace
}  // namespace hypotrack
