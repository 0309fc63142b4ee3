#include "lab/judge/pose_sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "hypotrack/api/config.hpp"

namespace hypotrack::internal {
namespace {

/// Draws how the pictures of a rendered sequence are lit and taken.
std::vector<std::string> drawn_pictures(const ConfigNode& source, int number) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number) + 1);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const ConfigNode cameras = source.get("cameras").get("count");
  const bool pair = !(cameras.is_scalar() && cameras.scalar() == "1");
  const auto one_of = [&](std::initializer_list<double> values) {
    return values.begin()[random() % values.size()];
  };
  std::vector<std::string> out;
  if (source.get("random").is_map())
    out.push_back(fmt::format("source.random.seed={}", number + 1));
  out.push_back(fmt::format("source.background.seed={}", number + 1));
  out.push_back(fmt::format(
      "source.light={{ambient: {:.3f}, diffuse: {:.3f}, specular: {}, direction: [{:.3f}, {:.3f}, "
      "0.8]}}",
      draw(0.4, 0.9), draw(0, 0.6), one_of({0, 0.05, 0.12}), draw(-1, 1), draw(0, 1)));
  out.push_back(
      fmt::format("source.sensor={{noise_sigma: {}, blur_px: {}, gain: [{}{:.3f}], seed: {}}}",
                  one_of({1, 2, 3, 4}), one_of({0, 0, 0.8, 1.5}), pair ? "1, " : "",
                  draw(0.88, 1.12), number + 1));
  return out;
}

}  // namespace

std::vector<PoseSequence> plan_pose_sequences(std::span<const std::filesystem::path> scenes,
                                              const std::vector<std::string>& overrides, int count,
                                              int frames) {
  std::vector<PoseSequence> out;
  for (int number = 0; number < count; ++number) {
    const std::filesystem::path& scene = scenes[static_cast<std::size_t>(number) % scenes.size()];
    PoseSequence one{scene, {}, frames, number};
    const ConfigNode source = ConfigNode::load_scene(scene, overrides).get("source");
    const ConfigNode type = source.get("type");
    const bool rendered = type.is_scalar() && type.scalar() == "synthetic";
    if (!rendered && number >= std::ssize(scenes)) continue;  // a recording would repeat itself
    if (rendered) one.overrides = drawn_pictures(source, number);
    one.overrides.insert(one.overrides.end(), overrides.begin(), overrides.end());
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<std::string> model_types(std::span<const std::filesystem::path> scenes,
                                     const std::vector<std::string>& overrides) {
  std::vector<std::string> out;
  for (const std::filesystem::path& scene : scenes) {
    const ConfigNode models = ConfigNode::load_scene(scene, overrides).get("models");
    for (std::size_t i = 0; i < models.size(); ++i) {
      const ConfigNode type = models.at(i).get("type");
      if (type.is_scalar() && std::ranges::find(out, type.scalar()) == out.end())
        out.push_back(type.scalar());
    }
  }
  return out;
}

}  // namespace hypotrack::internal
