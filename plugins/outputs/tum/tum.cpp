#include <fmt/format.h>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

/// Returns a line in the format of the TUM RGB-D benchmark (Sturm et al., IROS 2012). The state
/// holds the quaternion as w x y z, the format has w last.
std::string pose_line(const std::string& time, std::span<const double> pose) {
  return fmt::format("{} {} {} {} {} {} {} {}\n", time, pose[0], pose[1], pose[2], pose[4], pose[5],
                     pose[6], pose[3]);
}

class Tum final : public Output {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  Tum(const Params&, const PluginContext& context) {
    for (const Scene::Item& item : context.scene().items())
      names_.push_back(model_file_name(item.name, "tum"));
  }

 private:
  std::vector<std::string> do_file_names() const override { return names_; }
  void do_begin(OutputContext& run) override {
    scene_ = &run.scene();
    for (std::size_t m = 0; m < names_.size(); ++m) {
      files_.emplace_back(run.file(names_[m]));
      files_.back().write(
          fmt::format("# world_from_model of {}: time tx ty tz qx qy qz qw (seconds, metres)\n",
                      scene_->items()[m].name));
    }
  }
  void do_frame(const Frame& frame, const Solution& solution) override {
    const std::string time =
        frame.stamp ? stamp_text(*frame.stamp) : fmt::format("{}", solution.time);
    for (std::size_t m = 0; m < files_.size(); ++m)
      if (pose_known(solution.models[m]))
        files_[m].write(pose_line(time, scene_->part(scene_->items()[m], solution.state)));
  }

  std::vector<std::string> names_;  ///< of a file per model
  std::vector<TextFile> files_;
  const Scene* scene_ = nullptr;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Tum,
                 "poses of the models as trajectories of the TUM RGB-D benchmark: <model>.tum", "")
