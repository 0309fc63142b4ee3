#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

namespace hypotrack::hands {

/// An output of a network: its name and how many numbers it has.
struct NetworkOutput {
  std::string name;
  std::size_t size;
};

/// A network in an ONNX file, run on the CPU. Use it from one thread at a time.
class Network {
 public:
  /// Reads the file. Throws DataError, naming the file and scripts/get_hand_detector.sh, if it is
  /// missing, is damaged or does not take square pictures of `side` pixels to these outputs.
  /// OpenCV notices damage of the structure, not of weights, for which the script has checksums.
  Network(const std::filesystem::path& file, int side, std::vector<NetworkOutput> outputs);

  /// Returns the outputs for a square 8-bit BGR picture of the network's size. Throws DataError
  /// naming the file if the network cannot be computed.
  std::vector<std::vector<float>> run(const cv::Mat& picture);

  int side() const { return side_; }

 private:
  void check_shapes();

  std::filesystem::path file_;
  int side_;
  std::vector<NetworkOutput> outputs_;
  cv::dnn::Net net_;
};

}  // namespace hypotrack::hands
