#include "layers.hpp"

#include "hypotrack/api/error.hpp"

namespace hypotrack {

void check_patterns(const ImageSequenceParams& params, const std::string& where) {
  const bool second = !params.right.empty() || !params.right_depth.empty();
  if (params.left.empty() && params.left_depth.empty()) {
    throw ConfigError(where +
                      ": neither left nor left_depth is given; expected the images of the "
                      "first camera in `left` (colour), `left_depth` or both");
  }
  if (params.layout && (second || !params.right_mask.empty()))
    throw ConfigError(where +
                      ": layout is given together with images of the second camera; expected "
                      "images of both views in `left`, `left_mask` and `left_depth`");
  if (second && params.left_mask.empty() != params.right_mask.empty()) {
    throw ConfigError(where +
                      ": only one of left_mask and right_mask is given; expected both or none");
  }
  if (!second && !params.right_mask.empty()) {
    throw ConfigError(where +
                      ": right_mask is given without images of the second camera; expected "
                      "`right` or `right_depth`, too");
  }
}

std::vector<Layer> layers_of(const ImageSequenceParams& params) {
  std::vector<Layer> layers;
  const auto add = [&](std::size_t view, Content content, const std::filesystem::path& pattern) {
    if (!pattern.empty()) layers.push_back({view, content, pattern});
  };
  add(0, Content::color, params.left);
  add(1, Content::color, params.right);
  add(0, Content::mask, params.left_mask);
  add(1, Content::mask, params.right_mask);
  add(0, Content::depth, params.left_depth);
  add(1, Content::depth, params.right_depth);
  return layers;
}

}  // namespace hypotrack
