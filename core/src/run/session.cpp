#include "hypotrack/api/session.hpp"

#include <optional>
#include <utility>

#include "cost/cuda/device.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "run/frame_cost_impl.hpp"
#include "run/run_scene.hpp"
#include "run/tracker_impl.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {

RunWatcher::~RunWatcher() = default;
void RunWatcher::say(const std::string& /*text*/) {}
void RunWatcher::begin(std::optional<int> /*frames*/) {}
void RunWatcher::frame(const Frame& /*frame*/, const Solution& /*solution*/, double /*error*/) {}

namespace {

/// The source of a scene with the scene that it is of.
class SourceOfScene final : public Source {
 public:
  explicit SourceOfScene(OpenedScene opened) : opened_(std::move(opened)) {}

 private:
  const std::vector<Camera>& do_cameras() const override { return opened_.source->cameras(); }
  double do_frame_rate() const override { return opened_.source->frame_rate(); }
  std::optional<int> do_frame_count() const override { return opened_.source->frame_count(); }
  std::optional<Frame> do_next() override { return opened_.source->next(); }
  bool do_live() const override { return opened_.source->live(); }
  std::vector<std::string> do_notes() const override { return opened_.source->notes(); }
  std::vector<std::string> do_statistics() const override { return opened_.source->statistics(); }

  OpenedScene opened_;
};

}  // namespace

struct Session::Impl {
  Impl(SceneInput input, SessionOptions session_options)
      : scene(std::move(input)), options(std::move(session_options)), plugins(options.plugin_path) {
    for (ProgramPlugin& plugin : options.plugins) plugins.add(std::move(plugin));
    for (auto& [name, mesh] : options.meshes) plugins.attach(name, std::move(mesh));
    models = open();
  }

  OpenedScene open() {
    const cuda::KeepDevice keep;
    return open_without_source(scene, options.set, plugins);
  }

  SceneInput scene;
  SessionOptions options;
  PluginLoader plugins;
  OpenedScene models;  ///< what was opened to check the file
};

Session::Session(const std::filesystem::path& scene, SessionOptions options)
    : impl_(std::make_unique<Impl>(scene, std::move(options))) {}
Session::Session(ConfigNode scene, SessionOptions options)
    : impl_(std::make_unique<Impl>(std::move(scene), std::move(options))) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

const Scene& Session::scene() const { return *impl_->models.scene; }

Tracker Session::tracker(std::vector<Camera> cameras) {
  const cuda::KeepDevice keep;
  // Parts belong to one tracker, so each gets its own.
  return Tracker(std::make_unique<Tracker::Impl>(impl_->open(), std::move(cameras)));
}

FrameCost Session::frame_cost(std::vector<Camera> cameras) {
  const cuda::KeepDevice keep;
  return FrameCost(std::make_unique<FrameCost::Impl>(impl_->open(), std::move(cameras)));
}

std::unique_ptr<Source> Session::source() {
  return std::make_unique<SourceOfScene>(
      open_source(impl_->scene, impl_->options.set, impl_->plugins));
}

bool Session::run(const RunOptions& options, RunWatcher& watcher) {
  const cuda::KeepDevice keep;
  return run_scene(impl_->scene, impl_->options.set, impl_->plugins, options, watcher).complete;
}

}  // namespace hypotrack
