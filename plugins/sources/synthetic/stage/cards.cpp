#include "stage/cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "stage/surfaces.hpp"

namespace hypotrack::synthetic {
namespace {

/// Returns the picture of a card's front, 8-bit BGR; empty for one of a single colour.
cv::Mat cover_of(const CardParams& params, const ConfigNode& item) {
  if (params.pattern && !params.file.empty())
    throw ConfigError(item.where() + ": a card has a `pattern` or a `file`, not both");
  if (params.pattern) {
    cv::RNG random(static_cast<std::uint64_t>(*params.pattern) * 7919 + 31);
    return make_pattern(random, 256);
  }
  if (params.file.empty()) return {};
  cv::Mat image;
  if (std::filesystem::is_regular_file(params.file))
    image = read_image(params.file.string(), cv::IMREAD_COLOR);
  if (!image.empty()) return image;
  throw DataError(fmt::format("{}: {} is no readable image; a card needs a PNG or JPEG file",
                              item.get("file").where(), params.file.string()));
}

ModelData model_of(const CardParams& params, const ConfigNode& item) {
  const Eigen::Vector2d half = 0.5 * params.size;
  Mesh mesh = make_wall({-half, half}, 0, cover_of(params, item));
  mesh.color = (params.color / 255).cast<float>();
  return rigid_model(std::move(mesh));
}

}  // namespace

Card::Card(const CardParams& params, const ConfigNode& item, double frame_rate)
    : first_(static_cast<int>(params.frames[0])),
      last_(static_cast<int>(params.frames[1])),
      begin_(first_ / frame_rate),
      end_(last_ / frame_rate),
      from_(params.at),
      by_(params.by),
      data_(model_of(params, item)) {
  if (first_ == params.frames[0] && last_ == params.frames[1] && first_ <= last_) return;
  throw ConfigError(
      fmt::format("{}: frames are {:g} to {:g}; expected the numbers of the first "
                  "and the last frame",
                  item.get("frames").where(), params.frames[0], params.frames[1]));
}

bool Card::is_shown(int frame) const { return frame >= first_ && frame <= last_; }

Eigen::Vector3d Card::middle(double time) const {
  const double share = end_ > begin_ ? std::clamp((time - begin_) / (end_ - begin_), 0., 1.) : 0.;
  return from_ + share * by_;
}

std::vector<Card> make_cards(const std::vector<CardParams>& params, const ConfigNode& node,
                             double frame_rate) {
  std::vector<Card> cards;
  for (std::size_t i = 0; i < params.size(); ++i)
    cards.emplace_back(params[i], node.at(i), frame_rate);
  return cards;
}

}  // namespace hypotrack::synthetic
