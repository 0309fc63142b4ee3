#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A square from (0, 0, 0) to (1, 1, 0) with the texture coordinates of its corners. Its picture is
/// red and green above, blue and yellow below.
class MtlFile : public testing::Test {
 protected:
  MtlFile() {
    cv::Mat3b picture(8, 8);
    picture({0, 0, 4, 4}).setTo(cv::Scalar(10, 10, 249));
    picture({4, 0, 4, 4}).setTo(cv::Scalar(10, 249, 10));
    picture({0, 4, 4, 4}).setTo(cv::Scalar(249, 10, 10));
    picture({4, 4, 4, 4}).setTo(cv::Scalar(10, 249, 249));
    const std::vector<unsigned char> bytes = encode_image(".png", picture);
    write_file(folder_.path() / "four squares.png", std::string(bytes.begin(), bytes.end()));
  }

  ImportedMesh import(const std::string& materials, const std::string& head = "mtllib a.mtl\n",
                      const std::string& used = "a") {
    if (!materials.empty()) write_file(folder_.path() / "a.mtl", materials);
    return import_mesh(write_file(
        folder_.path() / "square.obj",
        head + "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl " +
            used + "\nf 1/1 2/2 3/3 4/4\n"));
  }

  Mesh mapped(const std::string& options, const std::string& more = "") {
    return import("newmtl a\n" + more + "map_Kd " + options + " four squares.png\n").mesh;
  }

  void expect_color(const Mesh& mesh, float x, float y, const Eigen::Vector3f& expected) {
    const Eigen::Vector3f found = surface_color(mesh, {x, y, 0});
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1.5f)
        << "at (" << x << ", " << y << "): " << found.transpose() << ", not "
        << expected.transpose();
  }

  std::vector<std::string> notes_on(const ImportedMesh& imported) {
    std::vector<std::string> out;
    for (const std::string& note : imported.notes)
      out.push_back(note.substr((folder_.path() / "square.obj: ").string().size()));
    return out;
  }

  const Eigen::Vector3f kRed{249, 10, 10}, kGreen{10, 249, 10}, kBlue{10, 10, 249},
      kYellow{249, 249, 10};
  TemporaryDirectory folder_;
};

TEST_F(MtlFile, PictureHasItsOffsetAndScale) {
  const Mesh plain = mapped("");
  expect_color(plain, 0.25f, 0.75f, kRed);
  expect_color(plain, 0.75f, 0.25f, kYellow);
  expect_color(mapped("-o 0.5 0 0"), 0.25f, 0.75f, kGreen);
  expect_color(mapped("-o 0 0.5"), 0.25f, 0.25f, kRed);
  const Mesh scaled = mapped("-s 2 1 1 -blendu on");
  expect_color(scaled, 0.125f, 0.75f, kRed);
  expect_color(scaled, 0.375f, 0.75f, kGreen);
  expect_color(scaled, 0.625f, 0.75f, kRed);
}

TEST_F(MtlFile, PictureIsClampedIfItSaysSo) {
  const Mesh clamped = mapped("-clamp on -s 3 3 -o -1 -1");
  expect_color(clamped, 0.1f, 0.9f, kRed);
  expect_color(clamped, 0.1f, 0.6f, kRed);
  expect_color(clamped, 0.4f, 0.4f, kBlue);
  expect_color(clamped, 0.9f, 0.1f, kYellow);
  expect_color(mapped("-clamp off -s 3 3 -o -1 -1"), 0.1f, 0.8f, kBlue);
}

TEST_F(MtlFile, KdMultipliesThePicture) {
  // 0.5 of the screen's range is 0.214 of its light; 249 becomes 124.
  expect_color(mapped("", "Kd 0.5 1 1\n"), 0.25f, 0.75f, {124, 10, 10});
  const ImportedMesh black = import("newmtl a\nKd 0 0 0\nmap_Kd four squares.png\n");
  expect_color(black.mesh, 0.25f, 0.75f, kRed);
  EXPECT_THAT(notes_on(black), ElementsAre("material 'a' is not drawn as the file says: Kd 0 0 0 "
                                           "(it would make map_Kd black)"));
}

TEST_F(MtlFile, KdOfOneNumberIsGrey) {
  EXPECT_EQ(import("newmtl a\nKd 0.25\n").mesh.color, Eigen::Vector3f::Constant(0.25f));
}

TEST_F(MtlFile, ByteOrderMarksHideNothing) {
  const std::string mark = "\xEF\xBB\xBF";
  const ImportedMesh imported = import(mark + "newmtl a\nKd 0.25\n", mark + "mtllib a.mtl\n");
  EXPECT_EQ(imported.mesh.color, Eigen::Vector3f::Constant(0.25f));
  EXPECT_THAT(notes_on(imported), IsEmpty());
}

TEST_F(MtlFile, WhatOnlyShadesHasNoNote) {
  EXPECT_THAT(
      import("# made up\nnewmtl a\nKa 1 1 1\nKd 1 0 0\nKs 0 0 0\nKe 0 0 0\nNs 10\nNi 1\nd 1\n"
             "Tr 0\nillum 2\n")
          .notes,
      IsEmpty());
}

TEST_F(MtlFile, OneNoteNamesWhatAMaterialHasThatIsNotDrawn) {
  EXPECT_THAT(
      notes_on(import("newmtl a\nKd 1 0 0\nKe 0 1 0\nd 0.5\nmap_Bump bumps.png\nmine 1 2\n"
                      "map_Kd -mm 0.1 0.9 -t 1 1 1 four squares.png\nnewmtl b\nyours 1\n")),
      ElementsAre("material 'a' is not drawn as the file says: Ke (it adds no light), d (it is "
                  "opaque), map_Bump (line 5), mine (line 6), map_Kd -mm, map_Kd -t"));
}

TEST_F(MtlFile, MissingFilesAreNamed) {
  EXPECT_THAT(notes_on(import("", "mtllib none.mtl\n")),
              ElementsAre("its material file none.mtl is missing or too large: put it beside the "
                          "mesh"));
  write_file(folder_.path() / "square.mtl", "newmtl a\nKd 1 0 0\n");
  const ImportedMesh replaced = import("", "mtllib none.mtl\n");
  EXPECT_EQ(replaced.mesh.color, Eigen::Vector3f(1, 0, 0));
  EXPECT_THAT(notes_on(replaced),
              ElementsAre("its material file none.mtl is missing or too large: square.mtl is read "
                          "instead"));
}

TEST_F(MtlFile, MaterialsThatAreNotDefinedAreNamed) {
  EXPECT_THAT(
      notes_on(import("newmtl a\nKd 1 0 0\n", "mtllib a.mtl\n", "b")),
      ElementsAre("the materials 'b' (line 10) are not defined in a.mtl: their surfaces are "
                  "grey"));
  EXPECT_THAT(notes_on(import("", "")),
              ElementsAre("the materials 'a' (line 9) are not defined in a material file "
                          "(`mtllib`): their surfaces are grey"));
}

}  // namespace
}  // namespace hypotrack::test
