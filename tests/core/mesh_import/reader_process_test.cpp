#include <gmock/gmock.h>

#include <filesystem>

#include "hypotrack/api/error.hpp"
#include "mesh_files.hpp"
#include "model/import/process.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A reader that behaves as assimp does on bad days.
class ReaderProcess : public ::testing::Test {
 protected:
  MeshReader reader(const std::string& script, std::chrono::seconds limit) {
    const auto path = write_file(folder_.path() / "reader", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return {path, limit};
  }
  std::string error(const MeshReader& reader) {
    try {
      run_mesh_reader(reader, "some/hand.glb");
    } catch (const DataError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }
  TemporaryDirectory folder_;
};

TEST_F(ReaderProcess, CrashIsAnErrorThatNamesTheSignal) {
  EXPECT_THAT(
      error(reader("kill -SEGV $$", std::chrono::seconds(60))),
      HasSubstr("some/hand.glb: the mesh could not be read: the importer crashed (SIGSEGV)"));
  EXPECT_THAT(error(reader("kill -ABRT $$", std::chrono::seconds(60))), HasSubstr("(SIGABRT)"));
  // A file may be valid and crash the importer: exporting it in the same way would not help.
  EXPECT_THAT(error(reader("kill -SEGV $$", std::chrono::seconds(60))),
              AllOf(HasSubstr("which may be valid: open it in another program"),
                    Not(HasSubstr("damaged"))));
}

TEST_F(ReaderProcess, EndlessLoopIsEndedAtTheLimit) {
  EXPECT_THAT(error(reader("while :; do :; done", std::chrono::seconds(0))),
              HasSubstr("the importer took longer than 0 s"));
  EXPECT_THAT(error(reader("kill -XCPU $$", std::chrono::seconds(60))),
              HasSubstr("the importer took longer than 60 s of processor time"));
}

TEST_F(ReaderProcess, FailureAndAbsenceAreErrors) {
  EXPECT_THAT(error(reader("exit 3", std::chrono::seconds(60))),
              HasSubstr("ended with exit code 3"));
  EXPECT_THAT(error({folder_.path() / "none", std::chrono::seconds(60)}),
              HasSubstr("does not start: No such file"));
}

TEST_F(ReaderProcess, WhatItWritesComesBackWhole) {
  const std::string answer = run_mesh_reader(
      reader("head -c 200000 /dev/zero; printf end", std::chrono::seconds(60)), "a.obj");
  EXPECT_EQ(answer.size(), 200003u);
  EXPECT_TRUE(answer.ends_with("end"));
}

mesh_wire::Scene example() {
  mesh_wire::Scene scene;
  scene.meshes.resize(2);
  scene.meshes[0].name = "first";
  scene.meshes[0].positions = {{1, 2, 3}, {4, 5, 6}};
  scene.meshes[1].triangles = {{0, 1, 2}};
  scene.meshes[1].weights = {{1, 2, 0.5f}};
  scene.bones.push_back({"bone", "parent", {1, 2}});
  scene.materials.push_back({{0.5f, 0.25f, 0},
                             "*0",
                             "skin",
                             {1, 0.5f, 1},
                             {mesh_wire::Wrap::mirror, mesh_wire::Wrap::clamp},
                             {2, 0, 0, 0, 3, 1}});
  scene.linear_colors = 1;
  scene.textures.push_back({0, 0, "bytes"});
  scene.notes = {"a note"};
  return scene;
}

TEST(MeshWire, ReadsWhatItWrites) {
  const mesh_wire::Scene scene = mesh_wire::decode(mesh_wire::encode(example()));
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].name, "first");
  EXPECT_EQ(scene.meshes[0].positions, example().meshes[0].positions);
  EXPECT_EQ(scene.meshes[1].triangles, example().meshes[1].triangles);
  EXPECT_EQ(scene.meshes[1].weights[0].value, 0.5f);
  EXPECT_EQ(scene.bones[0].file_from_bone, example().bones[0].file_from_bone);
  EXPECT_EQ(scene.materials[0].texture, "*0");
  EXPECT_EQ(scene.materials[0].name, "skin");
  EXPECT_EQ(scene.materials[0].factor, example().materials[0].factor);
  EXPECT_EQ(scene.materials[0].wrap, example().materials[0].wrap);
  EXPECT_EQ(scene.materials[0].uv, example().materials[0].uv);
  EXPECT_EQ(scene.linear_colors, 1);
  EXPECT_EQ(scene.textures[0].bytes, "bytes");
  EXPECT_EQ(scene.notes, example().notes);
}

TEST(MeshWire, RefusesEveryTruncation) {
  const std::string whole = mesh_wire::encode(example());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(mesh_wire::decode(whole.substr(0, size)), std::runtime_error) << size;
  }
  EXPECT_THROW(mesh_wire::decode(whole + "x"), std::runtime_error);
}

}  // namespace
}  // namespace hypotrack::test
