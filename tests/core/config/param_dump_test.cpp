#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "sample_params.hpp"

namespace hypotrack::test {
namespace {

SampleParams read_elsewhere(std::string_view text) {
  return ParamReader(ConfigNode::parse(text, "dump.yaml", "/elsewhere")).read<SampleParams>();
}

struct NoParams {
  void visit(ParamVisitor&) {}
};

struct UnsetParams {
  double unset = std::numeric_limits<double>::quiet_NaN();
  double endless = std::numeric_limits<double>::infinity();
  void visit(ParamVisitor& v) {
    v("unset", unset, {.help = ""});
    v("endless", endless, {.help = ""});
  }
};

TEST(ParamDump, HoldsEveryValueInTheUnitsOfTheFile) {
  SampleParams params;
  params.file = "/images/a.png";
  params.nested = ConfigNode::parse("{type: pso, list: [1, 2]}", "n.yaml");
  EXPECT_EQ(dump_params(params),
            "particles: 64\n"
            "radius_mm: 3\n"
            "range_deg: 10\n"
            "name: default\n"
            "enabled: true\n"
            "small: 7\n"
            "mode: nearest\n"
            "file: /images/a.png\n"
            "center: [0, 0, 500]\n"
            "weights: [0.25, 0.75]\n"
            "words: []\n"
            "inner:\n  depth: 1\n"
            "parts:\n  - size: 9\n    label: nine\n  - size: 10\n    label: ten\n"
            "nested:\n  type: pso\n  list: [1, 2]\n");
}

TEST(ParamDump, RelativePathsBecomeAbsoluteAndEmptyOnesStayEmpty) {
  SampleParams params;
  params.file = "a.png";
  EXPECT_EQ(read_elsewhere(dump_params(params)).file, std::filesystem::current_path() / "a.png");
  const std::string dumped = dump_params(OptionalFile{});
  EXPECT_EQ(ParamReader(ConfigNode::parse(dumped, "d")).read<OptionalFile>().file, "");
}

TEST(ParamDump, NothingIsAnEmptyText) { EXPECT_EQ(dump_params(NoParams{}), ""); }

TEST(ParamDump, NotANumberIsLeftOutAndInfinityKept) {
  EXPECT_EQ(dump_params(UnsetParams{}), "endless: .inf\n");
  const auto read_back =
      ParamReader(ConfigNode::parse(dump_params(UnsetParams{}), "d")).read<UnsetParams>();
  EXPECT_TRUE(std::isnan(read_back.unset));
}

/// Values that a scene could have led to, including texts that look like something else.
class RandomParams {
 public:
  SampleParams next() {
    SampleParams params;
    params.particles = 2 + static_cast<int>(random_() % (1 << 20));
    params.radius = std::abs(real());
    params.range = std::uniform_real_distribution<double>(0, 180 * kDegree)(random_);
    params.name = text();
    params.enabled = random_() % 2;
    params.small = static_cast<std::uint8_t>(random_());
    params.mode = static_cast<Mode>(random_() % 2);
    params.file = "/" + text();
    params.center = {real(), real(), real()};
    params.weights.clear();
    for (auto n = random_() % 4; n > 0; --n) params.weights.push_back(unit_(random_));
    for (auto n = random_() % 4; n > 0; --n) params.words.push_back(text());
    if (random_() % 2) params.maybe = real();
    params.inner.depth = static_cast<int>(random_() % 1000);
    params.parts.resize(random_() % 4);
    for (SamplePart& part : params.parts) part = {real(), text()};
    return params;
  }

 private:
  double real() {
    const double exponent = std::uniform_real_distribution<double>(-30, 30)(random_);
    return (unit_(random_) - 0.5) * std::pow(10.0, exponent);
  }
  std::string text() {
    static const std::vector<std::string> kPieces = {
        "a",  "true", "~", "1",  ".5", " ",    "#",  ": ",  "- ", "'", "\"", "\\", "\n",
        "\t", "[",    "}", "&x", "*",  "!",    "%",  "@",   "`",  "ü", "手", "no", "-",
        "?",  ",",    "|", ">",  "\r", "null", "0x", "e10", "/",  "=", "<<"};
    std::string text;
    for (auto n = random_() % 6; n > 0; --n) text += kPieces[random_() % kPieces.size()];
    return text;
  }

  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> unit_{0, 1};
};

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expect_same(const SampleParams& a, const SampleParams& b, const std::string& text) {
  EXPECT_EQ(a.particles, b.particles);
  EXPECT_TRUE(same(a.radius, b.radius)) << text;
  EXPECT_TRUE(same(a.range, b.range)) << text;
  EXPECT_EQ(a.name, b.name) << text;
  EXPECT_EQ(a.enabled, b.enabled);
  EXPECT_EQ(a.small, b.small);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.file.lexically_normal(), b.file) << text;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(same(a.center[i], b.center[i])) << text;
  EXPECT_EQ(a.weights, b.weights) << text;
  EXPECT_EQ(a.words, b.words) << text;
  EXPECT_EQ(a.maybe, b.maybe) << text;
  EXPECT_EQ(a.inner.depth, b.inner.depth);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_TRUE(same(a.parts[i].size, b.parts[i].size)) << text;
    EXPECT_EQ(a.parts[i].label, b.parts[i].label) << text;
  }
}

TEST(ParamDump, ReadsBackBitByBit) {
  RandomParams random;
  for (int i = 0; i < 1000; ++i) {
    const SampleParams params = random.next();
    const std::string text = dump_params(params);
    expect_same(params, read_elsewhere(text), text);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace hypotrack::test
