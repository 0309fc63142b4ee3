#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "network_file.hpp"

namespace hypotrack::hands {

inline constexpr std::uintmax_t kLargestNetworkFile = 1 << 28;  ///< bytes

/// Builds a graph from the lines of its head. Each function throws Damage.
class GraphBuilder {
 public:
  /// Adds a line; returns the number of weights once it names it, which ends the head.
  std::optional<std::size_t> add_line(std::string_view line);

  NetworkGraph graph;

 private:
  std::size_t weights(Words& words) const;
  void add_picture(Words& words);
  void add_output(Words& words);
  void add_step(Layer layer, Words& words);
  /// Completes a step by the rest of its line; returns the shape of its tensor.
  TensorShape shape_after(NetworkStep& step, Words& words);
  /// Takes the window of a convolution and sets the size of its output.
  static void take_window(NetworkStep& step, Words& words, TensorShape& shape);
  int take_tensor(Words& words) const;
  std::size_t take_weights(std::size_t count);
  void add_tensor(const TensorShape& shape);

  std::size_t taken_ = 0;    // weights
  std::size_t numbers_ = 0;  // in all tensors
};

}  // namespace hypotrack::hands
