#include <fmt/format.h>

#include "glb_file.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "model_node.hpp"

namespace hypotrack {
namespace {

class Gltf final : public Output {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  Gltf(const Params&, const PluginContext& context) {
    for (const Scene::Item& item : context.scene().items())
      if (item.model->poses_itself())
        throw ConfigError(fmt::format(
            "{}: the model '{}' has no skeleton that moves its surface, and gltf writes skeletons; "
            "leave gltf out of this scene",
            context.config().where(), item.name));
  }

 private:
  std::vector<std::string> do_file_names() const override { return {"track.glb"}; }
  void do_begin(OutputContext& run) override;
  void do_frame(const Frame& frame, const Solution& solution) override;
  void do_finish(bool complete) override;

  std::filesystem::path path_;
  gltf::GlbFile file_;
  std::vector<gltf::ModelNode> models_;
  const Scene* scene_ = nullptr;
  Eigen::VectorXd shown_;  ///< each model in the pose in which it was last seen
  std::vector<float> times_;
};

/// Adds the models below a node that turns the world's axes (y down, z forward) to glTF's.
void Gltf::do_begin(OutputContext& run) {
  path_ = run.file("track.glb");
  scene_ = &run.scene();
  const std::size_t world =
      file_.add("nodes", {{"name", "world.axes"}, {"rotation", {1, 0, 0, 0}}});
  file_.json()["scene"] = file_.add("scenes", {{"nodes", {world}}});
  for (const Scene::Item& item : scene_->items()) {
    models_.emplace_back(file_, item);
    file_.at("nodes", world)["children"].push_back(models_.back().root());
  }
}

void Gltf::do_frame(const Frame& /*frame*/, const Solution& solution) {
  if (shown_.size() == 0) shown_ = solution.state;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const Scene::Item& item = scene_->items()[m];
    const int size = item.model->dimension();
    if (pose_known(solution.models[m]))
      shown_.segment(item.offset, size) = solution.state.segment(item.offset, size);
    models_[m].add(scene_->part(item, shown_));
  }
  times_.push_back(static_cast<float>(solution.time));
}

void Gltf::do_finish(bool /*complete*/) {
  if (!times_.empty()) {
    const auto times =
        Eigen::RowVectorXf::Map(times_.data(), static_cast<Eigen::Index>(times_.size()));
    const std::size_t seconds = file_.add_floats(times, gltf::Use::other, true);
    gltf::Json animation = {{"name", "track"}};
    for (const gltf::ModelNode& model : models_) model.animate(file_, animation, seconds);
    file_.add("animations", std::move(animation));
  }
  file_.write(path_);
}

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Gltf,
                 "the models with their skins and motion as binary glTF: track.glb", "")
