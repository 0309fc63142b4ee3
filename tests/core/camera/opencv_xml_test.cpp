// XML of cv::FileStorage.

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

class OpenCvXml : public test::CalibrationFiles {
 protected:
  /// Writes what stereo_calib and others do, as OpenCV itself, in the form of the file's ending.
  CalibrationSettings stereo(const std::string& name) const {
    CalibrationSettings settings;
    settings.file = folder_.path() / name;
    cv::FileStorage out(settings.file.string(), cv::FileStorage::WRITE);
    const cv::Mat_<double> left(cv::Matx33d(530, 0, 320.5, 0, 531, 240.25, 0, 0, 1));
    out << "M1" << left << "D1" << cv::Mat_<double>(cv::Matx<double, 1, 5>(-0.3, 0.1, 1e-3, 0, 0));
    out << "M2" << left << "D2" << cv::Mat_<float>(cv::Matx<float, 1, 4>(-0.25f, 0.1f, 0, 0));
    out << "R" << cv::Mat_<double>::eye(3, 3) << "T" << cv::Mat_<double>(cv::Matx31d(-0.08, 0, 0));
    out << "imageSize" << cv::Size(640, 480) << "flags" << 5 << "odd"
        << "a text <of> two & more";
    return settings;
  }
};

TEST_F(OpenCvXml, HasTheCamerasThatYamlHas) {
  const std::vector<Camera> yaml = load_calibration(stereo("rig.yml"));
  std::vector<std::string> notes;
  const std::vector<Camera> xml = load_calibration(stereo("rig.xml"), {}, &notes);
  ASSERT_EQ(xml.size(), 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(xml[i].fx, yaml[i].fx);
    EXPECT_EQ(xml[i].cy, yaml[i].cy);
    EXPECT_EQ(xml[i].width, 640);
    EXPECT_EQ(xml[i].distortion, yaml[i].distortion);
    EXPECT_TRUE(xml[i].camera_from_world.isApprox(yaml[i].camera_from_world, 1e-12));
  }
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("rig.xml: not used: "), HasSubstr("odd"))));
}

TEST_F(OpenCvXml, MayHaveTheSizeAsAMatrixOfWholeNumbersAsPythonWritesIt) {
  for (const char* name : {"rig.xml", "rig.yml"}) {
    CalibrationSettings settings = stereo(name);
    cv::FileStorage out(settings.file.string(), cv::FileStorage::WRITE);
    const cv::Mat_<double> left(cv::Matx33d(530, 0, 320.5, 0, 531, 240.25, 0, 0, 1));
    out << "camera_matrix" << left << "dist_coeffs" << cv::Mat_<double>::zeros(1, 5);
    out << "image_size" << cv::Mat_<int>(cv::Matx<int, 2, 1>(640, 480));
    out.release();
    const Camera camera = load_calibration(settings).at(0);
    EXPECT_EQ(camera.width, 640) << name;
    EXPECT_EQ(camera.height, 480);
  }
}

TEST_F(OpenCvXml, OfOlderProgramsHasLargeLettersInItsNames) {
  const std::string text =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_Width>640</image_Width>\n"
      "<image_Height>480</image_Height>\n<Camera_Matrix type_id=\"opencv-matrix\">\n"
      "<rows>3</rows><cols>3</cols><dt>d</dt><data>\n530. 0. 320. 0. 530. 240. 0. 0. 1.</data>"
      "</Camera_Matrix>\n<Distortion_Coefficients type_id=\"opencv-matrix\"><rows>5</rows>"
      "<cols>1</cols><dt>d</dt><data>-.1 0.02 0. 0. 0.</data></Distortion_Coefficients>\n"
      "</opencv_storage>\n";
  std::vector<std::string> notes;
  const Camera camera = load_calibration(file("one.xml", text), {}, &notes).at(0);
  EXPECT_EQ(camera.fx, 530);
  EXPECT_EQ(camera.height, 480);
  EXPECT_THAT(camera.distortion, ElementsAre(-0.1, 0.02, 0, 0, 0));
  EXPECT_THAT(notes, IsEmpty());
}

TEST_F(OpenCvXml, AFileOfMatlabIsRefusedWithTheWayToOpenCv) {
  const std::string text = "MATLAB 5.0 MAT-file, Platform: GLNXA64" + std::string(90, '\0');
  EXPECT_THAT(loading(file("stereo.mat", text)),
              ThrowsMessage<DataError>(AllOf(HasSubstr("stereo.mat: is a file of MATLAB"),
                                             HasSubstr("stereoParametersToOpenCV"))));
}

TEST_F(OpenCvXml, DamageEndsInOneMessage) {
  EXPECT_THAT(loading(file("a.xml", "<opencv_storage>\n<M1><rows>3</rows>\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("a.xml:"), HasSubstr("XML is damaged"))));
  std::string deep = "<opencv_storage>";
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(loading(file("a.xml", deep)),
              ThrowsMessage<DataError>(HasSubstr("nested deeper than 32 levels")));
  EXPECT_THAT(loading(file("a.xml", "<opencv_storage><M1>7</M1></opencv_storage>")),
              ThrowsMessage<DataError>(HasSubstr("the camera matrix")));
  EXPECT_THAT(
      loading(file("a.xml", "<calibration><projection>frame</projection></calibration>")),
      ThrowsMessage<DataError>(HasSubstr("has no <opencv_storage>; expected YAML, JSON or")));
}

}  // namespace
}  // namespace hypotrack
