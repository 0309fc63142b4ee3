#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hypotrack::hands {

/// What is wrong with a line.
struct Damage : std::runtime_error {
  using runtime_error::runtime_error;
};

/// Returns a word of the file for a message.
std::string shown(std::string_view word);

/// The words of a line, taken one by one.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  bool empty() const { return rest_.empty(); }
  /// Returns the next word. Throws Damage if there is none.
  std::string_view take();
  /// Returns the next word as a number. Throws Damage if it is none from `low` to `high`.
  int take_number(int low, int high);

 private:
  std::string_view rest_;
};

/// The size of a tensor, whose numbers are ordered [y, x, channel].
struct TensorShape {
  int height = 0, width = 0, channels = 0;
  std::size_t size() const {
    return static_cast<std::size_t>(height) * static_cast<std::size_t>(width) *
           static_cast<std::size_t>(channels);
  }
  bool operator==(const TensorShape&) const = default;
};

/// What a step of a network computes.
enum class Layer { conv, depthwise, prelu, add, max_pool, widen, resize, mean, sigmoid };

/// The function that follows a convolution.
enum class Activation { none, relu, relu6 };

/// One step of a network. It makes the tensor after that of the step before.
struct NetworkStep {
  Layer layer = Layer::conv;
  int input = 0;
  int second = -1;  ///< the other summand of Layer::add
  int kernel_height = 1, kernel_width = 1;
  int stride_y = 1, stride_x = 1;
  int top = 0, bottom = 0, left = 0, right = 0;  ///< rows and columns of zeros around the input
  Activation activation = Activation::none;
  /// Where the weights begin: of a convolution [out, y, x, in], of a depthwise one [y, x, channel],
  /// of Layer::prelu one slope per channel.
  std::size_t weights = 0;
  std::size_t bias = 0;  ///< where the bias of a convolution begins, one number per channel
};

/// An output of a network: tensors one after the other.
struct NetworkOutput {
  std::string name;
  std::vector<int> tensors;
};

/// A network as it is in its file. Tensor 0 is a square RGB picture with values from 0 to 1.
struct NetworkGraph {
  std::vector<TensorShape> tensors;
  std::vector<NetworkStep> steps;
  std::vector<NetworkOutput> outputs;
  std::vector<float> weights;

  /// Returns how many numbers an output has.
  std::size_t size(const NetworkOutput& output) const;
};

/// Reads a network that tools/hand_detector/convert.py wrote. Tensors are no larger than the limits
/// in the source, and steps and outputs name tensors of earlier steps only. Throws DataError,
/// naming the file, the line and `hypotrack get detector`, if it is missing or damaged.
NetworkGraph read_network(const std::filesystem::path& file);

/// Throws the DataError of a file that is damaged for a reason.
[[noreturn]] void fail_damaged(const std::filesystem::path& file, const std::string& reason);

}  // namespace hypotrack::hands
