#include "plugin/plugin_notes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <thread>
#include <vector>

#include "hypotrack/plugin/plugin_object.hpp"
#include "plugin/running_plugin.hpp"

namespace hypotrack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(PluginNotes, ATextIsALineOnceAndCounted) {
  const auto notes = std::make_shared<PluginNotes>();
  const PluginLog log(notes, "objective.1 (edges)");
  const detail::RunningFrame running(12);
  for (int i = 0; i < 1000; ++i) log.note("few edges");
  log.warning("none");
  EXPECT_THAT(notes->take_lines(), ElementsAre("note: objective.1 (edges), frame 12: few edges",
                                               "warning: objective.1 (edges), frame 12: none"));
  log.note("few edges");
  EXPECT_THAT(notes->take_lines(), IsEmpty());
  EXPECT_THAT(notes->repeated_lines(),
              ElementsAre("note: objective.1 (edges), frame 12: few edges (1001 times)"));
  EXPECT_EQ(notes->all().front().count, 1001);
}

TEST(PluginNotes, PluginsOfOneTextAreToldApart) {
  const auto notes = std::make_shared<PluginNotes>();
  for (const char* who : {"a", "b"}) PluginLog(notes, who).note("text");
  EXPECT_THAT(notes->take_lines(), ElementsAre("note: a: text", "note: b: text"));
}

TEST(PluginNotes, ManyDifferentTextsAreCutOffForThatPluginOnly) {
  const auto notes = std::make_shared<PluginNotes>();
  for (int i = 0; i < 1000; ++i) PluginLog(notes, "loud").note(fmt::format("text {}", i));
  PluginLog(notes, "quiet").note("text");
  const auto lines = notes->take_lines();
  ASSERT_THAT(lines, SizeIs(PluginNotes::kMostTexts + 2));
  EXPECT_THAT(lines[PluginNotes::kMostTexts], HasSubstr("further ones are only counted"));
  EXPECT_EQ(lines.back(), "note: quiet: text");
  EXPECT_EQ(notes->all()[PluginNotes::kMostTexts].count, 1000 - 20);
}

TEST(PluginNotes, ATextBecomesOneLineOfLimitedLength) {
  const auto notes = std::make_shared<PluginNotes>();
  PluginLog(notes, "a").note("two\nlines\t" + std::string(10000, 'x'));
  const auto lines = notes->take_lines();
  EXPECT_THAT(lines.front(), HasSubstr("two lines x"));
  EXPECT_LT(lines.front().size(), 600U);
}

TEST(PluginNotes, ThreadsMayTellAtOnce) {
  const auto notes = std::make_shared<PluginNotes>();
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([log = PluginLog(notes, "a")] {
        for (int i = 0; i < 1000; ++i) log.note(i % 2 == 0 ? "even" : "odd");
      });
  }
  std::int64_t count = 0;
  for (const PluginNote& note : notes->all()) count += note.count;
  EXPECT_EQ(count, 8000);
  EXPECT_THAT(notes->all(), SizeIs(2));
}

TEST(PluginNotes, AThreadMayWorkOnAnotherFrame) {
  const auto notes = std::make_shared<PluginNotes>();
  const PluginLog log(notes, "a");
  const detail::RunningFrame running(12);
  {
    const detail::ThreadFrame of_thread(3);
    log.note("writes");
    const detail::ThreadFrame unknown(std::nullopt);
    log.note("reads");
  }
  log.note("searches");
  EXPECT_THAT(notes->take_lines(), ElementsAre("note: a, frame 3: writes", "note: a: reads",
                                               "note: a, frame 12: searches"));
}

TEST(PluginNotes, OfSeveralTrackersEachThreadNamesItsOwnFrame) {
  const auto notes = std::make_shared<PluginNotes>();
  const PluginLog log(notes, "a");
  const detail::RunningFrame running(12);
  const auto helps = [&](const char* text) { std::thread([&] { log.note(text); }).join(); };
  helps("helps the only one");
  std::thread([&] {
    const detail::RunningFrame other(3);
    log.note("tracks");
    helps("helps either");
  }).join();
  log.note("goes on");
  EXPECT_THAT(notes->take_lines(),
              ElementsAre("note: a, frame 12: helps the only one", "note: a, frame 3: tracks",
                          "note: a: helps either", "note: a, frame 12: goes on"));
}

TEST(PluginLog, NobodyReadsAnEmptyOne) {
  const PluginLog log;
  EXPECT_FALSE(log.is_read());
  EXPECT_NO_THROW(log.warning("text"));
}

}  // namespace
}  // namespace hypotrack
