#include <gmock/gmock.h>

#include <random>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/tables.hpp"
#include "oriented_pictures.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Rgbd : public test::SourceFixture {
 protected:
  Rgbd() { calibrate(64, 48, 1); }

  /// Writes an image pair and its lines of the lists; a time below 0 leaves one out.
  void add(int number, double color_time, double depth_time) {
    if (color_time >= 0) {
      const std::string name = cv::format("rgb/%d.png", number);
      std::filesystem::create_directory(file("rgb"));
      write_image(file(name).string(), picture(number, 0));
      color_list_ += cv::format("%.4f %s\n", color_time, name.c_str());
    }
    if (depth_time >= 0) {
      const std::string name = cv::format("depth/%d.png", number);
      std::filesystem::create_directory(file("depth"));
      write_image(file(name).string(), cv::Mat(48, 64, CV_16U, cv::Scalar(2500 + 5 * number)));
      depth_list_ += cv::format("%.4f %s\n", depth_time, name.c_str());
    }
    write("rgb.txt", color_list_);
    write("depth.txt", depth_list_);
  }

  static std::string yaml(const std::string& more = "") {
    return "type: rgbd\nfolder: .\ncalibration: {file: rig.yml}\n" + more;
  }
  auto making(const std::string& text) {
    return [this, text] { make(text, &scene_); };
  }

  std::string color_list_ = "# color images\n# timestamp filename\n";
  std::string depth_list_ = "# depth maps\n";
};

TEST_F(Rgbd, PutsTogetherWhatIsNearestInTime) {
  add(0, 1000.00, 1000.01);
  add(1, 1000.05, 1000.04);
  add(2, 1000.10, 1000.10);
  const auto source = make(yaml());
  ASSERT_EQ(source->cameras().size(), 1u);
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_NEAR(source->frame_rate(), 20, 1e-6);
  for (int i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->problem, "");
    EXPECT_EQ(frame->index, i);
    EXPECT_NEAR(frame->time, 0.05 * i, 1e-9);
    ASSERT_EQ(frame->views.size(), 1u);
    EXPECT_EQ(cv::norm(frame->views[0].color, picture(i, 0), cv::NORM_INF), 0);
    ASSERT_EQ(frame->views[0].depth.type(), CV_32FC1);
    EXPECT_NEAR(frame->views[0].depth.at<float>(3, 3), 0.5 + 0.001 * i, 1e-6);
    EXPECT_FALSE(frame->truth);
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST_F(Rgbd, ReportsColourWithoutDepthAndGoesOn) {
  add(0, 1.00, 1.00);
  add(1, 1.03, -1);  // nothing within 0.02 s
  add(2, 1.09, 1.065);
  add(3, 1.11, -1);
  add(4, 1.12, 1.125);  // 3 is within 0.02 s of this depth, but 4 is nearer
  const auto source = make(yaml());
  EXPECT_EQ(source->next()->problem, "");
  const auto gap = source->next();
  EXPECT_TRUE(gap->views.empty());
  EXPECT_THAT(gap->problem, AllOf(HasSubstr("rgb/1.png: no depth image belongs to it"),
                                  HasSubstr("0.03 s away; expected 0.02 s or less")));
  EXPECT_THAT(source->next()->problem, HasSubstr("2.png, is 0.025 s away"));
  EXPECT_THAT(source->next()->problem, HasSubstr("nearer to another colour image"));
  const auto last = source->next();
  EXPECT_EQ(last->problem, "");
  EXPECT_EQ(last->index, 4);
  EXPECT_NEAR(last->time, 0.12, 1e-9);
  const auto tolerant = make(yaml("max_difference_s: 0.04\nstart: 2\ncount: 1\n"));
  EXPECT_EQ(tolerant->frame_count(), 1);
  const auto only = tolerant->next();
  EXPECT_EQ(only->problem, "");
  EXPECT_EQ(only->index, 0);
  EXPECT_EQ(only->time, 0);
  EXPECT_NEAR(only->views[0].depth.at<float>(0, 0), 0.502, 1e-6);
  EXPECT_FALSE(tolerant->next());
}

TEST_F(Rgbd, ReportsImagesThatCannotBeUsedAndGoesOn) {
  for (int i = 0; i < 7; ++i) add(i, i, i);
  std::filesystem::remove(file("rgb/1.png"));
  std::filesystem::remove(file("depth/2.png"));
  write_image(file("depth/3.png").string(), cv::Mat(48, 64, CV_8U, cv::Scalar(9)));
  write_image(file("depth/4.png").string(), cv::Mat(24, 32, CV_16U, cv::Scalar(9)));
  write_image(file("rgb/5.png").string(), picture(0, 0, {32, 24}));
  const auto source = make(yaml());
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_THAT(source->next()->problem, HasSubstr("rgb/1.png: is missing"));
  EXPECT_THAT(source->next()->problem, HasSubstr("depth/2.png: is missing"));
  EXPECT_THAT(source->next()->problem,
              HasSubstr("depth/3.png: has 8-bit pixels of 1 channel; depth is 16 bits"));
  EXPECT_THAT(source->next()->problem,
              HasSubstr("depth/4.png: is 32x24 pixels; expected 64x48 as its camera"));
  EXPECT_THAT(source->next()->problem, HasSubstr("rgb/5.png: is 32x24 pixels"));
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_FALSE(source->next());
}

TEST_F(Rgbd, ReadsListsAsOthersWriteThem) {
  add(0, 1, 1);
  add(1, 2, 2);
  write("rgb.txt", "\xEF\xBB\xBF# from Windows\r\n1.0,rgb/0.png\r\n\r\n 2.0\t rgb/1.png \r\n");
  const auto source = make(yaml("depth_factor: 1000\n"));
  EXPECT_EQ(source->next()->problem, "");
  const auto second = source->next();
  ASSERT_EQ(second->problem, "");
  EXPECT_NEAR(second->views[0].depth.at<float>(0, 0), 2.505, 1e-6);
}

TEST_F(Rgbd, SaysWhatIsWrongWithALine) {
  add(0, 1, 1);
  const auto with_line = [&](const std::string& line) {
    write("rgb.txt", "# color\n" + line + "\n");
    return making(yaml());
  };
  for (const char* line : {"rgb/0.png 1.0", "1.0", "1.0x rgb/0.png", "nan rgb/0.png",
                           "inf rgb/0.png", "1e999 a.png"}) {
    EXPECT_THAT(with_line(line),
                ThrowsMessage<DataError>(
                    AllOf(HasSubstr(std::string("rgb.txt:2: '") + line + "' is not understood"),
                          HasSubstr("expected a time in seconds and a file name"))));
  }
  EXPECT_THAT(with_line("2 rgb/0.png\n1 rgb/0.png"),
              ThrowsMessage<DataError>(
                  HasSubstr("rgb.txt:3: the time 1 follows 2; expected times that ascend")));
  EXPECT_THAT(with_line("1 rgb/0.png\n1 rgb/0.png"),
              ThrowsMessage<DataError>(HasSubstr("the time 1 follows 1")));
  EXPECT_THAT(with_line("# nothing"), ThrowsMessage<DataError>(HasSubstr("names no image")));
  EXPECT_THAT(with_line(std::string("1 a\0b", 5)),
              ThrowsMessage<DataError>(HasSubstr("rgb.txt: is no text")));
}

TEST_F(Rgbd, SaysWhatDoesNotFitTogether) {
  EXPECT_THAT(making(yaml()),
              ThrowsMessage<DataError>(HasSubstr("rgb.txt: there is no such list")));
  add(0, 1, 5);
  EXPECT_THAT(making(yaml()),
              ThrowsMessage<DataError>(AllOf(HasSubstr("have no two images within 0.02 s"),
                                             HasSubstr("0.png, is 4 s away"))));
  add(1, 6, 6);
  EXPECT_THAT(making(yaml("start: 2\n")),
              ThrowsMessage<DataError>(HasSubstr("lists 2 images; expected more than `start: 2`")));
  calibrate(64, 48, 2);
  EXPECT_THAT(making(yaml()), ThrowsMessage<DataError>(HasSubstr("holds 2 cameras; expected one")));
  calibrate(320, 240, 1);
  EXPECT_THAT(making(yaml()), ThrowsMessage<DataError>(HasSubstr("calibrated for 320x240")));
  calibrate(64, 48, 1);
  write_image(file("depth/1.png").string(), cv::Mat(48, 64, CV_8U, cv::Scalar(9)));
  EXPECT_THAT(making(yaml()),
              ThrowsMessage<DataError>(AllOf(HasSubstr("no image can be read"),
                                             HasSubstr("depth/1.png: has 8-bit pixels"))));
  EXPECT_THAT(making("type: rgbd\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(HasSubstr("folder")));
}

TEST_F(Rgbd, KnowsTheAnswerByThePositionInTheColourList) {
  for (int i = 0; i < 3; ++i) add(i, i, i);
  std::vector<StateRow> rows;
  for (int i = 0; i < 3; ++i) {
    Eigen::VectorXd state = scene_.rest_state();
    state[2] = 1 + i;
    rows.push_back({i, 1.0 * i, state});
  }
  write_states(file("states.csv"), scene_, rows);
  const auto source = make(yaml("start: 1\ntruth_states: states.csv\n"), &scene_);
  EXPECT_EQ(source->next()->truth->state[2], 2);
  EXPECT_EQ(source->next()->truth->state[2], 3);
  EXPECT_THAT(making(yaml("start: 1\ntruth_states: states.csv\ntruth_offset: 2\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("states.csv: has frames 0 to 2"),
                                             HasSubstr("the source's frames, 3 to 4;"))));
}

TEST_F(Rgbd, ADamagedListIsRefusedOrReadButNothingElse) {
  for (int i = 0; i < 6; ++i) add(i, 10 + 0.04 * i, 10.001 + 0.04 * i);
  std::mt19937 random(11);
  int read = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string bytes = round % 2 ? color_list_ : depth_list_;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < changes; ++k) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          bytes.erase(at, 1 + random() % 9);
          break;
        case 2:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 30));
          break;
        default:
          bytes.resize(at + 1);
      }
      if (bytes.empty()) bytes = "\n";
    }
    write(round % 2 ? "rgb.txt" : "depth.txt", bytes);
    write(round % 2 ? "depth.txt" : "rgb.txt", round % 2 ? depth_list_ : color_list_);
    try {
      const auto source = make(yaml());
      int frames = 0;
      while (const auto frame = source->next()) {
        ++frames;
        ASSERT_EQ(frame->problem.empty(), frame->views.size() == 1);
      }
      EXPECT_EQ(frames, source->frame_count());
      ++read;
    } catch (const DataError& error) {
      EXPECT_THAT(error.what(), HasSubstr(folder_.path().string()));
      ++refused;
    }
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 20);
}

TEST_F(Rgbd, FramesHaveTheStampsOfTheColourList) {
  add(0, 0, 0);
  add(1, 1, 1);
  write("rgb.txt", "1305031102.175304 rgb/0.png\n1403636579.763555584 rgb/1.png\n");
  write("depth.txt", "1305031102.160407 depth/0.png\n1403636579.763555584 depth/1.png\n");
  const auto source = make(yaml());
  EXPECT_EQ(source->next()->stamp, 1305031102175304000);
  EXPECT_EQ(source->next()->stamp, 1403636579763555584);
}

TEST_F(Rgbd, TurnsColourAndDepthAsViewersDoAndSaysSo) {
  add(0, 1, 1);
  for (const char* name : {"rgb/0.png", "depth/0.png"}) {
    const cv::Mat stored = read_image(file(name).string(), cv::IMREAD_UNCHANGED);
    test::write_bytes(file(name), test::png_with(test::exif(8), test::encoded(".png", stored)));
  }
  calibrate(48, 64, 1);
  const auto source = make(yaml());
  EXPECT_THAT(source->notes(), testing::ElementsAre(HasSubstr("rgb/0.png: its EXIF orientation"),
                                                    HasSubstr("depth/0.png: its EXIF")));
  const auto frame = source->next();
  EXPECT_EQ(frame->problem, "");
  EXPECT_EQ(frame->views[0].color.size(), frame->views[0].depth.size());
}

TEST_F(Rgbd, NamesTheBitsThatColourSeemsToHave) {
  add(0, 1, 1);
  write_image(file("rgb/0.png").string(), cv::Mat(48, 64, CV_16UC3, cv::Scalar::all(1000)));
  EXPECT_THAT(make(yaml())->notes(), testing::ElementsAre(HasSubstr("`bits: 10`")));
  const auto source = make(yaml("bits: 10\n"));
  EXPECT_THAT(source->notes(), testing::IsEmpty());
  EXPECT_EQ(source->next()->views[0].color.at<cv::Vec3b>(0, 0)[0], 249);
}

}  // namespace
}  // namespace hypotrack
