#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hypotrack::hands {

/// An output that a network is expected to have: its name and how many numbers it has.
struct ExpectedOutput {
  std::string name;
  std::size_t size;
};

/// A network of a file, run on the CPU. Several threads may run it at the same time.
/// All networks of the same file share its weights.
class Network {
 public:
  /// Writes a square picture: rows of pixels, red, green and blue from 0 to 1.
  using WritePicture = std::function<void(std::span<float>)>;

  /// Reads the file, unless another Network has it. Throws DataError, naming the file and
  /// `hypotrack get detector`, if it is missing, is damaged or does not take square pictures of
  /// `side` pixels to these outputs.
  Network(const std::filesystem::path& file, int side, const std::vector<ExpectedOutput>& outputs);

  /// Returns the outputs for a picture, the same for any number of threads. Throws DataError naming
  /// the file if the network cannot be computed.
  std::vector<std::vector<float>> run(const WritePicture& write, int threads = 1) const;

  int side() const { return side_; }

 private:
  class Context;
  struct Shared;
  static std::shared_ptr<Shared> shared(const std::filesystem::path& file);

  int side_;
  std::shared_ptr<Shared> shared_;
};

}  // namespace hypotrack::hands
