#include "hypotrack/api/tables.hpp"

#include <gmock/gmock.h>

#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using ::testing::EndsWith;

class Tables : public ::testing::Test {
 protected:
  const Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  const std::vector<Solution> solutions_ = test::random_solutions(scene_, 2);
  test::OutputRun run_{scene_};
};

TEST_F(Tables, KeepTheStampsOfTheRecordingToTheLastDigit) {
  run_.stamp = 1403636579763555584;
  run_.play("type: tables", solutions_);
  const auto lines = run_.lines("track.csv");
  EXPECT_THAT(lines,
              ::testing::ElementsAre(EndsWith(",stamp,fault"), EndsWith(",1403636579.763555584,"),
                                     EndsWith(",1403636579.763555585,")));
  const std::vector<StateRow> rows = read_states(run_.file("track.csv"), scene_);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].time, solutions_[1].time);
}

TEST_F(Tables, LeaveTheStampEmptyWhereARecordingHasNone) {
  run_.play("type: tables", solutions_);
  EXPECT_THAT(run_.lines("track.csv").at(1), EndsWith(",,"));
  EXPECT_EQ(read_states(run_.file("track.csv"), scene_).size(), 2u);
}

TEST_F(Tables, NameHiddenLandmarks) {
  std::vector<Solution> solutions = solutions_;
  solutions[1].hidden.assign(scene_.landmark_names().size(), false);
  solutions[1].hidden[0] = solutions[1].hidden[1] = true;
  run_.play("type: tables", solutions);
  const std::string names = scene_.landmark_names()[0] + " " + scene_.landmark_names()[1];
  EXPECT_THAT(run_.lines("track.csv"),
              ::testing::ElementsAre(EndsWith(",hidden,stamp,fault"), EndsWith(",,,"),
                                     EndsWith("," + names + ",,")));
  EXPECT_EQ(read_states(run_.file("track.csv"), scene_).size(), 2u);
}

}  // namespace
}  // namespace hypotrack
