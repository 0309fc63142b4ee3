#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"
#include "video_writer.hpp"

namespace hypotrack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class VideoColorFiles : public testing::Test {
 protected:
  std::unique_ptr<VideoFile> written(const std::string& name, const test::VideoRecipe& recipe,
                                     const VideoColors& colors = {}) {
    const std::string file = (folder_.path() / name).string();
    test::write_video(file, recipe);
    return open_video(file, colors);
  }

  test::TemporaryDirectory folder_;
};

/// Returns a video of one colour in YUV.
test::VideoRecipe yuv(int y, int u, int v) {
  return {.codec = "ffv1", .times = {0, 20}, .paint = [=](AVFrame& frame, int) {
            test::fill_plane(frame, 0, y);
            test::fill_plane(frame, 1, u);
            test::fill_plane(frame, 2, v);
          }};
}

/// Checks the colour of the first frame against one in BGR.
void expect_color(VideoFile& video, const cv::Vec3i& expected) {
  cv::Mat picture;
  ASSERT_EQ(video.read(0, picture), "");
  const auto found = picture.at<cv::Vec3b>(20, 20);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1) << k;
}

TEST_F(VideoColorFiles, AreThoseOfTheFilesMatrixAndRange) {
  // Green 192 and others, by ITU-R BT.709 and BT.601.
  test::VideoRecipe recipe = yuv(134, 65, 53);
  recipe.matrix = AVCOL_SPC_BT709;
  expect_color(*written("a.mkv", recipe), {4, 191, 3});
  recipe.matrix = AVCOL_SPC_SMPTE170M;
  expect_color(*written("a.mkv", recipe), {10, 223, 18});
  recipe = yuv(100, 128, 128);
  recipe.matrix = AVCOL_SPC_BT709;
  recipe.range = AVCOL_RANGE_JPEG;
  expect_color(*written("a.mkv", recipe), {100, 100, 100});
  recipe.range = AVCOL_RANGE_MPEG;
  expect_color(*written("a.mkv", recipe), {98, 98, 98});
}

TEST_F(VideoColorFiles, WithoutAMatrixAreThoseOfThePicturesSize) {
  test::VideoRecipe recipe = yuv(134, 65, 53);
  auto video = written("sd.mkv", recipe);
  EXPECT_THAT(video->info().notes, ElementsAre(HasSubstr("BT.601 is assumed")));
  expect_color(*video, {10, 223, 18});
  recipe.width = 1280;
  video = written("hd.mkv", recipe);
  EXPECT_THAT(video->info().notes, ElementsAre(HasSubstr("BT.709 is assumed")));
  expect_color(*video, {4, 191, 3});
}

TEST_F(VideoColorFiles, AreThoseThatAreGivenForFilesThatSayNothing) {
  test::VideoRecipe recipe = yuv(134, 65, 53);
  recipe.width = 1280;
  auto video = written("a.mkv", recipe, {ColorMatrix::bt601, {}});
  EXPECT_THAT(video->info().notes, IsEmpty());
  expect_color(*video, {10, 223, 18});
  video = written("a.mkv", yuv(100, 128, 128), {ColorMatrix::bt709, ColorRange::full});
  EXPECT_THAT(video->info().notes, IsEmpty());
  expect_color(*video, {100, 100, 100});
}

TEST_F(VideoColorFiles, ThatContradictTheFileAreTakenAndSaid) {
  test::VideoRecipe recipe = yuv(134, 65, 53);
  recipe.matrix = AVCOL_SPC_BT709;
  recipe.range = AVCOL_RANGE_JPEG;
  const auto video = written("a.mkv", recipe, {ColorMatrix::bt601, ColorRange::limited});
  EXPECT_THAT(video->info().notes,
              ElementsAre(HasSubstr("in bt709; they are taken for BT.601 as color_matrix says"),
                          HasSubstr("full range; they are taken for limited as color_range says")));
  expect_color(*video, {10, 223, 18});
}

TEST_F(VideoColorFiles, OfRgbPixelsNeedNoMatrixAndSaySo) {
  test::VideoRecipe recipe{.codec = "png", .pixels = AV_PIX_FMT_RGB24, .times = {0, 20}};
  recipe.paint = [](AVFrame& frame, int) { test::fill_plane(frame, 0, 99); };
  const auto video = written("a.mov", recipe, {ColorMatrix::bt601, ColorRange::limited});
  EXPECT_THAT(video->info().notes, ElementsAre(HasSubstr("color_matrix changes nothing"),
                                               HasSubstr("color_range changes nothing")));
  expect_color(*video, {99, 99, 99});
  recipe = {.codec = "ffv1", .pixels = AV_PIX_FMT_GRAY8, .times = {0, 20}};
  recipe.paint = [](AVFrame& frame, int) { test::fill_plane(frame, 0, 99); };
  expect_color(*written("a.mkv", recipe), {99, 99, 99});
}

}  // namespace
}  // namespace hypotrack
