#include "bvh_file.hpp"
#include "hypotrack/model_files.hpp"
#include "hypotrack/plugin.hpp"

namespace hypotrack {
namespace {

class Bvh final : public Output {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  Bvh(const Params&, const PluginContext& context) {
    for (const Scene::Item& item : context.scene().items())
      names_.push_back(model_file_name(item.name, "bvh"));
  }

  std::vector<std::string> file_names() const override { return names_; }
  void begin(OutputContext& run) override {
    scene_ = &run.scene();
    for (std::size_t m = 0; m < names_.size(); ++m)
      files_.emplace_back(run.file(names_[m]), bvh::joints_of(scene_->items()[m]),
                          run.frame_rate());
  }
  /// Adds a line for every frame, because frames have no time of their own in the file. Models that
  /// are not seen keep their last pose.
  void frame(const Frame& /*frame*/, const Solution& solution) override {
    if (shown_.size() == 0) shown_ = solution.state;
    for (std::size_t m = 0; m < files_.size(); ++m) {
      const Scene::Item& item = scene_->items()[m];
      const int size = item.model->dimension();
      if (pose_known(solution.models[m]))
        shown_.segment(item.offset, size) = solution.state.segment(item.offset, size);
      files_[m].add(bvh::pose_of(files_[m].joints(), *item.model, scene_->part(item, shown_)));
    }
  }

 private:
  std::vector<std::string> names_;  ///< of a file per model
  std::vector<bvh::BvhFile> files_;
  const Scene* scene_ = nullptr;
  Eigen::VectorXd shown_;  ///< each model in the pose in which it was last seen
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Bvh, "skeletons and their motion as Biovision hierarchies: <model>.bvh",
                 "")
