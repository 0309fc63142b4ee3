#include "base/csv.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "base/text_file.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class CsvTableTest : public testing::Test {
 protected:
  CsvTable table(const std::string& text) const {
    write_whole(file(), text);
    return CsvTable(file());
  }
  std::string refusal(const std::string& text) const {
    return message_of<DataError>([&] { table(text); });
  }
  std::filesystem::path file() const { return folder_.path() / "table.csv"; }

 private:
  TemporaryDirectory folder_;
};

TEST_F(CsvTableTest, HasARowPerLineWithOrWithoutALineFeedAtTheEnd) {
  for (const char* end : {"", "\n", "\r\n", "\n\n"}) {
    const CsvTable read = table(std::string("frame,x\n0,1.5\n1,2.5") + end);
    EXPECT_THAT(read.columns(), ElementsAre("frame", "x"));
    ASSERT_THAT(read.rows(), SizeIs(2));
    EXPECT_EQ(read.frame(read.rows()[1], 0), 1);
    EXPECT_EQ(read.number(read.rows()[1], 1, false), 2.5);
  }
}

TEST_F(CsvTableTest, CountsLinesOfTheFileWithCommentsBlanksAndMarks) {
  const CsvTable read = table("\xEF\xBB\xBF# made by hand\n\n x , y \r\n1,2\n# between\n3,+4\n");
  EXPECT_THAT(read.columns(), ElementsAre("x", "y"));
  ASSERT_THAT(read.rows(), SizeIs(2));
  EXPECT_THAT(read.where(read.rows()[0]), HasSubstr("table.csv:4"));
  EXPECT_THAT(read.where(read.rows()[1]), HasSubstr("table.csv:6"));
  EXPECT_EQ(read.number(read.rows()[1], 1, false), 4);
  EXPECT_EQ(read.find("y"), 1);
  EXPECT_EQ(read.find("z"), -1);
}

TEST_F(CsvTableTest, TellsAnEmptyCellFromZero) {
  const CsvTable read = table("x,y\n,0\n");
  EXPECT_TRUE(std::isnan(read.number(read.rows()[0], 0, true)));
  EXPECT_THAT(message_of<DataError>([&] { read.number(read.rows()[0], 0, false); }),
              HasSubstr("table.csv:2: column 'x' holds ''; expected a number"));
  EXPECT_EQ(read.number(read.rows()[0], 1, true), 0);
}

TEST_F(CsvTableTest, RefusesWhatIsNoTable) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty; expected a header line"));
  EXPECT_THAT(refusal("x,y\n1\n"), HasSubstr("table.csv:2: has 1 cells; expected 2"));
  EXPECT_THAT(refusal("x,x\n"), HasSubstr("table.csv:1: the column 'x' is there twice"));
  EXPECT_THAT(refusal("x,\n"), HasSubstr("table.csv:1: a column has no name"));
  EXPECT_THAT(refusal(std::string("x\n\0\n", 4)), HasSubstr("NUL"));
}

TEST_F(CsvTableTest, KeepsWhatACellWasWrittenFrom) {
  EXPECT_EQ(csv_cell("plain"), "plain");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"x\"\nthen"), "\"say \"\"x\"\" then\"");
}

}  // namespace
}  // namespace hypotrack::test
