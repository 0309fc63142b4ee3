#include "shape/estimated_scene.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "shape/replay_source.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack::internal {
namespace {

/// Returns overrides that make a synthetic source keep rendering the models as the scene gives
/// them. It then still knows their landmarks, whatever shape is estimated. run.yaml has that shape
/// in its models but renders the same pictures again.
std::vector<std::string> show_models_as_given(const SceneFile& scene) {
  std::string path = "source";
  ConfigNode source = scene.source;
  while (source.is_map() && source.get("source").is_map()) {
    source = source.get("source");
    path += ".source";
  }
  const ConfigNode type = source.is_map() ? source.get("type") : ConfigNode();
  std::vector<std::string> overrides;
  if (!type.is_scalar() || type.scalar() != "synthetic" || !scene.models.is_list())
    return overrides;
  const ConfigNode given = source.get("render_models");
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    const ConfigNode model = scene.models.at(i);
    if (!model.is_map()) continue;
    const ConfigNode name = model.get(model.get("name").defined() ? "name" : "type");
    if (!name.is_scalar() || (given.is_map() && given.get(name.scalar()).defined())) continue;
    for (const std::string& key : model.keys())
      if (key != "name")
        overrides.push_back(fmt::format("{}.render_models.{}.{}=\"@models.{}.{}\"", path,
                                        name.scalar(), key, i, key));
  }
  return overrides;
}

}  // namespace

EstimatedScene open_estimated(const SceneInput& scene, std::span<const std::string> overrides,
                              PluginLoader& plugins, const ShapeProgress& progress) {
  EstimatedScene opened;
  std::vector<std::string> as_given(overrides.begin(), overrides.end());
  for (std::string& more : show_models_as_given(load_scene(scene, overrides).file))
    as_given.push_back(std::move(more));
  opened.first = open_source(scene, as_given, plugins);
  OpenedScene& first = opened.first;
  std::vector<Frame> frames = first_seconds(*first.source, first.shape.seconds);
  const auto open = [&](const std::vector<std::string>& found, std::unique_ptr<Source> source) {
    std::vector<std::string> all(overrides.begin(), overrides.end());
    all.insert(all.end(), found.begin(), found.end());
    return open_scene(scene, all, plugins, std::move(source), first.source_resolved);
  };
  if (first.shape.from == ShapeFrom::starters)
    opened.estimate = size_by_starters(
        open({}, std::make_unique<ReplaySource>(*first.source, frames)), first.shape);
  else
    opened.estimate = estimate_shape(
        [&](const std::vector<std::string>& found) {
          return open(found, std::make_unique<ReplaySource>(*first.source, frames));
        },
        first.shape, 0, false, progress);
  opened.scene = open(opened.estimate.overrides,
                      std::make_unique<ReplaySource>(std::move(first.source), std::move(frames)));
  return opened;
}

}  // namespace hypotrack::internal
