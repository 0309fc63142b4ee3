#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/renderer.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class DepthFromStereo : public test::SourceFixture {
 protected:
  /// A textured box at 0.5 m before a wall at 1.2 m.
  static std::string synthetic(const std::string& cameras) {
    return "source:\n  type: synthetic\n  frames: 1\n  " + cameras +
           "\n  sensor: {noise_sigma: 1}\n"
           "  background: {kind: procedural, distance_mm: 1200, clutter: 0}\n"
           "  keyframes:\n    - {time: 0, pose: {box: {position_mm: [60, 0, 500], "
           "rotation_deg: [20, 40, 10]}}}\n";
  }

  std::unique_ptr<Source> wrap(const std::string& nested, const std::string& more = "") {
    return make("type: depth_from_stereo\n" + more + nested, &textured_);
  }

  /// |depth - rendered depth| on the models, in metres, sorted; unmatched pixels are left out.
  std::vector<double> errors(const View& view, const Camera& camera, const Eigen::VectorXd& state) {
    Renderer renderer(textured_);
    const cv::Mat truth = renderer.render(state, camera, {}).depth;
    std::vector<double> all;
    for (int y = 0; y < truth.rows; ++y) {
      for (int x = 0; x < truth.cols; ++x) {
        const float z = truth.at<float>(y, x), found = view.depth.at<float>(y, x);
        if (z > 0 && found > 0) all.push_back(std::abs(found - z));
      }
    }
    std::sort(all.begin(), all.end());
    pixels_ = cv::countNonZero(truth);
    return all;
  }

  static ModelData textured_box() {
    ModelData data = test::make_test_box({0.12, 0.16, 0.06});
    Mesh& mesh = data.mesh;
    mesh.texture.create(256, 256, CV_8UC3);
    cv::RNG random(3);
    random.fill(mesh.texture, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(mesh.texture, mesh.texture, {}, 2);
    cv::normalize(mesh.texture, mesh.texture, 0, 255, cv::NORM_MINMAX);
    mesh.uv.resize(2, mesh.vertices.cols());
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
      const Eigen::Vector3f p = mesh.vertices.col(i);
      mesh.uv.col(i) = Eigen::Vector2f(0.5F + 4 * p.x() + p.z(), 0.5F + 3 * p.y() + 2 * p.z());
    }
    mesh.uv_triangles = mesh.triangles;
    return data;
  }

  Scene textured_{{{"box", std::make_shared<Model>(textured_box())}}};
  int pixels_ = 0;
};

TEST_F(DepthFromStereo, FindsTheDepthOfATexturedBox) {
  const auto source =
      wrap(synthetic("cameras: {width: 480, height: 360, focal_px: 350, baseline_mm: 120}"),
           "nearest_mm: 350\nfarthest_mm: 1500\n");
  ASSERT_EQ(source->cameras().size(), 1u);
  EXPECT_EQ(source->frame_count(), 1);
  EXPECT_EQ(source->cameras()[0].fx, 350);
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->views.size(), 1u);
  const View& view = frame->views[0];
  ASSERT_EQ(view.depth.type(), CV_32FC1);
  ASSERT_EQ(view.mask.type(), CV_8UC1);
  const std::vector<double> all = errors(view, source->cameras()[0], frame->truth->state);
  EXPECT_GT(all.size(), 0.8 * pixels_);
  EXPECT_LT(all[all.size() / 2], 0.003) << "one disparity is 6 mm here";
  EXPECT_LT(all[all.size() * 9 / 10], 0.012);
  // The wall, away from the box: one disparity is 34 mm there.
  const float wall = view.depth.at<float>(30, 400);
  EXPECT_NEAR(wall, 1.2, 0.02);
  EXPECT_FALSE(source->next());
}

TEST_F(DepthFromStereo, KeepsTruthAndMaskWithCamerasThatTurnAndBend) {
  write("toed_in.yml",
        "%YAML:1.0\n---\ncameras:\n"
        "  - {image_width: 480, image_height: 360, model: brown, K: [350, 0, 240, 0, 352, 178, 0, "
        "0, 1], D: [-0.12, 0.03, 0, 0]}\n"
        "  - {image_width: 480, image_height: 360, model: brown, K: [355, 0, 236, 0, 354, 181, 0, "
        "0, 1], D: [-0.1, 0.02, 0.001, 0],\n"
        "     R: [0.99500417, 0, 0.09983342, 0, 1, 0, -0.09983342, 0, 0.99500417], "
        "T: [-0.12, 0.002, 0.01]}\n");
  const auto source =
      wrap(synthetic("calibration: {file: toed_in.yml}"), "nearest_mm: 350\nfarthest_mm: 1500\n");
  const Camera camera = source->cameras()[0];
  EXPECT_EQ(camera.distortion_model, DistortionModel::none);
  EXPECT_LT(camera.camera_from_world.linear()(2, 2), 0.9999) << "it has been turned";
  const auto frame = source->next();
  const View& view = frame->views[0];
  const std::vector<double> all = errors(view, camera, frame->truth->state);
  EXPECT_GT(all.size(), 0.8 * pixels_);
  EXPECT_LT(all[all.size() / 2], 0.003);
  Renderer renderer(textured_);
  const cv::Mat drawn = renderer.render(frame->truth->state, camera, {}).label > 0;
  EXPECT_LT(cv::countNonZero(drawn != view.mask), 0.03 * pixels_) << "but for the outline";
}

TEST_F(DepthFromStereo, WorksWithTheSecondCameraLeftOfTheFirst) {
  write("swapped.yml",
        "%YAML:1.0\n---\ncameras:\n"
        "  - {image_width: 480, image_height: 360, K: [350, 0, 240, 0, 350, 180, 0, 0, 1], D: [0, "
        "0, 0, 0]}\n"
        "  - {image_width: 480, image_height: 360, K: [350, 0, 240, 0, 350, 180, 0, 0, 1], D: [0, "
        "0, 0, 0], R: [1, 0, 0, 0, 1, 0, 0, 0, 1], T: [0.12, 0, 0]}\n");
  const auto source =
      wrap(synthetic("calibration: {file: swapped.yml}"), "nearest_mm: 350\nfarthest_mm: 1500\n");
  const auto frame = source->next();
  const auto all = errors(frame->views[0], source->cameras()[0], frame->truth->state);
  EXPECT_GT(all.size(), 0.6 * pixels_) << "part of the box is outside the second image";
  EXPECT_LT(all[all.size() / 2], 0.003);
}

TEST_F(DepthFromStereo, PassesDamagedFramesOn) {
  calibrate(64, 48, 2);
  for (const char* side : {"l", "r"}) {
    for (const int i : {0, 2}) {
      write_image(file(cv::format("%s_%d.png", side, i)).string(), picture(i, 0));
    }
  }
  const auto source = wrap(
      "source: {type: image_sequence, left: l_%d.png, right: r_%d.png, calibration: {file: "
      "rig.yml}}\n");
  EXPECT_EQ(source->next()->views.size(), 1u);
  const auto gap = source->next();
  EXPECT_TRUE(gap->views.empty());
  EXPECT_THAT(gap->problem, HasSubstr("l_1.png: is missing"));
  EXPECT_EQ(source->next()->index, 2);
  EXPECT_FALSE(source->next());
}

TEST_F(DepthFromStereo, SaysWhatItCannotMatch) {
  const auto wrapping = [&](const std::string& cameras, const std::string& more = "") {
    return [this, cameras, more] { wrap(synthetic(cameras), more); };
  };
  const std::string pair = "cameras: {width: 320, height: 240, focal_px: 200, baseline_mm: 120}";
  EXPECT_THAT(wrapping("cameras: {count: 1, width: 320, height: 240}"),
              ThrowsMessage<DataError>(HasSubstr("the source has 1 camera; expected two")));
  EXPECT_THAT(wrapping(pair, "nearest_mm: 900\nfarthest_mm: 800\n"),
              ThrowsMessage<ConfigError>(HasSubstr("nearest_mm is 900, farthest_mm 800")));
  EXPECT_THAT(wrapping(pair, "block_size: 4\n"),
              ThrowsMessage<ConfigError>(HasSubstr("block_size is 4; expected an odd number")));
  EXPECT_THAT(wrapping(pair, "nearest_mm: 50\n"),
              ThrowsMessage<ConfigError>(AllOf(
                  HasSubstr("nearest_mm 50 is a disparity of 480 pixels"), HasSubstr("76 mm"))));
  write("above.yml",
        "%YAML:1.0\n---\ncameras:\n"
        "  - {image_width: 64, image_height: 48, K: [60, 0, 32, 0, 60, 24, 0, 0, 1], D: [0, 0, 0, "
        "0]}\n"
        "  - {image_width: 64, image_height: 48, K: [60, 0, 32, 0, 60, 24, 0, 0, 1], D: [0, 0, 0, "
        "0], R: [1, 0, 0, 0, 1, 0, 0, 0, 1], T: [0, 0.1, 0]}\n");
  EXPECT_THAT(wrapping("calibration: {file: above.yml}"),
              ThrowsMessage<DataError>(HasSubstr("expected one beside the other")));
  EXPECT_THAT([&] { make("type: depth_from_stereo\n", &textured_); },
              ThrowsMessage<ConfigError>(HasSubstr("source")));
}

TEST_F(DepthFromStereo, IsRecordedWithTheSourceInsideIt) {
  std::string resolved;
  const ConfigNode config = ConfigNode::parse(
      "type: depth_from_stereo\nblock_size: 7\n" +
          synthetic("cameras: {width: 64, height: 48, focal_px: 30, baseline_mm: 120}"),
      "scene.yaml", folder_.path());
  plugins_.make<Source>(config, &textured_, {}, &resolved);
  EXPECT_THAT(resolved, AllOf(HasSubstr("block_size: 7"), HasSubstr("type: synthetic"),
                              HasSubstr("focal_px: 30")));
  EXPECT_NO_THROW(plugins_.make<Source>(ConfigNode::parse(resolved, "again.yaml"), &textured_));
}

/// Middlebury's Aloe (2006): the one real pair with known disparities.
TEST_F(DepthFromStereo, FindsTheDisparitiesOfARealPair) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const auto folder = test::shared_data() / "images";
  const cv::Mat truth = read_image((folder / "aloeGT.png").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(truth.empty());
  // The pair comes without a calibration; any focal length and baseline give back disparities.
  const double focal = 3740, baseline = 0.16;
  std::string rig = "%YAML:1.0\n---\ncameras:\n";
  for (int i = 0; i < 2; ++i) {
    rig += cv::format(
        "  - {image_width: %d, image_height: %d, model: none, K: [%g, 0, 640, 0, %g, 555, 0, 0, "
        "1], R: [1, 0, 0, 0, 1, 0, 0, 0, 1], T: [%g, 0, 0]}\n",
        truth.cols, truth.rows, focal, focal, -i * baseline);
  }
  write("aloe.yml", rig);
  const auto source =
      wrap("source: {type: image_sequence, left: " + (folder / "aloeL.jpg").string() +
               ", right: " + (folder / "aloeR.jpg").string() + ", calibration: {file: aloe.yml}}\n",
           "nearest_mm: 2300\nfarthest_mm: 40000\n");
  const auto frame = source->next();
  ASSERT_EQ(frame->problem, "");
  int known = 0, matched = 0, wrong = 0;
  for (int y = 0; y < truth.rows; ++y) {
    for (int x = 0; x < truth.cols; ++x) {
      const int d = truth.at<unsigned char>(y, x);
      const float z = frame->views[0].depth.at<float>(y, x);
      if (d == 0) continue;
      ++known;
      if (z == 0) continue;
      ++matched;
      wrong += std::abs(focal * baseline / z - d) > 2;
    }
  }
  RecordProperty("matched_percent", 100 * matched / known);
  RecordProperty("wrong_permille", 1000 * wrong / matched);
  EXPECT_GT(matched, 0.75 * known);
  EXPECT_LT(wrong, 0.08 * matched);
}

}  // namespace
}  // namespace hypotrack
