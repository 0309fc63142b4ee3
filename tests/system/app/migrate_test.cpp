#include <sys/stat.h>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

class MigrateTest : public AppTest {
 protected:
  Outcome migrate(const std::vector<std::string>& names) const {
    std::vector<std::string> arguments{"migrate"};
    for (const std::string& name : names) arguments.push_back(path(name).string());
    return run_program(arguments);
  }
};

TEST_F(MigrateTest, RewritesAllFilesOrNone) {
  const std::string former = "tracker: {patience: 3}  # why\n";
  write_text(path("a.yaml"), former);
  write_text(path("b.yaml"), "tracker: {patience: [\n");
  const Outcome refused = migrate({"a.yaml", "b.yaml"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("b.yaml:"));
  EXPECT_EQ(read_text(path("a.yaml")), former);
  ASSERT_EQ(chmod(path("a.yaml").c_str(), 0600), 0);
  const Outcome done = migrate({"a.yaml"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(read_text(path("a.yaml")), "status: {patience: 3}  # why\n");
  EXPECT_EQ(std::filesystem::status(path("a.yaml")).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  EXPECT_THAT(migrate({"a.yaml"}).out, HasSubstr("a.yaml: has no former key"));
}

TEST_F(MigrateTest, AFileThatIsNotThereIsNamed) {
  const Outcome outcome = migrate({"none.yaml"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("none.yaml: cannot be read"));
}

}  // namespace
}  // namespace hypotrack::test
