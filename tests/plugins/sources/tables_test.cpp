#include "hypotrack/api/tables.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/truth.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

Scene box_scene() { return Scene({{"box", std::make_shared<Model>(test::make_test_box())}}); }
Scene two_boxes() {
  return Scene({{"a", std::make_shared<Model>(test::make_test_box())},
                {"b", std::make_shared<Model>(test::make_test_box())}});
}

class Tables : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    return file_;
  }
  test::TemporaryDirectory folder_;
  std::filesystem::path file_ = folder_.path() / "table.csv";
};

const std::string kHeader =
    "box.position_x,box.position_y,box.position_z,box.rotation_w,box.rotation_x,box.rotation_y,"
    "box.rotation_z";

TEST_F(Tables, ReadStatesBack) {
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  std::mt19937_64 random(1);
  std::vector<StateRow> rows;
  for (int i = 0; i < 20; ++i) {
    StateRow row{3 * i, i / 29.97, test::random_state(scene, random)};
    scene.normalize(row.state);
    rows.push_back(row);
  }
  write_states(file_, scene, rows);
  const std::vector<StateRow> read = read_states(file_, scene);
  ASSERT_EQ(read.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(read[i].frame, rows[i].frame);
    EXPECT_EQ(read[i].time, rows[i].time);
    // Reading normalises quaternions once more, which may turn a last bit.
    EXPECT_LT((read[i].state - rows[i].state).cwiseAbs().maxCoeff(), 4e-16);
    EXPECT_EQ(read[i].state.head(3), rows[i].state.head(3));
    EXPECT_EQ(read[i].state.tail(20), rows[i].state.tail(20));
  }
}

TEST_F(Tables, ReadLandmarksBackBitForBit) {
  const Scene scene = two_boxes();
  std::mt19937_64 random(2);
  std::vector<LandmarkRow> rows;
  for (int i = 0; i < 5; ++i) {
    rows.push_back({i, i / 30.0, scene.landmarks(test::random_state(scene, random))});
  }
  rows[2].landmarks.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  write_landmarks(file_, scene.landmark_names(), rows);
  const std::vector<LandmarkRow> read = read_landmarks(file_, scene.landmark_names());
  ASSERT_EQ(read.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(read[i].landmarks.size(), rows[i].landmarks.size());
    for (Eigen::Index k = 0; k < rows[i].landmarks.size(); ++k) {
      const double expected = rows[i].landmarks.data()[k];
      const double found = read[i].landmarks.data()[k];
      EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected)));
    }
  }
}

TEST_F(Tables, CarryTheAbsenceOfAModel) {
  const Scene scene = two_boxes();
  std::vector<LandmarkRow> rows;
  for (int i = 0; i < 3; ++i) rows.push_back({i, 0, scene.landmarks(scene.rest_state())});
  rows[1].landmarks.rightCols(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  rows[1].absent = {false, false, false, true, true, true};
  rows[2].landmarks.rightCols(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  write_landmarks(file_, scene.landmark_names(), rows);
  TruthSettings settings;
  settings.landmarks = file_;
  const TruthTables truth(settings, scene);
  EXPECT_TRUE(truth.at(0)->absent.empty());
  EXPECT_EQ(truth.at(1)->absent, (std::vector<bool>{false, true}));
  EXPECT_TRUE(truth.at(1)->landmarks.rightCols(3).array().isNaN().all());
  EXPECT_TRUE(truth.at(2)->absent.empty()) << "unknown is not absent";
}

TEST_F(Tables, AreAbsentInAllThreeCoordinatesOrNone) {
  const Scene scene = box_scene();
  const std::string name = scene.landmark_names()[0];
  write(name + "_x," + name + "_y," + name + "_z\nabsent,0,absent\n");
  EXPECT_THAT([&] { read_landmarks(file_, scene.landmark_names()); },
              ThrowsMessage<DataError>(HasSubstr("holds 'absent'; expected a number")));
}

TEST_F(Tables, DoNotMindOrderCommentsQuotesAndLineEnds) {
  const Scene scene = box_scene();
  write(
      "\xEF\xBB\xBF# made by hand\r\n\r\nrotation_w,\"rotation_x\", rotation_y ,rotation_z,status,"
      "position_z,position_x,position_y,frame\r\n"
      "2,0,0,0,accepted,0.7,+0.1,-.2,5\r\n# more\r\n1,0,0,0,lost,0.8,0.1,-0.2,3");
  const std::vector<StateRow> rows = read_states(file_, scene);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].frame, 3);
  EXPECT_EQ(rows[1].frame, 5);
  EXPECT_EQ(rows[1].time, 0);
  Eigen::VectorXd expected(7);
  expected << 0.1, -0.2, 0.7, 1, 0, 0, 0;
  EXPECT_TRUE(rows[1].state.isApprox(expected, 1e-15)) << rows[1].state.transpose();
}

TEST_F(Tables, NumberRowsWithoutAFrameColumn) {
  const Scene scene = box_scene();
  write(kHeader + "\n0,0,1,1,0,0,0\n0,0,2,1,0,0,0\n");
  const std::vector<StateRow> rows = read_states(file_, scene);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].frame, 1);
}

TEST_F(Tables, SayWhatIsWrongAndWhere) {
  const Scene scene = box_scene();
  const auto reading = [&](const std::string& text) {
    write(text);
    return [&] { read_states(file_, scene); };
  };
  const auto error = [](const char* part) { return ThrowsMessage<DataError>(HasSubstr(part)); };
  EXPECT_THAT(reading(""), error("table.csv: is empty"));
  EXPECT_THAT(reading(kHeader + "\n0,0,1,1,0,0\n"), error("table.csv:2: has 6 cells; expected 7"));
  EXPECT_THAT(reading(kHeader + "\n\n0,x,1,1,0,0,0\n"),
              error("table.csv:3: column 'box.position_y' holds 'x'; expected a number"));
  EXPECT_THAT(reading(kHeader + "\n0,,1,1,0,0,0\n"), error("holds ''; expected a number"));
  EXPECT_THAT(reading(kHeader + "\n0,nan,1,1,0,0,0\n"), error("expected a finite number"));
  EXPECT_THAT(reading(kHeader + "\n0,1e308,1,1,0,0,0\n"),
              error("'box.position_y' is 1e+308; expected a finite number, 1e+06 at most"));
  EXPECT_THAT(reading(kHeader + "\n0,0,1,0,0,0,0\n"),
              error("table.csv:2: the rotation of 'box' has the length 0"));
  EXPECT_THAT(reading(kHeader + ",frame\n0,0,1,1,0,0,0,1.5\n"), error("the frame number is 1.5"));
  EXPECT_THAT(reading(kHeader + ",frame\n0,0,1,1,0,0,0,-1\n"), error("the frame number is -1"));
  EXPECT_THAT(reading(kHeader + ",frame\n0,0,1,1,0,0,0,1\n0,0,1,1,0,0,0,1\n"),
              error("table.csv:3: frame 1 is there a second time; the first is on line 2"));
  EXPECT_THAT(reading(kHeader + ",a,a\n"), error("the column 'a' is there twice"));
  EXPECT_THAT(reading(kHeader + ",\n"), error("a column has no name"));
  EXPECT_THAT(reading(kHeader + ",time\n0,0,1,1,0,0,0,inf\n"), error("the time is inf"));
  EXPECT_THAT(reading("box.position_x,box.positoin_y\n"),
              error("has no column 'box.position_y'; a table of states has one for each of the "
                    "scene's 7 parameters; did you mean 'box.positoin_y'?"));
  EXPECT_THAT(reading(std::string("a,b\n\0,1\n", 8)), error("NUL character"));
  EXPECT_THAT([&] { read_states(folder_.path() / "none.csv", scene); }, error("no such file"));
  EXPECT_THAT([&] { read_states(folder_.path(), scene); }, error("is a folder"));
}

TEST_F(Tables, HoldNoLandmarkFartherThanAModelIsDrawn) {
  write("a_x,a_y,a_z\n0,0,1\n0,-1e308,1\n");
  const std::vector<std::string> names{"a"};
  EXPECT_THAT([&] { read_landmarks(file_, names); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("table.csv:3: 'a' is (0, -1e+308, 1)"),
                                             HasSubstr("metres up to 1e+06"))));
}

TEST_F(Tables, DoNotGuessWhichModelAShortNameMeans) {
  write("position_x\n0\n");
  EXPECT_THAT([&] { read_states(file_, two_boxes()); },
              ThrowsMessage<DataError>(HasSubstr("has no column 'a.position_x'")));
}

TEST_F(Tables, ConvertRenameAndDropLandmarks) {
  const std::vector<std::string> names = {"hand.wrist", "hand.index_mcp", "hand.index_tip"};
  write(
      "palm_x,palm_y,palm_z,index_mcp_x,index_mcp_y,index_mcp_z,finger2_x,finger2_y,finger2_z\n"
      "1,2,3,10,20,30,100,,300\n");
  const LandmarkTableOptions options = {.metres_per_unit = 1e-3,
                                        .rename = {"palm=", "finger2=index_tip"}};
  const std::vector<LandmarkRow> rows = read_landmarks(file_, names, options);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].landmarks.col(0).array().isNaN().all());
  EXPECT_TRUE(rows[0].landmarks.col(1).isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-15));
  EXPECT_TRUE(rows[0].landmarks.col(2).array().isNaN().all()) << "one unknown axis, no point";

  const auto reading = [&](std::vector<std::string> rename) {
    return [&, rename] { read_landmarks(file_, names, {.rename = rename}); };
  };
  EXPECT_THAT(reading({}),
              ThrowsMessage<DataError>(HasSubstr("'palm' is no landmark of the scene; rename it")));
  EXPECT_THAT(reading({"palm=", "finger2=hand.index_tipp"}),
              ThrowsMessage<DataError>(HasSubstr("did you mean 'hand.index_tip'?")));
  EXPECT_THAT(reading({"palm=index_mcp", "finger2="}),
              ThrowsMessage<DataError>(HasSubstr("the landmark 'hand.index_mcp' is there twice")));
  EXPECT_THAT(reading({"palm=", "fingr2=index_tip"}),
              ThrowsMessage<DataError>(AllOf(HasSubstr("no landmark 'fingr2' that the renaming"),
                                             HasSubstr("did you mean 'finger2'?"))));
  EXPECT_THAT(reading({"palm"}), ThrowsMessage<DataError>(HasSubstr("'palm' is not understood")));
  write("index_mcp_x,index_mcp_y\n1,2\n");
  EXPECT_THAT(reading({}),
              ThrowsMessage<DataError>(HasSubstr("'index_mcp_x' belongs to no landmark")));
}

TEST_F(Tables, AreWrittenWholeOrNotAtAll) {
  const Scene scene = box_scene();
  const std::filesystem::path nowhere = folder_.path() / "missing" / "states.csv";
  EXPECT_THAT([&] { write_states(nowhere, scene, {}); },
              ThrowsMessage<OutputError>(HasSubstr("states.csv: cannot be written")));
  write_states(file_, scene, {});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
  EXPECT_TRUE(read_states(file_, scene).empty());
}

TEST_F(Tables, EndWithAnErrorOrFiniteStatesWhateverBytesAreDamaged) {
  const Scene scene = box_scene();
  const std::string text = "frame,time," + kHeader +
                           "\n0,0,0.1,-0.2,0.7,1,0,0,0\n1,0.033,0.1,-0.25,0.7,0.5,0.5,0.5,0.5\n";
  std::mt19937 random(13);
  int refused = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::string damaged = text;
    const unsigned damages = 1 + static_cast<unsigned>(random() % 3);
    for (unsigned i = 0; i < damages; ++i) {
      const std::size_t at = random() % damaged.size();
      if (random() % 2) {
        damaged[at] = static_cast<char>(random() % 256);
      } else {
        damaged.erase(at, random() % 5);
      }
    }
    write(damaged);
    try {
      for (const StateRow& row : read_states(file_, scene)) {
        EXPECT_TRUE(row.state.allFinite()) << damaged;
        EXPECT_NEAR(row.state.segment<4>(3).norm(), 1, 1e-9) << damaged;
      }
    } catch (const DataError& e) {
      ++refused;
      EXPECT_THAT(e.what(), HasSubstr("table.csv")) << damaged;
    }
  }
  EXPECT_GT(refused, 300);
}

TEST_F(Tables, TellASourceTheAnswerFrameByFrame) {
  const Scene scene = box_scene();
  write(kHeader + ",frame\n0,0,1,1,0,0,0,100\n0,0,2,1,0,0,0,102\n");
  TruthSettings settings;
  settings.states = file_;
  settings.offset = 90;
  const TruthTables truth(settings, scene);
  ASSERT_TRUE(truth.at(10));
  EXPECT_EQ(truth.at(10)->state[2], 1);
  EXPECT_EQ(truth.at(10)->landmarks.size(), 0);
  EXPECT_FALSE(truth.at(11));
  EXPECT_EQ(truth.at(12)->state[2], 2);
  EXPECT_FALSE(TruthTables().at(0));
}

TEST_F(Tables, OfAnotherRecordingAreNoAnswer) {
  const Scene scene = box_scene();
  write(kHeader + ",frame\n0,0,1,1,0,0,0,100\n0,0,2,1,0,0,0,102\n");
  TruthSettings settings;
  settings.states = file_;
  settings.offset = 90;
  const TruthTables truth(settings, scene);
  EXPECT_NO_THROW(truth.expect_some(10, 1, 1));
  EXPECT_NO_THROW(truth.expect_some(6, 3, 3));
  EXPECT_NO_THROW(truth.expect_some(0, 1, std::nullopt));
  EXPECT_NO_THROW(TruthTables().expect_some(0, 1, 5));
  const auto refused = [&](int first, int step, std::optional<int> count, const char* frames) {
    EXPECT_THAT(
        [&] { truth.expect_some(first, step, count); },
        ThrowsMessage<DataError>(file_.string() +
                                 ": has frames 100 to 102, and none of them is one of the "
                                 "source's frames, " +
                                 frames + "; set truth_offset (now 90), or leave the key out"));
  };
  refused(0, 1, 10, "90 to 99");
  refused(13, 1, 10, "103 to 112");
  refused(7, 2, 3, "97 to 101 in steps of 2");
  refused(13, 1, std::nullopt, "103 on");
}

TEST_F(Tables, WithoutANumberAreNoAnswer) {
  const Scene scene = box_scene();
  TruthSettings settings;
  settings.landmarks = file_;
  const auto expect_some = [&] { TruthTables(settings, scene).expect_some(0, 1, 2); };
  const std::string name = scene.landmark_names()[0];
  const std::string header = "frame," + name + "_x," + name + "_y," + name + "_z\n";
  write(header + "0,1,2,3\n");
  EXPECT_NO_THROW(expect_some());
  write(header + "0,nan,nan,nan\n1,nan,nan,nan\n2,1,2,3\n");
  EXPECT_THAT(expect_some, ThrowsMessage<DataError>(AllOf(
                               HasSubstr(file_.string() + ": no landmark is known in any of the"),
                               HasSubstr("<landmark>_x"))));
  write("frame,time\n0,0\n1,0\n");
  EXPECT_THAT(expect_some, ThrowsMessage<DataError>(HasSubstr("no landmark is known")));
  write(header);
  EXPECT_THAT(expect_some, ThrowsMessage<DataError>(HasSubstr("has no rows")));
}

}  // namespace
}  // namespace hypotrack
