#include "lab/bench/bench_table.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/bench/bench_numbers.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using bench::Measurement;
using bench::Outcome;
using bench::Row;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

bench::Plan plan_of_two_ways() {
  bench::Plan plan;
  plan.title = "Some";
  plan.cases.push_back({"box", "A box, small", "box.yaml", {}, {}});
  plan.configurations = {{"cpu", {}}, {"gpu", {}}};
  return plan;
}

/// Frames of 1, 2, ..., n times a duration, with a hundred evaluations each.
Measurement frames_of(double seconds, int n) {
  Measurement m;
  m.device = "a device";
  for (int i = 1; i <= n; ++i) {
    m.seconds.push_back(i * seconds);
    m.evaluations.push_back(100);
  }
  m.metrics.mean_error_mm = 12.345;
  m.metrics.status.tracked_share = 0.975;
  return m;
}

Measurement unavailable(const std::string& why) {
  Measurement m;
  m.outcome = Outcome::unavailable;
  m.message = why;
  return m;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(BenchNumbersTest, AreThoseOfTheMedianFrame) {
  const auto numbers = numbers_of(frames_of(0.010, 5));
  ASSERT_TRUE(numbers);
  EXPECT_DOUBLE_EQ(numbers->median, 0.030);
  EXPECT_DOUBLE_EQ(numbers->p5, 0.012);
  EXPECT_DOUBLE_EQ(numbers->p95, 0.048);
  EXPECT_DOUBLE_EQ(numbers->fps, 1 / 0.030);
  EXPECT_DOUBLE_EQ(numbers->evaluations_per_second, 100 / 0.030);
  EXPECT_DOUBLE_EQ(numbers->evaluations, 100);
  EXPECT_FALSE(numbers_of(unavailable("why")));
}

TEST(BenchNumbersTest, WaysAreComparedWithinTheirRoundAndCase) {
  const std::vector<Row> rows = {{1, 0, 0, frames_of(0.010, 3)},
                                 {1, 0, 1, frames_of(0.002, 3)},
                                 {2, 0, 0, frames_of(0.020, 3)},
                                 {2, 0, 1, frames_of(0.002, 3)},
                                 {2, 1, 1, frames_of(0.001, 3)}};
  EXPECT_DOUBLE_EQ(*speed_over(rows[1], 0, rows), 5);
  EXPECT_DOUBLE_EQ(*speed_over(rows[3], 0, rows), 10);
  EXPECT_DOUBLE_EQ(*speed_over(rows[0], 1, rows), 0.2);
  EXPECT_FALSE(speed_over(rows[4], 0, rows));
}

TEST(BenchTableTest, TellsNumbersRatiosDevicesAndReasons) {
  auto plan = plan_of_two_ways();
  plan.configurations.push_back({"other", {}});
  const std::vector<Row> rows = {{1, 0, 0, frames_of(0.010, 3)},
                                 {1, 0, 1, frames_of(0.002, 3)},
                                 {1, 0, 2, unavailable("there is no such thing")}};
  EXPECT_EQ(table_text(plan, rows, 1),
            "scene         backend  frames median ms       5 %      95 %      fps   evals/s  error "
            "mm tracked %     x cpu     x gpu\n"
            "A box, small  cpu           3    20.000    11.000    29.000     50.0     5.0 k     "
            "12.35      97.5      1.00     0.200\n"
            "A box, small  gpu           3     4.000     2.200     5.800      250    25.0 k     "
            "12.35      97.5      5.00      1.00\n"
            "A box, small  other         - unavailable [1]\n"
            "\n"
            "cpu: a device\n"
            "gpu: a device\n"
            "[1] there is no such thing\n");
}

TEST(BenchTableTest, WithoutAnyNumberThereAreTheReasons) {
  EXPECT_EQ(table_text(plan_of_two_ways(), {{1, 0, 1, unavailable("none")}}, 1),
            "scene         backend  frames median ms       5 %      95 %      fps   evals/s  error "
            "mm tracked %\n"
            "A box, small  gpu           - unavailable [1]\n"
            "\n"
            "[1] none\n");
}

TEST(BenchTableTest, ARoundHasItsOwnRows) {
  const std::vector<Row> rows = {{1, 0, 0, frames_of(0.010, 3)}, {2, 0, 0, frames_of(0.020, 3)}};
  EXPECT_THAT(table_text(plan_of_two_ways(), rows, 2),
              testing::AllOf(HasSubstr("40.000"), Not(HasSubstr("20.000"))));
}

TEST(BenchTableTest, MemoryOfTheGpuIsToldWhereThereIsOne) {
  std::vector<Row> rows = {{1, 0, 0, frames_of(0.010, 3)}, {1, 0, 1, frames_of(0.002, 3)}};
  EXPECT_THAT(table_text(plan_of_two_ways(), rows, 1), Not(HasSubstr("GPU MiB")));
  rows[1].measurement.device_mib = 54.3;
  EXPECT_THAT(table_text(plan_of_two_ways(), rows, 1),
              testing::AllOf(HasSubstr("error mm tracked %   GPU MiB     x cpu"),
                             HasSubstr("12.35      97.5        54      5.00"),
                             HasSubstr("12.35      97.5         -      1.00")));
}

TEST(BenchTableTest, FilesHoldEveryRow) {
  const TemporaryDirectory folder;
  const std::vector<Row> rows = {{1, 0, 0, frames_of(0.010, 3)},
                                 {1, 0, 1, unavailable("no GPU,\nnone")}};
  write_rows(folder.path() / "rows.csv", plan_of_two_ways(), rows);
  EXPECT_EQ(read(folder.path() / "rows.csv"),
            "scene,backend,round,status,device,frames,warm_up,median_ms,p5_ms,p95_ms,fps,"
            "evaluations,evaluations_per_second,mean_error_mm,lost_frames,tracked_share,device_mib,"
            "speed_over_cpu,"
            "speed_over_gpu,message\n"
            "\"A box, small\",cpu,1,measured,a device,3,0,20.0,11.0,29.0,50.0,100.0,5000.0,12.345,"
            "0,0.975,,1.0,,\n"
            "\"A box, small\",gpu,1,unavailable,,0,0,,,,,,,,,,,,,\"no GPU, none\"\n");
  write_rows(folder.path() / "rows.json", plan_of_two_ways(), rows);
  const auto json = nlohmann::json::parse(read(folder.path() / "rows.json"));
  EXPECT_EQ(json.at("title"), "Some");
  ASSERT_EQ(json.at("rows").size(), 2U);
  EXPECT_EQ(json.at("rows")[0].at("median_ms"), 20.0);
  EXPECT_TRUE(json.at("rows")[1].at("fps").is_null());
  EXPECT_GE(json.at("cores"), 1);
}

TEST(BenchTableTest, OtherFormatsAreRefused) {
  EXPECT_THAT(message_of<ConfigError>([] { bench::check_format("rows.txt"); }),
              HasSubstr("--out rows.txt: expected a name that ends in .csv or .json"));
}

}  // namespace
}  // namespace hypotrack::test
