#include "base/numbers.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::detail {
namespace {

TEST(Numbers, AreThoseOfYaml12) {
  EXPECT_EQ(parse_number("1"), 1.0);
  EXPECT_EQ(parse_number("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("5."), 5.0);
  EXPECT_EQ(parse_number("1E+2"), 100.0);
  EXPECT_EQ(parse_number("-.inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parse_number(".nan").value()));
  for (const auto* text : {"", ".", "-", "e5", "1e", "1e+", "0x10", "1_000", "nan", "inf", "1 2",
                           "1,5", "1e999", "--1", "+-1", "infinity", "1.5.2"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

TEST(Numbers, IntegersMayHaveExponentsButNoFractions) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("1e3"), 1000);
  EXPECT_EQ(parse_integer("1.50e1"), 15);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const auto* text : {"1.5", "1e300", "9223372036854775808", ".inf", ".nan", "five", ""}) {
    EXPECT_EQ(parse_integer(text), std::nullopt) << text;
  }
}

TEST(Numbers, CommonValuesAreWrittenAsPeopleDo) {
  EXPECT_EQ(format_number(0.003, kMillimetre), "3");
  EXPECT_EQ(format_number(90 * kDegree, kDegree), "90");
  EXPECT_EQ(format_number(0.1, 1.0), "0.1");
  EXPECT_EQ(format_number(7.5 * kDegree, kDegree), "7.5");
}

double read_back(const std::string& text, double to_si) {
  return scale_number(text, parse_number(text).value(), to_si);
}

TEST(Numbers, EveryValueIsReadBackBitByBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-250, 250);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  for (const double to_si : {1.0, kMillimetre, kDegree, 1e-6, 60.0}) {
    for (int i = 0; i < 5000; ++i) {
      const double wide = mantissa(random) * std::pow(10.0, exponent(random));
      const double narrow = mantissa(random);
      for (const double value : {wide, narrow, 0.0, -0.0}) {
        const std::string text = format_number(value, to_si);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(read_back(text, to_si)),
                  std::bit_cast<std::uint64_t>(value))
            << text << " for " << value << " with " << to_si;
      }
    }
  }
}

}  // namespace
}  // namespace hypotrack::detail
