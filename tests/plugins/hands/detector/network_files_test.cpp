// Where the networks are looked for, and what is said of missing and damaged ones.
#include <gmock/gmock.h>
#include <stdlib.h>

#include <fstream>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "pictures.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Sets variables of the environment until the end of the test.
class Environment {
 public:
  Environment(const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [name, value] : values) {
      const char* before = getenv(name.c_str());
      before_.emplace_back(name, before ? std::optional<std::string>(before) : std::nullopt);
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~Environment() {
    for (const auto& [name, value] : before_) {
      if (value) {
        setenv(name.c_str(), value->c_str(), 1);
      } else {
        unsetenv(name.c_str());
      }
    }
  }

 private:
  std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

TEST(NetworkFolder, IsTakenFromTheEnvironment) {
  {
    const Environment set({{"HYPOTRACK_HAND_DETECTOR", "/a"}, {"XDG_DATA_HOME", "/b"}});
    EXPECT_EQ(HandDetector::default_folder(), "/a");
  }
  {
    const Environment set({{"HYPOTRACK_HAND_DETECTOR", ""}, {"XDG_DATA_HOME", "/b"}});
    EXPECT_EQ(HandDetector::default_folder(), "/b/hypotrack/hand_detector");
  }
  {
    const Environment set({{"HYPOTRACK_HAND_DETECTOR", ""}, {"XDG_DATA_HOME", ""}, {"HOME", "/c"}});
    EXPECT_EQ(HandDetector::default_folder(), "/c/.local/share/hypotrack/hand_detector");
  }
  const Environment set({{"HYPOTRACK_HAND_DETECTOR", ""}, {"XDG_DATA_HOME", ""}, {"HOME", ""}});
  EXPECT_THAT(test::message_of<DataError>([] { HandDetector::default_folder(); }),
              HasSubstr("HYPOTRACK_HAND_DETECTOR"));
}

/// A copy of the networks that may be damaged.
class NetworkFiles : public ::testing::Test {
 protected:
  void copy_networks() {
    for (const auto& entry : fs::directory_iterator(HandDetector::default_folder())) {
      fs::copy(entry, folder_.path());
    }
  }
  std::string message(bool lite = false) const {
    return test::message_of<DataError>(
        [&] { HandDetector detector({.folder = folder_.path(), .lite = lite}); });
  }
  fs::path file(const std::string& name) const { return folder_.path() / name; }

  test::TemporaryDirectory folder_;
};

TEST_F(NetworkFiles, ThatAreMissingAreNamedWithTheRemedy) {
  EXPECT_THAT(message(), AllOf(StartsWith(file("palm_detection_full.net").string()),
                               EndsWith("run `hypotrack get detector`"), Not(HasSubstr("\n"))));
  EXPECT_THAT(message(true), StartsWith(file("palm_detection_lite.net").string()));
}

TEST_F(NetworkFiles, OfTheHandAreNeededToo) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  copy_networks();
  fs::remove(file("hand_landmark_full.net"));
  EXPECT_THAT(message(), AllOf(StartsWith(file("hand_landmark_full.net").string()),
                               EndsWith("run `hypotrack get detector`")));
  HandDetector lite({.folder = folder_.path(), .lite = true});
}

TEST_F(NetworkFiles, ThatAreCutOffAreDamaged) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  for (const std::uintmax_t size : {0, 100, 100000, 3000000}) {
    copy_networks();
    fs::resize_file(file("palm_detection_full.net"), size);
    EXPECT_THAT(message(),
                AllOf(StartsWith(file("palm_detection_full.net").string()), HasSubstr("damaged"),
                      EndsWith("run `hypotrack get detector`"), Not(HasSubstr("\n"))))
        << size;
    fs::remove_all(folder_.path());
    fs::create_directory(folder_.path());
  }
}

TEST_F(NetworkFiles, ThatAreSomethingElseAreDamaged) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  copy_networks();
  std::ofstream(file("hand_landmark_full.net")) << "<html>404</html>";
  EXPECT_THAT(message(),
              AllOf(StartsWith(file("hand_landmark_full.net").string()), HasSubstr("damaged")));
  fs::copy_file(file("palm_detection_full.net"), file("hand_landmark_full.net"),
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(message(), AllOf(StartsWith(file("hand_landmark_full.net").string()),
                               HasSubstr("no output landmarks")));
}

}  // namespace
}  // namespace hypotrack
