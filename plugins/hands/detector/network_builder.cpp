#include "network_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace hypotrack::hands {
namespace {

constexpr int kMostSteps = 1000;
constexpr int kLargestSide = 4096;  // of a tensor, also its channels
constexpr int kLargestKernel = 64;
constexpr std::size_t kMostNumbers = 1 << 26;  // in all tensors

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

}  // namespace

std::optional<std::size_t> GraphBuilder::add_line(std::string_view line) {
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

std::size_t GraphBuilder::weights(Words& words) const {
  const int count = words.take_number(0, kLargestNetworkFile / sizeof(float));
  if (!words.empty()) throw Damage("it is too long");
  if (graph.outputs.empty()) throw Damage("there is no output before it");
  if (static_cast<std::size_t>(count) != taken_)
    throw Damage(fmt::format("the steps take {} weights, not {}", taken_, count));
  return taken_;
}

void GraphBuilder::add_picture(Words& words) {
  if (!graph.tensors.empty()) throw Damage("there is a picture before it");
  const int side = words.take_number(1, kLargestSide);
  add_tensor({side, side, 3});
}

void GraphBuilder::add_output(Words& words) {
  NetworkOutput out{.name = std::string(words.take()), .tensors = {take_tensor(words)}};
  while (!words.empty()) out.tensors.push_back(take_tensor(words));
  if (out.tensors.size() > kMostSteps) throw Damage("it has too many tensors");
  graph.outputs.push_back(std::move(out));
}

void GraphBuilder::add_step(Layer layer, Words& words) {
  if (graph.steps.size() == kMostSteps) throw Damage("there are too many steps");
  NetworkStep step{.layer = layer, .input = take_tensor(words)};
  const TensorShape shape = shape_after(step, words);
  add_tensor(shape);
  graph.steps.push_back(step);
}

TensorShape GraphBuilder::shape_after(NetworkStep& step, Words& words) {
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

void GraphBuilder::take_window(NetworkStep& step, Words& words, TensorShape& shape) {
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

int GraphBuilder::take_tensor(Words& words) const {
  if (graph.tensors.empty()) throw Damage("there is no picture before it");
  return words.take_number(0, static_cast<int>(graph.tensors.size()) - 1);
}

std::size_t GraphBuilder::take_weights(std::size_t count) {
  if (count > kLargestNetworkFile / sizeof(float) - taken_)
    throw Damage("there are too many weights");
  return std::exchange(taken_, taken_ + count);
}

void GraphBuilder::add_tensor(const TensorShape& shape) {
  if (shape.size() > kMostNumbers - numbers_) throw Damage("the tensors are too large");
  numbers_ += shape.size();
  graph.tensors.push_back(shape);
}

}  // namespace hypotrack::hands
