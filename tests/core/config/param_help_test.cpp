#include "expect_error.hpp"
#include "sample_params.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ContainsRegex;

TEST(ParamHelp, OneLinePerParameterWithTypeDefaultUnitRangeAndHelp) {
  const std::string help = describe_params<SampleParams>();
  EXPECT_THAT(help,
              ContainsRegex(
                  "  particles +integer from 2 to 1048576, default 64 +particles of the swarm\n"));
  EXPECT_THAT(help, ContainsRegex("  radius_mm +number at least 0 mm, default 3 +of a sphere\n"));
  EXPECT_THAT(help,
              ContainsRegex("  range_deg +number from 0 to 180 deg, default 10 +of a joint\n"));
  EXPECT_THAT(help, ContainsRegex("  name +text, default \"default\" +a name\n"));
  EXPECT_THAT(help, ContainsRegex("  enabled +true or false, default true +whether to\n"));
  EXPECT_THAT(help, ContainsRegex("  mode +one of nearest, bilinear, default nearest +lookup\n"));
  EXPECT_THAT(help, ContainsRegex("  file +path, required +an image\n"));
  EXPECT_THAT(help,
              ContainsRegex("  center +3 numbers in mm, default .0, 0, 500. +of the sphere\n"));
  EXPECT_THAT(help, ContainsRegex("  maybe +number, optional +perhaps\n"));
  EXPECT_THAT(
      help,
      ContainsRegex(
          "  inner +a map of +a section\n    depth +integer at least 0, default 1 +how deep\n"));
  EXPECT_THAT(help, ContainsRegex(
                        "  parts +a list of +the parts\n    size +number, default 1 +how large\n"));
}

}  // namespace
}  // namespace hypotrack::test
