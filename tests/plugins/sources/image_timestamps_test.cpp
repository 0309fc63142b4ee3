#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ImageTimestamps : public test::SourceFixture {
 protected:
  void write_pictures(const std::string& folder, const std::vector<std::string>& names, int view) {
    std::filesystem::create_directories(file(folder));
    for (std::size_t i = 0; i < names.size(); ++i)
      write_image(file(folder + "/" + names[i] + ".png").string(),
                  picture(static_cast<int>(i), view));
  }
  /// Pairs left_0000.png, right_0000.png and so on.
  void write_pairs(int count) {
    for (int i = 0; i < count; ++i)
      for (int v = 0; v < 2; ++v)
        write_image(file(cv::format("%s_%04d.png", v ? "right" : "left", i)).string(),
                    picture(i, v));
  }
  static std::string numbered(const std::string& timestamps) {
    return "type: image_sequence\nleft: left_%04d.png\nright: right_%04d.png\n"
           "calibration: {file: rig.yml}\ntimestamps: {" +
           timestamps + "}\n";
  }
  static std::string named(const std::string& more = "") {
    return "type: image_sequence\nleft: cam0/*.png\nright: cam1/*.png\n"
           "calibration: {file: rig.yml}\ntimestamps: {from: names, unit: ns" +
           more + "}\n";
  }
  /// Three frames with these lines in times.csv.
  auto reading(const std::string& text, const std::string& settings = "unit: s") {
    return [this, text, settings] {
      write("times.csv", text);
      make(numbered("file: times.csv, " + settings));
    };
  }
  auto making(const std::string& yaml) {
    return [this, yaml] { make(yaml); };
  }
  static std::vector<double> times(Source& source) {
    std::vector<double> out;
    while (const auto frame = source.next()) out.push_back(frame->time);
    return out;
  }
};

TEST_F(ImageTimestamps, GiveAGapTheLengthThatItHad) {
  write_pairs(4);
  write("times.txt", "# seconds\n100.0\n100.05\n100.45\n\n100.5\n");
  const auto source = make(numbered("file: times.txt, unit: s"));
  EXPECT_NEAR(source->frame_rate(), 20, 1e-9);
  EXPECT_THAT(times(*source),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.05, 0.45, 0.5}));
}

TEST_F(ImageTimestamps, AreReadFromTheColumnOfATable) {
  write_pairs(3);
  write("times.csv", "frame,time [us] ,x\r\n0,1000,9\r\n1,34333,9\r\n2,67667,9\r\n");
  const auto source = make(numbered("file: times.csv, column: 'time [us]', unit: us"));
  EXPECT_THAT(times(*source),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.033333, 0.066667}));
  write("euroc.csv",
        "#timestamp [ns],filename\n1403636579763555584,a\n1403636579813555456,b\n"
        "1403636579863555584,c\n");
  const auto euroc = make(numbered("file: euroc.csv, column: 'timestamp [ns]', unit: ns"));
  EXPECT_THAT(times(*euroc), testing::ElementsAre(0, 0.049999872, 0.1));
}

TEST_F(ImageTimestamps, AreExactToTheNanosecondHoweverTheyAreWritten) {
  write_pairs(3);
  write("times.txt", "1.403636579763555584e+18\n1403636579813555456\n1403636579863555584.0\n");
  EXPECT_THAT(times(*make(numbered("file: times.txt, unit: ns"))),
              testing::ElementsAre(0, 0.049999872, 0.1));
  write("times.txt", "1403636579.763555584\n1403636579.813555456\n1403636579.863555584\n");
  EXPECT_THAT(times(*make(numbered("file: times.txt, unit: s"))),
              testing::ElementsAre(0, 0.049999872, 0.1));
}

TEST_F(ImageTimestamps, OfAFileBelongToTheImagesWhateverIsSelected) {
  write_pairs(6);
  std::filesystem::remove(file("left_0003.png"));
  std::filesystem::remove(file("right_0003.png"));
  write("times.txt", "0\n0.1\n0.2\n0.3\n0.5\n0.9\n");
  const std::string yaml = numbered("file: times.txt, unit: s");
  const auto source = make(yaml + "start: 1\nstep: 2\n");
  EXPECT_THAT(times(*source), testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.8}));
  EXPECT_THAT(making(yaml + "start: 2\ncount: 5\n"),
              ThrowsMessage<DataError>(HasSubstr("times.txt: has no time for image 6; expected")));
  std::filesystem::remove(file("left_0005.png"));
  EXPECT_EQ(make(yaml)->frame_count(), 6) << "the right picture is there";
  std::filesystem::remove(file("right_0005.png"));
  EXPECT_THAT(making(yaml),
              ThrowsMessage<DataError>(HasSubstr("has 6 times; expected 5, one for each image from "
                                                 "number 0 to 4, missing numbers included")));
}

TEST_F(ImageTimestamps, SayWhichLineIsWrong) {
  write_pairs(3);
  EXPECT_NO_THROW(reading("1\n2\n3\n")());
  EXPECT_THAT(reading("1\n2\n1.5\n"),
              ThrowsMessage<DataError>(
                  HasSubstr("times.csv:3: the time 1.5 is 0.5 s before that of line 2; expected")));
  EXPECT_THAT(reading("1\n\n2\n2\n"),
              ThrowsMessage<DataError>(
                  HasSubstr("times.csv:4: the time 2 is that of line 3, too; expected one line")));
  EXPECT_THAT(reading("1\n2\n"), ThrowsMessage<DataError>(HasSubstr("has 2 times; expected 3")));
  EXPECT_THAT(reading("1\n2\n3\n4\n"), ThrowsMessage<DataError>(HasSubstr("has 4 times;")));
  EXPECT_THAT(reading("1\nnan\n3\n"),
              ThrowsMessage<DataError>(HasSubstr("times.csv:2: 'nan' is no time; expected")));
  for (const char* far : {"1e30", "1e999", "inf", "-9e9"})
    EXPECT_THAT(reading(std::string(far) + "\n2\n3\n"),
                ThrowsMessage<DataError>(HasSubstr(" s is out of range; expected less than")))
        << far;
  EXPECT_THAT(reading("1\n2 ms\n3\n"), ThrowsMessage<DataError>(HasSubstr("'2 ms' is no time")));
  EXPECT_THAT(reading(""), ThrowsMessage<DataError>(HasSubstr("times.csv: is empty")));
  EXPECT_THAT(reading("# nothing\n"), ThrowsMessage<DataError>(HasSubstr("has no time")));
  EXPECT_THAT(reading(std::string("1\n\0\n", 4)), ThrowsMessage<DataError>(HasSubstr("no text")));
  EXPECT_THAT(making(numbered("file: none.csv, unit: s")),
              ThrowsMessage<DataError>(HasSubstr("none.csv: there is no such file")));
}

TEST_F(ImageTimestamps, SayWhichColumnIsWrong) {
  write_pairs(3);
  const std::string table = "frame,time\n0,1\n1,2\n2,3\n";
  EXPECT_NO_THROW(reading(table, "column: time, unit: s")());
  EXPECT_THAT(reading(table), ThrowsMessage<DataError>(
                                  AllOf(HasSubstr("times.csv:1: 'frame,time' is no number alone"),
                                        HasSubstr("timestamps.column"))));
  EXPECT_THAT(
      reading(table, "column: tine, unit: s"),
      ThrowsMessage<DataError>(HasSubstr("times.csv:1: there is no column 'tine'; expected one of "
                                         "frame, time; did you mean 'time'?")));
  EXPECT_THAT(reading("frame,time\n0,1\n1\n", "column: time, unit: s"),
              ThrowsMessage<DataError>(
                  HasSubstr("times.csv:3: has 1 columns; expected 'time' in column 2")));
  EXPECT_THAT(reading("frame,time\n0,1\n1,\n", "column: time, unit: s"),
              ThrowsMessage<DataError>(HasSubstr("times.csv:3: '' is no time")));
}

TEST_F(ImageTimestamps, AreNotCutAtDecimalCommas) {
  write_pairs(3);
  EXPECT_THAT(reading("frame;time\n0;1,25\n1;2,5\n2;4,75\n", "column: time, unit: s"),
              ThrowsMessage<DataError>(HasSubstr("times.csv:2: '1,25' is no time")));
  EXPECT_THAT(reading("time\n1,25\n2,5\n4,75\n", "column: time, unit: s"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("times.csv:2: has 2 columns, its header 1"),
                                             HasSubstr("write numbers with a point"))));
  EXPECT_NO_THROW(reading("a,time\n\"0\",1,\n1,2,\n2,3,\n", "column: time, unit: s")());
}

TEST_F(ImageTimestamps, SayThatTheUnitIsWrong) {
  write_pairs(3);
  EXPECT_THAT(reading("0\n33\n66\n"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("times.csv: the images are 33 s apart"),
                                             HasSubstr("is `unit: s` right?"),
                                             HasSubstr("With `unit: ms` it is 30.3."))));
  EXPECT_THAT(reading("0\n0.033\n0.066\n", "unit: ms"),
              ThrowsMessage<DataError>(HasSubstr("With `unit: s` it is 30.3.")));
  EXPECT_THAT(reading("0\n1\n2\n", "unit: min"), ThrowsMessage<ConfigError>(HasSubstr("'min'")));
}

TEST_F(ImageTimestamps, RefuseSettingsThatDoNotGoTogether) {
  write_pairs(3);
  write("times.csv", "0\n1\n2\n");
  const auto refuses = [&](const std::string& settings, const char* why) {
    EXPECT_THAT(making(numbered(settings)),
                ThrowsMessage<ConfigError>(AllOf(HasSubstr("scene.yaml:"), HasSubstr(why))))
        << settings;
  };
  refuses("file: times.csv", "no unit is given; expected `unit`: s, ms, us or ns");
  refuses("unit: s", "nothing says where the times are");
  refuses("file: times.csv, from: names, unit: s", "a file is given together with `from: names`");
  refuses("from: names, column: a, unit: s", "`column` is given with `from: names`");
  refuses("file: times.csv, tolerance_ms: 2, unit: s", "`tolerance_ms` is given with a file");
  EXPECT_THAT(
      making(numbered("file: times.csv, unit: s") + "frame_rate: 30\n"),
      ThrowsMessage<ConfigError>(HasSubstr("frame_rate is given together with timestamps")));
}

TEST_F(ImageTimestamps, InNamesPairPicturesAndMakeFramesOfTheRest) {
  write_pictures("cam0", {"1403636579763555584", "1403636579813555456", "1403636579863555584"}, 0);
  write_pictures("cam1", {"1403636579763555584", "1403636579863555584", "1403636580263555584"}, 1);
  const auto source = make(named());
  EXPECT_EQ(source->frame_count(), 4);
  const auto first = source->next();
  EXPECT_EQ(first->problem, "");
  EXPECT_EQ(first->time, 0);
  const auto second = source->next();
  EXPECT_THAT(second->problem, HasSubstr("cam1/1403636579813555456.png: is missing"));
  EXPECT_TRUE(second->views.empty());
  EXPECT_EQ(second->time, 0.049999872);
  const auto third = source->next();
  EXPECT_EQ(third->problem, "");
  EXPECT_EQ(cv::norm(third->views[0].color, picture(2, 0), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(third->views[1].color, picture(1, 1), cv::NORM_INF), 0);
  const auto last = source->next();
  EXPECT_THAT(last->problem, HasSubstr("cam0/1403636580263555584.png: is missing"));
  EXPECT_EQ(last->time, 0.5);
  EXPECT_FALSE(source->next());
}

TEST_F(ImageTimestamps, InNamesThatDifferPairTheNearestWithinATolerance) {
  write_pictures("cam0", {"1000000000", "1050000000", "1100000000"}, 0);
  write_pictures("cam1", {"1001000000", "1051500000", "1140000000"}, 1);
  EXPECT_THAT(making(named()),
              ThrowsMessage<DataError>(AllOf(HasSubstr("have no two images within 0 ms"),
                                             HasSubstr("1.5 ms apart in the median"),
                                             HasSubstr("timestamps.tolerance_ms"))));
  const auto source = make(named(", tolerance_ms: 2"));
  EXPECT_EQ(source->frame_count(), 4);
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_THAT(source->next()->problem, HasSubstr("cam1/1100000000.png: is missing"));
  EXPECT_THAT(source->next()->problem, HasSubstr("cam0/1140000000.png: is missing"));
}

TEST_F(ImageTimestamps, InNamesSortByTimeAndMayHaveFractions) {
  calibrate(64, 48, 1);
  for (const char* name : {"l_9.95.png", "l_10.png", "l_10.05.png"})
    write_image(file(name).string(), picture(0, 0));
  const std::string yaml =
      "type: image_sequence\nleft: l_*.png\ncalibration: {file: rig.yml}\n"
      "timestamps: {from: names, unit: s}\n";
  EXPECT_THAT(times(*make(yaml)), testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.05, 0.1}));
  EXPECT_THAT(times(*make(yaml + "start: 1\n")),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.05}));
  EXPECT_THAT(making(yaml + "start: 3\n"),
              ThrowsMessage<DataError>(HasSubstr("expected more than `start: 3`")));
  write_image(file("l_10.0.png").string(), picture(0, 0));
  EXPECT_THAT(making(yaml), ThrowsMessage<DataError>(HasSubstr("have the same time")));
}

TEST_F(ImageTimestamps, InNamesMustBeThere) {
  write_pictures("cam0", {"1000000000", "1050000000"}, 0);
  EXPECT_THAT(making(named()),
              ThrowsMessage<DataError>(HasSubstr("find 2 and 0 images; expected some of both")));
  write_pictures("cam1", {"1000000000", "first"}, 1);
  EXPECT_THAT(making(named()),
              ThrowsMessage<DataError>(HasSubstr("first.png: 'first' is no time; expected")));
  const std::string numbers = numbered("from: names, unit: ns");
  EXPECT_THAT(making(numbers), ThrowsMessage<DataError>(
                                   AllOf(HasSubstr("left_%04d.png"), HasSubstr("expected one *"))));
}

TEST_F(ImageTimestamps, StayWithTheirFramesToTheLastNanosecond) {
  const std::vector<std::string> names{"1403636579763555584", "1403636579813555457"};
  write_pictures("cam0", names, 0);
  write_pictures("cam1", names, 1);
  auto source = make(named());
  for (const std::string& name : names) EXPECT_EQ(source->next()->stamp, std::stoll(name));
  write_pairs(2);
  write("times.txt", "1403636579.763555584\n1403636579.813555457\n");
  source = make(numbered("file: times.txt, unit: s"));
  for (const std::string& name : names) EXPECT_EQ(source->next()->stamp, std::stoll(name));
  source = make(
      "type: image_sequence\nleft: left_%04d.png\nright: right_%04d.png\n"
      "calibration: {file: rig.yml}\n");
  EXPECT_FALSE(source->next()->stamp);
}

TEST_F(ImageTimestamps, InNamesThatAreNotReadAreTold) {
  const auto notes = [&](const std::vector<std::string>& names) {
    std::filesystem::remove_all(file("cam0"));
    write_pictures("cam0", names, 0);
    calibrate(64, 48, 1);
    return make("type: image_sequence\nleft: cam0/*.png\ncalibration: {file: rig.yml}\n")->notes();
  };
  EXPECT_THAT(notes({"1403636579763555584", "1403636579813555584"}),
              testing::ElementsAre(AllOf(HasSubstr("1403636579763555584.png: the name looks like a "
                                                   "time"),
                                         HasSubstr("`timestamps: {from: names, unit: ns}`"))));
  EXPECT_THAT(notes({"left_1403636579763555", "left_1403636579813555"}),
              testing::ElementsAre(HasSubstr("unit: us}")));
  EXPECT_THAT(notes({"1403636579763", "1403636579813"}),
              testing::ElementsAre(HasSubstr("unit: ms}")));
  EXPECT_THAT(notes({"1305031102.175304", "1305031102.211214"}),
              testing::ElementsAre(HasSubstr("unit: s}")));
  EXPECT_THAT(notes({"000001", "000002"}), testing::IsEmpty());
  EXPECT_THAT(notes({"0000000001", "0000000002"}), testing::IsEmpty());
}

}  // namespace
}  // namespace hypotrack
