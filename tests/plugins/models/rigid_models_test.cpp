#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "model_plugins.hpp"
#include "plugin/plugin_notes.hpp"

namespace hypotrack::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

double volume(const Mesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3f corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
    sum += static_cast<double>(corners.determinant()) / 6;
  }
  return sum;
}

TEST(RigidBox, HasTheDimensionsOfTheScene) {
  const auto box = make_model("{type: rigid_box, size_mm: [60, 120, 30]}");
  const Mesh& mesh = box->data().mesh;
  EXPECT_EQ(box->dimension(), 7);
  EXPECT_TRUE(mesh.vertices.rowwise().maxCoeff().isApprox(Vector3f(0.03f, 0.06f, 0.015f)));
  EXPECT_TRUE(mesh.vertices.rowwise().minCoeff().isApprox(Vector3f(-0.03f, -0.06f, -0.015f)));
  EXPECT_NEAR(volume(mesh), 0.06 * 0.12 * 0.03, 1e-9);
}

TEST(RigidBox, HasThreeAnchors) {
  const auto box = make_model("{type: rigid_box, size_mm: [60, 120, 30]}");
  ASSERT_EQ(box->data().landmarks.size(), 3u);
  EXPECT_TRUE(model_landmark(*box, "center", {}).isZero(1e-9));
  EXPECT_TRUE(model_landmark(*box, "end_y", {}).isApprox(Vector3d(0, 0.06, 0), 1e-6));
  EXPECT_TRUE(model_landmark(*box, "end_x", {}).isApprox(Vector3d(0.03, 0, 0), 1e-6));
}

/// Texture coordinates of a triangle's corners, in pixels of the texture.
Eigen::Matrix<float, 2, 3> in_pixels(const Mesh& mesh, Eigen::Index triangle) {
  Eigen::Matrix<float, 2, 3> corners = mesh.uv(Eigen::all, mesh.uv_triangles.col(triangle));
  corners.row(0) *= static_cast<float>(mesh.texture.cols);
  corners.row(1) *= static_cast<float>(mesh.texture.rows);
  return corners;
}

/// The pixels of the texture that show on a face (two triangles each), without a cut rim.
cv::Mat picture_of_face(const Mesh& mesh, int face) {
  const auto corners = in_pixels(mesh, 2 * face);
  const Eigen::Vector2f low = corners.rowwise().minCoeff();
  const Eigen::Vector2f high = corners.rowwise().maxCoeff();
  const auto rows = static_cast<float>(mesh.texture.rows);
  const cv::Point first(static_cast<int>(std::ceil(low.x())),
                        static_cast<int>(std::ceil(rows - high.y())));
  const cv::Point last(static_cast<int>(high.x()), static_cast<int>(rows - low.y()));
  return mesh.texture(cv::Rect(first, last));
}

TEST(RigidBox, PrintHasTheSameScaleOnEveryFaceInBothDirections) {
  for (const std::string size : {"[100, 34, 30]", "[60, 60, 60]", "[20, 400, 5]"}) {
    const auto box = make_model("{type: rigid_box, size_mm: " + size + "}");
    const Mesh& mesh = box->data().mesh;
    const Eigen::Matrix3f first = mesh.vertices(Eigen::all, mesh.triangles.col(0));
    const auto first_pixels = in_pixels(mesh, 0);
    const float scale =
        (first_pixels.col(1) - first_pixels.col(0)).norm() / (first.col(1) - first.col(0)).norm();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const Eigen::Matrix3f corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
      const auto pixels = in_pixels(mesh, t);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        EXPECT_NEAR((pixels.col(next) - pixels.col(k)).norm(),
                    scale * (corners.col(next) - corners.col(k)).norm(), 0.01f)
            << size << ", triangle " << t << ", edge " << k;
      }
    }
  }
}

TEST(RigidBox, EveryFaceIsPrintedDifferentlyAndTheSameSeedTheSameWay) {
  const auto one = make_model("{type: rigid_box, pattern: 3}");
  const auto same = make_model("{type: rigid_box, pattern: 3}");
  const auto other = make_model("{type: rigid_box, pattern: 4}");
  const cv::Mat& texture = one->data().mesh.texture;
  EXPECT_EQ(cv::norm(texture, same->data().mesh.texture), 0);
  EXPECT_GT(cv::norm(texture, other->data().mesh.texture), 0);
  cv::Scalar mean;
  cv::Scalar deviation;
  for (int face = 0; face < 6; ++face) {
    const cv::Mat tile = picture_of_face(one->data().mesh, face);
    cv::meanStdDev(tile, mean, deviation);
    EXPECT_GT(deviation[0] + deviation[1] + deviation[2], 60) << "face " << face << " is too plain";
    for (int before = 0; before < face; ++before) {
      const cv::Mat earlier = picture_of_face(one->data().mesh, before);
      EXPECT_TRUE(tile.size() != earlier.size() || cv::norm(tile, earlier) > 0);
    }
  }
}

TEST(RigidBox, TextureTilesFaceOutwardsUnmirrored) {
  const auto box = make_model("type: rigid_box");
  const Mesh& mesh = box->data().mesh;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix<float, 2, 3> uv = mesh.uv(Eigen::all, mesh.uv_triangles.col(t));
    const Eigen::Vector2f a = uv.col(1) - uv.col(0);
    const Eigen::Vector2f b = uv.col(2) - uv.col(0);
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0) << "a mirrored picture on triangle " << t;
  }
}

TEST(RigidBox, TakesAColourOrAPicture) {
  const auto plain = make_model("{type: rigid_box, color: [1, 0.5, 0]}");
  EXPECT_TRUE(plain->data().mesh.color.isApprox(Vector3f(1, 0.5f, 0)));
  EXPECT_EQ(plain->data().mesh.texture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 128, 255))
      << "recoveries look for the texture's colours";
  TemporaryDirectory folder;
  const std::string file = (folder.path() / "label.png").string();
  write_image(file, cv::Mat(10, 20, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto printed = make_model("{type: rigid_box, texture: " + file + "}");
  EXPECT_EQ(printed->data().mesh.texture.size(), cv::Size(60, 20));
}

class RigidMesh : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = (folder_.path() / "part.obj").string();
    std::ofstream(file_) << "v 10 0 0\nv 50 0 0\nv 10 20 0\nv 10 0 30\n"
                            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  }
  TemporaryDirectory folder_;
  std::string file_;
};

TEST_F(RigidMesh, UnitsMakeMetresAndTheOriginIsTheCentre) {
  const auto part = make_model("{type: rigid_mesh, mesh: " + file_ + ", units: mm}");
  const Mesh& mesh = part->data().mesh;
  EXPECT_TRUE(mesh.vertices.rowwise().maxCoeff().isApprox(Vector3f(0.02f, 0.01f, 0.015f), 1e-5f));
  EXPECT_EQ(part->data().landmarks.size(), 3u);
  const auto as_is = make_model("{type: rigid_mesh, mesh: " + file_ + ", units: mm, origin: file}");
  EXPECT_NEAR(as_is->data().mesh.vertices.row(0).maxCoeff(), 0.05, 1e-6);
}

TEST_F(RigidMesh, AnchorsOfTheSceneReplaceThoseOfTheBox) {
  const auto part =
      make_model("{type: rigid_mesh, mesh: " + file_ +
                 ", units: mm, anchors: [{name: corner, position_mm: [-20, -10, -15]}]}");
  ASSERT_EQ(part->data().landmarks.size(), 1u);
  EXPECT_TRUE(model_landmark(*part, "corner", {}).isApprox(Vector3d(-0.02, -0.01, -0.015), 1e-9));
}

TEST_F(RigidMesh, MillimetresReadAsMetresAreToldWhatToDo) {
  EXPECT_THAT(model_error("{type: rigid_mesh, mesh: " + file_ + "}"),
              ::testing::AllOf(::testing::HasSubstr("the object is 40 m long"),
                               ::testing::HasSubstr("`units: mm`")));
}

/// Writes a plane of 0.1 m with `cells` x `cells` x 2 triangles.
void write_plane(const std::filesystem::path& file, int cells) {
  std::ofstream out(file);
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      out << "v " << 0.1 * x / cells << ' ' << 0.1 * y / cells << " 0\n";
  for (int y = 0; y < cells; ++y)
    for (int x = 1; x <= cells; ++x) {
      const int a = y * (cells + 1) + x, b = a + cells + 1;
      out << "f " << a << ' ' << a + 1 << ' ' << b + 1 << "\nf " << a << ' ' << b + 1 << ' ' << b
          << '\n';
    }
}

TEST_F(RigidMesh, HypothesesAreScoredWithFewTrianglesAsTheRunSays) {
  write_plane(file_, 40);
  const auto notes = std::make_shared<PluginNotes>();
  const auto make = [&](const std::string& more) {
    return PluginLoader().make<Model>(
        ConfigNode::parse("{type: rigid_mesh, mesh: " + file_ + more + "}", "scene.yaml"), nullptr,
        {}, nullptr, notes);
  };
  const auto plane = make("");
  EXPECT_EQ(plane->data().mesh.triangles.cols(), 3200);
  EXPECT_LT(plane->data().simplified.triangles.cols(), 100);
  EXPECT_THAT(
      notes->take_lines(),
      testing::ElementsAre(testing::AllOf(
          testing::HasSubstr(fmt::format("hypotheses are scored with {} triangles for its 3200",
                                         plane->data().simplified.triangles.cols())),
          testing::HasSubstr("simplify_mm"))));
  EXPECT_EQ(make(", simplify_mm: 0")->data().simplified.triangles.cols(), 0);
  EXPECT_THAT(notes->take_lines(), testing::IsEmpty());
}

TEST_F(RigidMesh, ReadsTheScannedBoxesWithTheirTexture) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  int found = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(shared_data() / "objects" / "ycb")) {
    if (entry.path().extension() != ".obj") continue;
    const auto box = make_model("{type: rigid_mesh, mesh: '" + entry.path().string() + "'}");
    EXPECT_EQ(box->data().mesh.triangles.cols(), 16384) << entry.path();
    EXPECT_EQ(box->data().mesh.texture.rows, 2048) << entry.path();
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST(MeshModels, TellTheUserWhatTheirFileHasThatIsNotUsed) {
  TemporaryDirectory folder;
  const auto path = folder.path() / "a.obj";
  std::ofstream(path) << "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\ncstype bezier\n";
  const auto notes = std::make_shared<PluginNotes>();
  PluginLoader().make<Model>(
      ConfigNode::parse("{type: rigid_mesh, mesh: " + path.string() + "}", "scene.yaml"), nullptr,
      {}, nullptr, notes);
  EXPECT_THAT(notes->take_lines(),
              testing::ElementsAre(testing::AllOf(
                  testing::StartsWith("note: model (rigid_mesh): " + path.string() + ": "),
                  testing::HasSubstr("`cstype` from line 5"))));
}

}  // namespace
}  // namespace hypotrack::test
