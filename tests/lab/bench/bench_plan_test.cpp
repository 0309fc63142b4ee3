#include "lab/bench/bench_plan.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using bench::Request;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kScene = "models: []\nsource: {}\nobjective: {}\noptimizer: {}\n";

/// A test with a table of two scenes, one of them at two tile sizes, in two configurations.
class BenchPlanTest : public testing::Test {
 protected:
  BenchPlanTest() {
    write("box.yaml", kScene);
    write("hand.yaml", kScene);
    write("table.yaml", R"(title: Some
scenes:
  box: {file: box.yaml, label: A box, set: {seed: 1}}
  hand: {file: hand.yaml}
grid:
  tile.size: [32, 64]
  backend:
    cpu: {evaluate.backend: cpu}
    one: {evaluate.backend: cpu, evaluate.threads: 1}
variants:
  quick: {scenes: [box], frames: 7}
)");
  }
  ~BenchPlanTest() override { std::filesystem::current_path(working_directory_); }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }
  Request request() const { return {path("table.yaml"), {}, {}, {}, {}}; }

  static std::vector<std::string> labels(const bench::Plan& plan) {
    std::vector<std::string> labels;
    for (const auto& c : plan.cases) labels.push_back(c.label);
    return labels;
  }
  static std::vector<std::string> configurations(const bench::Plan& plan) {
    std::vector<std::string> names;
    for (const auto& configuration : plan.configurations) names.push_back(configuration.name);
    return names;
  }

 private:
  TemporaryDirectory folder_;
  std::filesystem::path working_directory_ = std::filesystem::current_path();
};

TEST_F(BenchPlanTest, EveryPointOfTheGridIsACaseAndTheBackendsAreWays) {
  const bench::Plan plan = make_plan(request());
  EXPECT_EQ(plan.title, "Some");
  EXPECT_THAT(labels(plan), ElementsAre("A box, tile.size 32", "A box, tile.size 64",
                                        "hand, tile.size 32", "hand, tile.size 64"));
  EXPECT_THAT(configurations(plan), ElementsAre("cpu", "one"));
  EXPECT_THAT(plan.configurations[1].overrides,
              ElementsAre("evaluate.backend=cpu", "evaluate.threads=1"));
  EXPECT_EQ(plan.cases[0].file, path("box.yaml"));
}

TEST_F(BenchPlanTest, FurtherChangesComeAfterTheTables) {
  Request r = request();
  r.set = {"seed=3"};
  EXPECT_THAT(make_plan(r).cases[0].overrides, ElementsAre("seed=1", "tile.size=32", "seed=3"));
}

TEST_F(BenchPlanTest, AVariantHasLessToDo) {
  Request r = request();
  r.variant = "quick";
  const bench::Plan plan = make_plan(r);
  EXPECT_EQ(plan.cases.size(), 2U);
  EXPECT_EQ(plan.frames, 7);
}

TEST_F(BenchPlanTest, ScenesAreNamesOfTheTableOrFiles) {
  write("other.yaml", kScene);
  Request r = request();
  r.scenes = {"hand", path("other.yaml").string()};
  const bench::Plan plan = make_plan(r);
  EXPECT_THAT(labels(plan),
              ElementsAre("hand, tile.size 32", "hand, tile.size 64", path("other.yaml").string()));
  EXPECT_THAT(plan.cases.back().overrides, testing::IsEmpty());
}

TEST_F(BenchPlanTest, BackendsAreThoseOfTheTable) {
  Request r = request();
  r.backends = {"one"};
  EXPECT_THAT(configurations(make_plan(r)), ElementsAre("one"));
  r.backends = {"cpu", "ones"};
  EXPECT_THAT(message_of<ConfigError>([&] { make_plan(r); }),
              AllOf(HasSubstr("--backends ones"), HasSubstr("did you mean 'one'"),
                    HasSubstr("its cases are: cpu, one")));
}

TEST_F(BenchPlanTest, MistakesAreFoundBeforeAnythingIsMeasured) {
  Request unknown = request();
  unknown.scenes = {"hands"};
  EXPECT_THAT(message_of<ConfigError>([&] { make_plan(unknown); }),
              AllOf(HasSubstr("hands: "), HasSubstr("did you mean 'hand'"),
                    HasSubstr("its scenes are: box, hand")));
  Request misspelt = request();
  misspelt.set = {"tile.sise=3"};
  EXPECT_THAT(message_of<ConfigError>([&] { make_plan(misspelt); }),
              HasSubstr("--set tile.sise=3"));
  for (const char* grid : {"", "grid: {tile.size: [32]}\n", "grid: {backend: [cpu]}\n"}) {
    write("table.yaml", std::string("title: Some\nscenes: {box: {file: box.yaml}}\n") + grid);
    EXPECT_THAT(message_of<ConfigError>([&] { make_plan(request()); }),
                AllOf(HasSubstr("table.yaml"), HasSubstr("needs an axis 'backend'")));
  }
}

TEST_F(BenchPlanTest, TheTableThatComesWithHypotrackFitsItsScenes) {
  const bench::Plan plan =
      make_plan(Request{source_dir() / "configs/studies/bench.yaml", {}, {}, {}, {}});
  EXPECT_THAT(labels(plan), testing::IsSupersetOf({"1 hand 32x32", "1 hand 64x64", "2 hands 32x32",
                                                   "1 hand 32x32, tile 256", "1 hand 1024x32",
                                                   "1 hand 4096x32"}));
  EXPECT_THAT(configurations(plan), ElementsAre("cpu", "egl", "cuda"));
}

}  // namespace
}  // namespace hypotrack::test
