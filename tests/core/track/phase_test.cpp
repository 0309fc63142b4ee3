#include "track/loop/phase.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// The transitions as docs/reference/tracking.md has them. An empty cell: the phase stays.
constexpr const char* kTable = R"(
| phase | found | plausible | denied | departed | learned | forgotten | restarted |
|---|---|---|---|---|---|---|---|
| awaited | begun | begun | | | lost | sought | |
| begun | | | awaited | awaited | followed | tentative | awaited |
| sought | tentative | tentative | | | lost | | |
| tentative | | | sought | sought | followed | | sought |
| followed | | doubted | lost | absent | | tentative | lost |
| doubted | followed | | lost | absent | | tentative | lost |
| lost | followed | doubted | | absent | | sought | |
| absent | followed | doubted | lost | | | sought | lost |
)";

/// Splits a row of a table into its cells.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> out;
  std::istringstream cells(row.substr(1));
  for (std::string cell; std::getline(cells, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(' ');
    out.push_back(first == std::string::npos
                      ? ""
                      : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
  }
  return out;
}

Phase phase(std::size_t i) { return static_cast<Phase>(i); }
std::string name(Phase phase) {
  return std::string(kPhaseNames.at(static_cast<std::size_t>(phase)));
}

/// One transition.
class PhaseCell : public testing::TestWithParam<std::size_t> {};

TEST_P(PhaseCell, IsThatOfTheTable) {
  std::istringstream lines(kTable);
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  const std::vector<std::string> events = cells_of(line);
  std::getline(lines, line);
  const std::size_t from = GetParam() / kPhaseEventNames.size();
  const std::size_t event = GetParam() % kPhaseEventNames.size();
  for (std::size_t row = 0; row <= from; ++row) std::getline(lines, line);
  const std::vector<std::string> cells = cells_of(line);
  ASSERT_EQ(events.size(), 1 + kPhaseEventNames.size());
  ASSERT_EQ(events[1 + event], kPhaseEventNames[event]);
  ASSERT_EQ(cells.at(0), kPhaseNames[from]);
  const std::string expected = cells.at(1 + event).empty() ? cells[0] : cells[1 + event];
  EXPECT_EQ(name(next(phase(from), static_cast<PhaseEvent>(event))), expected);
}

INSTANTIATE_TEST_SUITE_P(All, PhaseCell,
                         testing::Range<std::size_t>(0,
                                                     kPhaseNames.size() * kPhaseEventNames.size()),
                         [](const testing::TestParamInfo<std::size_t>& cell) {
                           const std::size_t events = kPhaseEventNames.size();
                           return std::string(kPhaseNames[cell.param / events]) + "_" +
                                  std::string(kPhaseEventNames[cell.param % events]);
                         });

TEST(Phase, HasTheTableOfTheDocs) {
  const auto path = test::source_dir() / "docs/reference/tracking.md";
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(kTable), std::string::npos) << path;
}

TEST(Phase, FollowsFromTheStatusOfAFrame) {
  EXPECT_EQ(event_of(Status::tracked), PhaseEvent::found);
  EXPECT_EQ(event_of(Status::uncertain), PhaseEvent::plausible);
  EXPECT_EQ(event_of(Status::lost), PhaseEvent::denied);
  EXPECT_EQ(event_of(Status::absent), PhaseEvent::departed);
  EXPECT_THROW(event_of(Status::missing), std::invalid_argument);
}

TEST(Phase, HasAPoseAfterAFrameThatIsTrackedOrUncertainAndAfterNoOther) {
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) {
    EXPECT_TRUE(has_pose(next(phase(i), PhaseEvent::found))) << kPhaseNames[i];
    EXPECT_TRUE(has_pose(next(phase(i), PhaseEvent::plausible))) << kPhaseNames[i];
    EXPECT_FALSE(has_pose(next(phase(i), PhaseEvent::denied))) << kPhaseNames[i];
    EXPECT_FALSE(has_pose(next(phase(i), PhaseEvent::departed))) << kPhaseNames[i];
  }
}

TEST(Phase, KeepsItsPoseWhatIsLearnedOrForgottenAndLosesItWhereTheSearchBeginsAnew) {
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) {
    EXPECT_EQ(has_pose(next(phase(i), PhaseEvent::learned)), has_pose(phase(i))) << kPhaseNames[i];
    EXPECT_EQ(has_pose(next(phase(i), PhaseEvent::forgotten)), has_pose(phase(i)))
        << kPhaseNames[i];
    EXPECT_FALSE(has_pose(next(phase(i), PhaseEvent::restarted))) << kPhaseNames[i];
  }
}

TEST(Phase, NeverReturnsToTheGivenStart) {
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i)
    for (std::size_t e = 0; e < kPhaseEventNames.size(); ++e)
      if (!is_at_start(phase(i))) {
        EXPECT_FALSE(is_at_start(next(phase(i), static_cast<PhaseEvent>(e)))) << kPhaseNames[i];
      }
}

TEST(Phase, IsThatOfAKnownModelOnceItIsLearnedUntilItIsForgotten) {
  const auto is_known = [](Phase one) { return !is_at_start(one) && !is_unknown(one); };
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) {
    EXPECT_TRUE(is_known(next(phase(i), PhaseEvent::learned))) << kPhaseNames[i];
    EXPECT_TRUE(is_unknown(next(phase(i), PhaseEvent::forgotten))) << kPhaseNames[i];
    for (const PhaseEvent judged : {PhaseEvent::found, PhaseEvent::plausible, PhaseEvent::denied,
                                    PhaseEvent::departed, PhaseEvent::restarted})
      EXPECT_EQ(is_known(next(phase(i), judged)), is_known(phase(i))) << kPhaseNames[i];
  }
}

}  // namespace
}  // namespace hypotrack
