#include "shape/estimated_session.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "shape/replay_source.hpp"

namespace hypotrack {

EstimatedSession open_estimated(const std::filesystem::path& scene_file,
                                std::span<const std::string> overrides, PluginLoader& plugins,
                                const ShapeProgress& progress) {
  EstimatedSession opened;
  opened.first = open_source(scene_file, overrides, plugins);
  Session& first = opened.first;
  std::vector<Frame> frames = first_seconds(*first.source, first.shape.seconds);
  const auto open = [&](const std::vector<std::string>& found, std::unique_ptr<Source> source) {
    std::vector<std::string> all(overrides.begin(), overrides.end());
    all.insert(all.end(), found.begin(), found.end());
    return open_session(scene_file, all, plugins, std::move(source), first.source_resolved);
  };
  opened.estimate = estimate_shape(
      [&](const std::vector<std::string>& found) {
        return open(found, std::make_unique<ReplaySource>(*first.source, frames));
      },
      first.shape, 0, false, progress);
  opened.session = open(opened.estimate.overrides,
                        std::make_unique<ReplaySource>(std::move(first.source), std::move(frames)));
  return opened;
}

}  // namespace hypotrack
