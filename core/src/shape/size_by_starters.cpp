#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack::internal {
namespace {

std::vector<Frame> spread_frames(Source& source, std::size_t most) {
  std::vector<Frame> all, out;
  while (auto frame = source.next())
    if (!frame->views.empty()) all.push_back(*std::move(frame));
  const std::size_t count = std::min(most, all.size());
  for (std::size_t i = 0; i < count; ++i) out.push_back(std::move(all[i * all.size() / count]));
  return out;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Returns the most probable value: that of a normal prior and of a normal measurement.
double most_probable(const ShapeParameter& scale, double measured) {
  constexpr double kDeviation = 0.03;  // of sizes that starters see, as a share
  const double prior = 1 / (scale.deviation * scale.deviation);
  const double seen = 1 / (kDeviation * kDeviation);
  return std::clamp((prior * scale.neutral + seen * measured) / (prior + seen), scale.lower,
                    scale.upper);
}

}  // namespace

ShapeEstimate size_by_starters(OpenedScene session, const ShapeEstimateSettings& settings) {
  constexpr int kLeast = 3;  // frames
  const Scene& scene = *session.scene;
  const ShapeTargets targets(scene, settings.models, settings.parameters);
  const auto& wanted = targets.wanted();
  const auto scale = std::ranges::find(wanted, "scale", &ShapeParameter::name);
  if (scale == wanted.end())
    throw ConfigError("shape.from: starters tell the scale alone, which shape.parameters lacks");
  const auto knows = [&](const auto& starter) {
    return std::ranges::any_of(targets.models(), [&](int model) {
      return starter->detects(static_cast<std::size_t>(model));
    });
  };
  if (std::ranges::none_of(session.parts.starters, knows))
    throw ConfigError(
        "shape.from: no starter detects the models; expected `init: {from: auto}` with a "
        "detector of such models (`hypotrack get detector`), or `shape.from: images`");
  const std::vector<Camera> cameras = session.source->cameras();
  std::vector<double> factors;
  ShapeEstimate out;
  for (const Frame& frame :
       spread_frames(*session.source, 2 * static_cast<std::size_t>(settings.frames))) {
    const StarterContext context{scene, cameras, &frame};
    bool seen = false;
    for (const int model : targets.models())
      for (const auto& starter : session.parts.starters)
        if (const auto factor = starter->size(context, static_cast<std::size_t>(model))) {
          factors.push_back(*factor);
          seen = true;
        }
    out.used_frames += seen ? 1 : 0;
  }
  Eigen::VectorXd values = targets.values();
  if (out.used_frames < kLeast)
    out.used_frames = 0;
  else
    values[scale - wanted.begin()] = most_probable(*scale, scale->value * median(factors));
  take_shape(targets, values, out);
  return out;
}

}  // namespace hypotrack::internal
