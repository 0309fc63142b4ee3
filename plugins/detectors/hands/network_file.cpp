#include "network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "hypotrack/error.hpp"

namespace hypotrack::hands {
namespace {

constexpr std::string_view kFirstLine = "hypotrack network 1";
constexpr std::uintmax_t kLargestFile = 1 << 28;
constexpr int kMostSteps = 1000;
constexpr int kLargestSide = 4096;  // of a tensor, also its channels
constexpr int kLargestKernel = 64;
constexpr std::size_t kMostNumbers = 1 << 26;  // in all tensors

/// What is wrong with a line.
struct Damage : std::runtime_error {
  using runtime_error::runtime_error;
};

/// Returns a word of the file for a message.
std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 20;
  const bool is_text = std::ranges::all_of(word, [](char c) { return c > ' ' && c <= '~'; });
  return is_text ? "'" + std::string(word.substr(0, kLongest)) + "'" : "a word";
}

/// The words of a line, taken one by one.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  bool empty() const { return rest_.empty(); }

  std::string_view take() {
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (word.empty()) throw Damage("a word is missing");
    return word;
  }

  int take_number(int low, int high) {
    const std::string_view word = take();
    int out = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
    if (error != std::errc() || end != word.data() + word.size() || out < low || out > high)
      throw Damage(fmt::format("{} is not a number from {} to {}", shown(word), low, high));
    return out;
  }

 private:
  std::string_view rest_;
};

std::optional<Layer> layer_of(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Layer>, 9> kLayers = {
      {{"conv", Layer::conv},
       {"depthwise", Layer::depthwise},
       {"prelu", Layer::prelu},
       {"add", Layer::add},
       {"max_pool", Layer::max_pool},
       {"widen", Layer::widen},
       {"resize", Layer::resize},
       {"mean", Layer::mean},
       {"sigmoid", Layer::sigmoid}}};
  const auto found = std::ranges::find(kLayers, word, &std::pair<std::string_view, Layer>::first);
  if (found == kLayers.end()) return std::nullopt;
  return found->second;
}

Activation activation_of(std::string_view word) {
  if (word == "none") return Activation::none;
  if (word == "relu") return Activation::relu;
  if (word == "relu6") return Activation::relu6;
  throw Damage(shown(word) + " is not none, relu or relu6");
}

/// Builds a graph from the lines of its head. Each function throws Damage.
class GraphBuilder {
 public:
  /// Adds a line; returns the number of weights once it names it, which ends the head.
  std::optional<std::size_t> add_line(std::string_view line) {
    Words words(line);
    const std::string_view word = words.take();
    if (word == "weights") return weights(words);
    if (word == "picture") {
      add_picture(words);
    } else if (word == "output") {
      add_output(words);
    } else if (const std::optional<Layer> layer = layer_of(word)) {
      add_step(*layer, words);
    } else {
      throw Damage(shown(word) + " is not a step");
    }
    if (!words.empty()) throw Damage("it is too long");
    return std::nullopt;
  }

  NetworkGraph graph;

 private:
  std::size_t weights(Words& words) const {
    const int count = words.take_number(0, kLargestFile / sizeof(float));
    if (!words.empty()) throw Damage("it is too long");
    if (graph.outputs.empty()) throw Damage("there is no output before it");
    if (static_cast<std::size_t>(count) != taken_)
      throw Damage(fmt::format("the steps take {} weights, not {}", taken_, count));
    return taken_;
  }

  void add_picture(Words& words) {
    if (!graph.tensors.empty()) throw Damage("there is a picture before it");
    const int side = words.take_number(1, kLargestSide);
    add_tensor({side, side, 3});
  }

  void add_output(Words& words) {
    NetworkOutput out{.name = std::string(words.take()), .tensors = {take_tensor(words)}};
    while (!words.empty()) out.tensors.push_back(take_tensor(words));
    if (out.tensors.size() > kMostSteps) throw Damage("it has too many tensors");
    graph.outputs.push_back(std::move(out));
  }

  void add_step(Layer layer, Words& words) {
    if (graph.steps.size() == kMostSteps) throw Damage("there are too many steps");
    NetworkStep step{.layer = layer, .input = take_tensor(words)};
    const TensorShape shape = shape_after(step, words);
    add_tensor(shape);
    graph.steps.push_back(step);
  }

  /// Completes a step by the rest of its line; returns the shape of its tensor.
  TensorShape shape_after(NetworkStep& step, Words& words) {
    TensorShape out = graph.tensors[static_cast<std::size_t>(step.input)];
    const TensorShape in = out;
    switch (step.layer) {
      case Layer::conv:
        out.channels = words.take_number(1, kLargestSide);
        take_window(step, words, out);
        step.weights =
            take_weights(TensorShape{step.kernel_height, step.kernel_width, in.channels}.size() *
                         static_cast<std::size_t>(out.channels));
        step.bias = take_weights(static_cast<std::size_t>(out.channels));
        break;
      case Layer::depthwise:
        take_window(step, words, out);
        step.weights =
            take_weights(TensorShape{step.kernel_height, step.kernel_width, in.channels}.size());
        step.bias = take_weights(static_cast<std::size_t>(out.channels));
        break;
      case Layer::prelu:
        step.weights = take_weights(static_cast<std::size_t>(in.channels));
        break;
      case Layer::add:
        step.second = take_tensor(words);
        if (graph.tensors[static_cast<std::size_t>(step.second)] != in)
          throw Damage("the summands have different sizes");
        break;
      case Layer::max_pool:
        step.kernel_height = step.stride_y = words.take_number(1, kLargestKernel);
        step.kernel_width = step.stride_x = words.take_number(1, kLargestKernel);
        if (in.height % step.stride_y != 0 || in.width % step.stride_x != 0)
          throw Damage("its windows do not fill its input");
        out.height /= step.stride_y;
        out.width /= step.stride_x;
        break;
      case Layer::widen:
        out.channels = words.take_number(in.channels, kLargestSide);
        break;
      case Layer::resize:
        out.height = words.take_number(1, kLargestSide);
        out.width = words.take_number(1, kLargestSide);
        break;
      case Layer::mean:
        out.height = out.width = 1;
        break;
      case Layer::sigmoid:
        break;
    }
    return out;
  }

  /// Takes the window of a convolution and sets the size of its output.
  static void take_window(NetworkStep& step, Words& words, TensorShape& shape) {
    for (int* side : {&step.kernel_height, &step.kernel_width, &step.stride_y, &step.stride_x})
      *side = words.take_number(1, kLargestKernel);
    for (int* pad : {&step.top, &step.bottom, &step.left, &step.right})
      *pad = words.take_number(0, kLargestKernel);
    step.activation = activation_of(words.take());
    const int rows = shape.height + step.top + step.bottom - step.kernel_height;
    const int columns = shape.width + step.left + step.right - step.kernel_width;
    if (rows < 0 || columns < 0) throw Damage("its window is larger than its input");
    shape.height = rows / step.stride_y + 1;
    shape.width = columns / step.stride_x + 1;
  }

  int take_tensor(Words& words) const {
    if (graph.tensors.empty()) throw Damage("there is no picture before it");
    return words.take_number(0, static_cast<int>(graph.tensors.size()) - 1);
  }

  std::size_t take_weights(std::size_t count) {
    if (count > kLargestFile / sizeof(float) - taken_) throw Damage("there are too many weights");
    return std::exchange(taken_, taken_ + count);
  }

  void add_tensor(const TensorShape& shape) {
    if (shape.size() > kMostNumbers - numbers_) throw Damage("the tensors are too large");
    numbers_ += shape.size();
    graph.tensors.push_back(shape);
  }

  std::size_t taken_ = 0;    // weights
  std::size_t numbers_ = 0;  // in all tensors
};

/// Returns the bytes of a file that is no larger than expected.
std::string read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    const bool is_old =
        std::filesystem::exists(std::filesystem::path(file).replace_extension("onnx"), error);
    throw DataError(fmt::format(
        "{}: the hand detector needs this file{}; run scripts/get_hand_detector.sh", file.string(),
        is_old ? ", and its folder has those of an earlier version" : ""));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestFile) fail_damaged(file, "it is too large");
  std::string out(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(out.data(), static_cast<std::streamsize>(size)))
    fail_damaged(file, "it cannot be read");
  return out;
}

/// Returns the weights in the bytes behind the head.
std::vector<float> weights_in(std::string_view bytes, std::size_t count) {
  if (bytes.size() != count * sizeof(float))
    throw Damage(
        fmt::format("{} bytes follow the head, expected {}", bytes.size(), count * sizeof(float)));
  std::vector<float> out(count);
  std::memcpy(out.data(), bytes.data(), bytes.size());
  if (!std::ranges::all_of(out, [](float x) { return std::isfinite(x); }))
    throw Damage("a weight is not finite");
  return out;
}

}  // namespace

std::size_t NetworkGraph::size(const NetworkOutput& output) const {
  std::size_t out = 0;
  for (const int tensor : output.tensors)
    out += tensors.at(static_cast<std::size_t>(tensor)).size();
  return out;
}

NetworkGraph read_network(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  std::string_view rest = bytes;
  GraphBuilder builder;
  for (int line = 1;; ++line) {
    const std::size_t end = rest.find('\n');
    try {
      if (line == 1 && rest.substr(0, end) != kFirstLine)
        throw Damage("it does not begin with '" + std::string(kFirstLine) + "'");
      if (end == std::string_view::npos) throw Damage("the file ends there");
      const std::string_view text = rest.substr(0, end);
      rest.remove_prefix(end + 1);
      if (line == 1) continue;
      if (const std::optional<std::size_t> count = builder.add_line(text)) {
        builder.graph.weights = weights_in(rest, *count);
        return std::move(builder.graph);
      }
    } catch (const Damage& damage) {
      fail_damaged(file, fmt::format("line {}: {}", line, damage.what()));
    }
  }
}

void fail_damaged(const std::filesystem::path& file, const std::string& reason) {
  throw DataError(fmt::format(
      "{}: the hand detector's network is damaged ({}); run scripts/get_hand_detector.sh",
      file.string(), reason));
}

}  // namespace hypotrack::hands
