#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {

/// An item of `cards:`.
struct CardParams {
  Eigen::Vector2d frames{0, 0};
  Eigen::Vector3d at{0, 0, 0};
  Eigen::Vector3d by{0, 0, 0};
  Eigen::Vector2d size{0.15, 0.1};
  Eigen::Vector3d color{150, 150, 145};
  std::optional<int> pattern;
  std::filesystem::path file;
  void visit(ParamVisitor& v) {
    v("frames", frames,
      {.help = "first and last frame that show it", .min = 0, .max = 1e7, .required = true});
    v("at_mm", at,
      {.help = "its middle, world axes", .unit = "mm", .to_si = kMillimetre, .required = true});
    v("by_mm", by,
      {.help = "how far it moves evenly until the last frame", .unit = "mm", .to_si = kMillimetre});
    v("size_mm", size,
      {.help = "width and height", .min = 1, .max = 1e4, .unit = "mm", .to_si = kMillimetre});
    v("color", color, {.help = "red, green, blue", .min = 0, .max = 255});
    v("pattern", pattern, {.help = "instead of a colour: the seed of a pattern", .min = 0});
    v("file", file, {.help = "instead of a colour: a picture"});
  }
};

/// A flat card parallel to the first camera's picture, which hides what is behind it.
class Card {
 public:
  /// `item` is the node of `params`. Throws ConfigError on invalid frames and on several covers.
  Card(const CardParams& params, const ConfigNode& item, double frame_rate);

  const ModelData& data() const { return data_; }
  bool is_shown(int frame) const;
  /// Returns the card's middle at a time in seconds, in metres.
  Eigen::Vector3d middle(double time) const;

 private:
  int first_, last_;
  double begin_, end_;  ///< seconds
  Eigen::Vector3d from_, by_;
  ModelData data_;
};

/// Reads the items of `cards:`.
std::vector<Card> make_cards(const std::vector<CardParams>& params, const ConfigNode& node,
                             double frame_rate);

}  // namespace hypotrack::synthetic
