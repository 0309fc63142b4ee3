#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"
#include "oriented_pictures.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Upper half red, lower half blue.
std::string picture() {
  cv::Mat image(4, 4, CV_8UC3, cv::Scalar(0, 0, 255));
  image.rowRange(2, 4).setTo(cv::Scalar(255, 0, 0));
  const std::vector<unsigned char> bytes = encode_image(".png", image);
  return std::string(bytes.begin(), bytes.end());
}

GlbContent textured() {
  GlbContent content;
  content.uvs = {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0.25f}};  // v downwards in the file
  return content;
}

class MeshTexture : public ::testing::Test {
 protected:
  std::filesystem::path file(const char* name, std::string_view bytes) {
    return write_file(folder_.path() / name, bytes);
  }
  TemporaryDirectory folder_;
};

TEST_F(MeshTexture, EmbeddedImageIsReadAndVRunsUpwards) {
  GlbContent content = textured();
  content.image = picture();
  const Mesh mesh = import_mesh(file("a.glb", glb(content))).mesh;
  ASSERT_EQ(mesh.texture.size(), cv::Size(4, 4));
  EXPECT_EQ(mesh.texture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255));
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f p = mesh.vertices.col(mesh.triangles(k, t));
      const Eigen::Vector2f uv = mesh.uv.col(mesh.uv_triangles(k, t));
      if (p.isZero()) {
        EXPECT_TRUE(uv.isApprox(Eigen::Vector2f(0, 1))) << uv.transpose();
      }
      if (p.isApprox(Eigen::Vector3f(0, 0, 1))) {
        EXPECT_TRUE(uv.isApprox(Eigen::Vector2f(0.5f, 0.75f))) << uv.transpose();
      }
    }
  }
}

TEST_F(MeshTexture, ImageBesideTheFileIsRelativeToIt) {
  GlbContent content = textured();
  content.image_uri = "skin.png";
  const auto path = file("a.glb", glb(content));
  EXPECT_THAT(import_error(path),
              AllOf(HasSubstr("skin.png is missing"), HasSubstr("name one with `texture`")));
  file("skin.png", "this is no picture");
  EXPECT_THAT(import_error(path), HasSubstr("is no image that OpenCV reads"));
  file("skin.png", picture());
  EXPECT_EQ(import_mesh(path).mesh.texture.rows, 4);
}

TEST_F(MeshTexture, HugeImagesAreRefusedBeforeTheyAreDecoded) {
  std::string huge = picture();
  huge.replace(16, 8, std::string_view("\0\1\0\0\0\1\0\0", 8));  // width and height
  GlbContent content = textured();
  content.image = huge;
  constexpr const char* kWhy = ": the texture has 65536x65536 pixels; at most 134217728 are read";
  EXPECT_THAT(import_error(file("a.glb", glb(content))), HasSubstr(std::string("a.glb") + kWhy));
  content.image.clear();
  content.image_uri = "skin.png";
  file("skin.png", huge);
  EXPECT_THAT(import_error(file("b.glb", glb(content))), HasSubstr(std::string("skin.png") + kWhy));
}

TEST_F(MeshTexture, OptionReplacesTheFilesOwn) {
  GlbContent content = textured();
  content.image_uri = "missing.png";
  file("mine.png", picture());
  const auto path = file("a.glb", glb(content));
  EXPECT_EQ(import_mesh(path, {.texture = folder_.path() / "mine.png"}).mesh.texture.rows, 4);
}

TEST_F(MeshTexture, ExifOrientationTurnsNothingAndIsNamed) {
  // Programs that draw meshes use pictures as they are stored, and browsers turn them.
  const cv::Vec3b red(0, 0, 255);
  GlbContent content = textured();
  content.image = png_with(exif(3), picture());
  ImportedMesh imported = import_mesh(file("a.glb", glb(content)));
  EXPECT_EQ(imported.mesh.texture.at<cv::Vec3b>(0, 0), red);
  EXPECT_THAT(imported.notes, ::testing::ElementsAre(AllOf(HasSubstr("the texture inside the file"),
                                                           HasSubstr("its EXIF orientation is 3"),
                                                           HasSubstr("as it is stored"))));

  cv::Mat halves(16, 16, CV_8UC3, cv::Scalar(0, 0, 255));
  halves.rowRange(8, 16).setTo(cv::Scalar(255, 0, 0));
  file("skin.jpg", jpeg_with(exif(3), encoded(".jpg", halves)));
  content.image.clear();
  content.image_uri = "skin.jpg";
  imported = import_mesh(file("b.glb", glb(content)));
  EXPECT_GT(imported.mesh.texture.at<cv::Vec3b>(2, 2)[2], 200) << "red";
  EXPECT_THAT(imported.notes, ::testing::ElementsAre(HasSubstr("skin.jpg")));
}

TEST_F(MeshTexture, DamagedEmbeddedImageIsAnError) {
  GlbContent content = textured();
  content.image = "this is no picture";
  EXPECT_THAT(import_error(file("a.glb", glb(content))),
              HasSubstr("the texture inside the mesh file is damaged"));
}

TEST_F(MeshTexture, TextureWithoutCoordinatesIsAnError) {
  GlbContent content;
  content.image = picture();
  EXPECT_THAT(import_error(file("a.glb", glb(content))),
              HasSubstr("not every part of the mesh has texture coordinates: mesh '"));
}

TEST_F(MeshTexture, RepeatedCoordinatesMoveIntoTheImage) {
  GlbContent content = textured();
  content.image = picture();
  for (auto& uv : content.uvs) uv[0] += 3;
  const Mesh mesh = import_mesh(file("a.glb", glb(content))).mesh;
  EXPECT_GE(mesh.uv.minCoeff(), 0);
  EXPECT_LE(mesh.uv.maxCoeff(), 1);
  EXPECT_NEAR(mesh.uv.row(0).maxCoeff(), 1, 1e-6);
  EXPECT_NEAR(mesh.uv.row(0).minCoeff(), 0, 1e-6);
}

}  // namespace
}  // namespace hypotrack::test
