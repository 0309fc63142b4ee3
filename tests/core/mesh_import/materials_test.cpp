#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "mesh_files.hpp"

namespace hypotrack::test {
namespace {

/// Returns the colour in the middle of a triangle, RGB from 0 to 255.
Eigen::Vector3i color_of(const Mesh& mesh, Eigen::Index triangle) {
  const Eigen::Vector2f uv = mesh.uv(Eigen::all, mesh.uv_triangles.col(triangle)).rowwise().mean();
  const int x = static_cast<int>(uv.x() * static_cast<float>(mesh.texture.cols));
  const int y = static_cast<int>((1 - uv.y()) * static_cast<float>(mesh.texture.rows));
  const auto& bgr = mesh.texture.at<cv::Vec3b>(y, x);
  return {bgr[2], bgr[1], bgr[0]};
}

class MeshMaterials : public ::testing::Test {
 protected:
  /// Imports a tetrahedron whose faces have the materials `a`, `b`, `c` and `a`.
  Mesh import(const std::string& materials) {
    write_file(folder_.path() / "a.mtl", materials);
    return import_mesh(write_file(folder_.path() / "a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                  "vt 0 0\nvt 1 0\nvt 0 0.4\n"
                                  "usemtl a\nf 1/1 3/2 2/3\nusemtl b\nf 1/1 2/2 4/3\n"
                                  "usemtl c\nf 1/1 4/2 3/3\nusemtl a\nf 2/1 3/2 4/3\n"))
        .mesh;
  }
  /// Writes a picture whose lower half has the colour and whose upper half is black.
  void write_picture(const char* name, const cv::Scalar& bgr) {
    cv::Mat image(8, 8, CV_8UC3, cv::Scalar::all(0));
    image.rowRange(4, 8).setTo(bgr);
    const std::vector<unsigned char> bytes = encode_image(".png", image);
    write_file(folder_.path() / name, std::string(bytes.begin(), bytes.end()));
  }
  /// Returns the colours of the triangles, in any order.
  std::vector<Eigen::Vector3i> colors(const Mesh& mesh) {
    std::vector<Eigen::Vector3i> out;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) out.push_back(color_of(mesh, t));
    return out;
  }
  TemporaryDirectory folder_;
};

const Eigen::Vector3i kRed(255, 0, 0), kGreen(0, 255, 0), kBlue(0, 0, 255);

TEST_F(MeshMaterials, ColorsOfSeveralAreDrawn) {
  const Mesh mesh = import("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nnewmtl c\nKd 0 0 1\n");
  EXPECT_THAT(colors(mesh), testing::UnorderedElementsAre(kRed, kGreen, kBlue, kRed));
}

TEST_F(MeshMaterials, OfOneColorAreTheColorOfTheMesh) {
  const Mesh mesh = import("newmtl a\nKd 1 0 0\nnewmtl b\nKd 1 0 0\nnewmtl c\nKd 1 0 0\n");
  EXPECT_TRUE(mesh.texture.empty());
  EXPECT_EQ(mesh.uv.cols(), 0);
  EXPECT_EQ(mesh.color, Eigen::Vector3f(1, 0, 0));
}

TEST_F(MeshMaterials, PicturesAndColorsShareATexture) {
  write_picture("green.png", {0, 255, 0});
  write_picture("blue.png", {255, 0, 0});
  const Mesh mesh =
      import("newmtl a\nKd 1 0 0\nnewmtl b\nmap_Kd green.png\nnewmtl c\nmap_Kd blue.png\n");
  EXPECT_THAT(colors(mesh), testing::UnorderedElementsAre(kRed, kGreen, kBlue, kRed));
  EXPECT_GE(mesh.uv.minCoeff(), 0);
  EXPECT_LE(mesh.uv.maxCoeff(), 1);
}

TEST_F(MeshMaterials, AMissingPictureIsNamed) {
  write_picture("green.png", {0, 255, 0});
  EXPECT_THROW(import("newmtl a\nmap_Kd green.png\nnewmtl b\nmap_Kd none.png\n"), DataError);
}

}  // namespace
}  // namespace hypotrack::test
