// Small networks whose outputs are computed by hand, and files that are refused.
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <thread>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "network.hpp"
#include "test_paths.hpp"

namespace hypotrack::hands {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Writes networks to files.
class NetworkTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& head, const std::vector<float>& weights,
                              const std::string& name = "a.net") const {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream stream(file, std::ios::binary);
    stream << "hypotrack network 1\n" << head;
    std::vector<char> bytes(weights.size() * sizeof(float));
    if (!bytes.empty()) std::memcpy(bytes.data(), weights.data(), bytes.size());
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file;
  }
  /// Returns the output `out` of the network for a picture of two by two pixels.
  std::vector<float> run(const std::string& steps, const std::vector<float>& weights,
                         std::size_t size) const {
    const std::string head =
        "picture 2\n" + steps + "weights " + std::to_string(weights.size()) + "\n";
    const Network network(write(head, weights), 2, {{"out", size}});
    return network.run(write_picture).front();
  }
  /// Returns what is said of a file with this head.
  std::string refused(const std::string& head, const std::vector<float>& weights = {}) const {
    const std::filesystem::path file = write(head, weights);
    const std::string message = test::message_of<DataError>([&] {
      Network(file, 2, {{"out", 3}});
    });
    EXPECT_THAT(message, AllOf(StartsWith(file.string()), HasSubstr("damaged"),
                               Not(HasSubstr("\n")), EndsWith("run `hypotrack get detector`")));
    return message;
  }
  /// Red is 1 to 4, row by row; green is ten times and blue a hundred times as much.
  static void write_picture(std::span<float> rgb) {
    ASSERT_EQ(rgb.size(), 12u);
    for (std::size_t i = 0; i < 4; ++i) {
      rgb[3 * i] = static_cast<float>(i + 1);
      rgb[3 * i + 1] = 10 * rgb[3 * i];
      rgb[3 * i + 2] = 100 * rgb[3 * i];
    }
  }

  test::TemporaryDirectory folder_;
};

TEST_F(NetworkTest, ConvolutionSumsOverItsWindowAndChannels) {
  // One channel: red of the pixel, green of its right neighbour, and a bias.
  EXPECT_THAT(run("conv 0 1 1 2 1 1 0 0 0 1 none\noutput out 1\n", {1, 0, 0, 0, 1, 0, 0.5f}, 4),
              ElementsAre(21.5f, 2.5f, 43.5f, 4.5f));
}

TEST_F(NetworkTest, ConvolutionStepsFromThePaddedCorner) {
  EXPECT_THAT(run("conv 0 1 1 1 2 2 1 0 0 0 none\noutput out 1\n", {1, 0, 0, 0}, 2),
              ElementsAre(0.0f, 3.0f));
}

TEST_F(NetworkTest, DepthwiseConvolutionKeepsChannelsApart) {
  // Two rows: the upper pixel times 1, 2, 3 and the lower one times 0, 0, 1, by channel.
  EXPECT_THAT(
      run("depthwise 0 2 1 1 1 0 0 0 0 none\noutput out 1\n", {1, 2, 3, 0, 0, 1, 0, 0, 7}, 6),
      ElementsAre(1, 20, 300 + 300 + 7, 2, 40, 600 + 400 + 7));
}

TEST_F(NetworkTest, ActivationsLimitConvolutions) {
  const std::string conv = "conv 0 2 1 1 1 1 0 0 0 0 ", output = "\noutput out 1\n";
  const std::vector<float> weights{3, 0, 0, -1, 0, 0, 0, 0};
  EXPECT_THAT(run(conv + "relu" + output, weights, 8), ElementsAre(3, 0, 6, 0, 9, 0, 12, 0));
  EXPECT_THAT(run(conv + "relu6" + output, weights, 8), ElementsAre(3, 0, 6, 0, 6, 0, 6, 0));
}

TEST_F(NetworkTest, PreluHasASlopePerChannel) {
  EXPECT_THAT(run("conv 0 2 1 1 1 1 0 0 0 0 none\nprelu 1\nmax_pool 2 2 2\noutput out 3\n",
                  {1, 0, 0, -1, 0, 0, 0, 0, 0.5f, 0.25f}, 2),
              ElementsAre(4.0f, -0.25f));
}

TEST_F(NetworkTest, SumsPoolingAndWideningAreThoseOfTheFormat) {
  // Largest of each channel, with a fourth channel of zeros, plus the mean of a convolution to
  // four.
  EXPECT_THAT(run("max_pool 0 2 2\nwiden 1 4\nconv 0 4 1 1 1 1 0 0 0 0 none\nmean 3\nadd 2 4\n"
                  "output out 5\n",
                  {1, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 9}, 4),
              ElementsAre(6.5f, 40, 405, 9));
}

TEST_F(NetworkTest, ResizingInterpolatesBetweenMiddlesOfPixels) {
  EXPECT_THAT(run("conv 0 1 1 1 1 1 0 0 0 0 none\nresize 1 2 4\noutput out 2\n", {1, 0, 0, 0}, 8),
              ElementsAre(1, 1.25f, 1.75f, 2, 3, 3.25f, 3.75f, 4));
}

TEST_F(NetworkTest, OutputsAreTensorsOneAfterTheOther) {
  const std::vector<float> out =
      run("mean 0\nconv 1 1 1 1 1 1 0 0 0 0 none\nsigmoid 2\noutput out 3 1\n", {0, 0, 0, 0}, 4);
  EXPECT_THAT(out, ElementsAre(0.5f, 2.5f, 25, 250));
}

TEST_F(NetworkTest, ComputesTheSameWithAnyNumberOfThreads) {
  const Network network(write("picture 2\nconv 0 1 1 2 1 1 0 0 0 1 none\noutput out 1\nweights 7\n",
                              {1, 0, 0, 0, 1, 0, 0.5f}),
                        2, {{"out", 4}});
  for (const int threads : {1, 2, 3, 1, 5})
    EXPECT_THAT(network.run(write_picture, threads).front(), ElementsAre(21.5f, 2.5f, 43.5f, 4.5f));
}

TEST_F(NetworkTest, SeveralThreadsGetEqualResults) {
  const std::string head =
      "picture 2\nconv 0 1 1 1 1 1 0 0 0 0 none\nwiden 1 2\noutput out 2\nweights 4\n";
  const Network network(write(head, {1, 0, 0, 0}), 2, {{"out", 8}});
  std::vector<std::vector<float>> results(8);
  {
    std::vector<std::jthread> threads;
    for (std::vector<float>& result : results) {
      threads.emplace_back([&] {
        for (int i = 0; i < 20; ++i) result = network.run(write_picture).front();
      });
    }
  }
  for (const std::vector<float>& result : results)
    EXPECT_THAT(result, ElementsAre(1, 0, 2, 0, 3, 0, 4, 0));
}

TEST_F(NetworkTest, AFileThatHasChangedIsReadAgain) {
  const std::string head = "picture 2\nmean 0\nconv 1 1 1 1 1 1 0 0 0 0 none\noutput out 2\n";
  const Network first(write(head + "weights 4\n", {0, 0, 0, 1}), 2, {{"out", 1}});
  const Network second(write(head + "output other 1\nweights 4\n", {0, 0, 0, 2}), 2,
                       {{"out", 1}, {"other", 3}});
  EXPECT_THAT(first.run(write_picture).front(), ElementsAre(1));
  EXPECT_THAT(second.run(write_picture).front(), ElementsAre(2));
}

TEST_F(NetworkTest, FilesWithOtherNumbersOfWeightsAreRefused) {
  const std::string head = "picture 2\nmean 0\nprelu 1\noutput out 2\n";
  EXPECT_THAT(refused(head + "weights 3\n", {1, 2}),
              HasSubstr("line 6: 8 bytes follow the head, expected 12"));
  EXPECT_THAT(refused(head + "weights 3\n", {1, 2, 3, 4}), HasSubstr("16 bytes"));
  EXPECT_THAT(refused(head + "weights 2\n", {1, 2}), HasSubstr("the steps take 3 weights, not 2"));
  EXPECT_THAT(refused(head + "weights 3\n", {1, 2, std::numeric_limits<float>::infinity()}),
              HasSubstr("not finite"));
}

TEST_F(NetworkTest, DamagedHeadsAreRefusedWithTheirLine) {
  for (const auto& [head, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "line 2: the file ends there"},
           {"picture 2\nmean 0", "line 3: the file ends there"},
           {"picture 2\nmean 0\noutput out 1\n", "line 5: the file ends there"},
           {"mean 0\n", "line 2: there is no picture before it"},
           {"picture 2\npicture 2\n", "there is a picture before it"},
           {"picture 99999999\n", "'99999999' is not a number from 1 to 4096"},
           {"picture -1\n", "'-1' is not a number"},
           {"picture\n", "a word is missing"},
           {"picture 2\nturn 0\n", "line 3: 'turn' is not a step"},
           {"picture 2\n\x01\x02 0\n", "a word is not a step"},
           {"picture 2\nmean 1\n", "'1' is not a number from 0 to 0"},
           {"picture 2\nmean 0 0\n", "it is too long"},
           {"picture 2\nconv 0 1 3 3 1 1 0 0 0 0 none\n", "larger than its input"},
           {"picture 2\nconv 0 1 1 1 0 1 0 0 0 0 none\n", "'0' is not a number from 1"},
           {"picture 2\nconv 0 1 1 1 1 1 0 0 0 0 tanh\n", "'tanh' is not none, relu or relu6"},
           {"picture 2\nmean 0\nadd 0 1\n", "the summands have different sizes"},
           {"picture 2\nmax_pool 0 2 3\n", "its windows do not fill its input"},
           {"picture 2\nwiden 0 2\n", "'2' is not a number from 3"},
           {"picture 2\nresize 0 4096 4096\nresize 1 4096 4096\n", "the tensors are too large"},
           {"picture 4096\nconv 0 4096 64 64 64 64 0 0 0 0 none\nconv 1 4096 64 64 1 1 0 0 0 0 "
            "none\n",
            "line 4: there are too many weights"},
           {"picture 2\nweights 0\n", "there is no output before it"}})
    EXPECT_THAT(refused(head), HasSubstr(reason)) << head;
}

TEST_F(NetworkTest, OfOtherPicturesOrOutputsAreRefused) {
  EXPECT_THAT(refused("picture 4\nmean 0\noutput out 1\nweights 0\n"), HasSubstr("another size"));
  EXPECT_THAT(refused("picture 2\nmean 0\noutput in 1\nweights 0\n"), HasSubstr("no output out"));
  EXPECT_THAT(refused("picture 2\noutput out 0\nweights 0\n"),
              HasSubstr("its output out has another size"));
}

TEST_F(NetworkTest, FilesOfAnEarlierVersionAreNamed) {
  std::ofstream(folder_.path() / "a.onnx") << "network";
  EXPECT_THAT(test::message_of<DataError>([&] {
                Network(folder_.path() / "a.net", 2, {{"out", 3}});
              }),
              AllOf(HasSubstr("earlier version"), EndsWith("run `hypotrack get detector`")));
}

}  // namespace
}  // namespace hypotrack::hands
