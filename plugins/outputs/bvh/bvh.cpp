#include <cmath>
#include <cstdint>

#include "bvh_file.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"

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

 private:
  std::vector<std::string> do_file_names() const override { return names_; }
  void do_begin(OutputContext& run) override {
    scene_ = &run.scene();
    frame_rate_ = run.frame_rate();
    for (std::size_t m = 0; m < names_.size(); ++m)
      files_.emplace_back(run.file(names_[m]), bvh::joints_of(scene_->items()[m]), frame_rate_);
  }
  void do_frame(const Frame& /*frame*/, const Solution& solution) override;

  void write_line();

  std::vector<std::string> names_;  ///< of a file per model
  std::vector<bvh::BvhFile> files_;
  const Scene* scene_ = nullptr;
  double frame_rate_ = 0;
  double first_time_ = 0;
  std::int64_t lines_ = 0;
  Eigen::VectorXd shown_;  ///< each model in the pose in which it was last seen
};

/// Writes a frame to the line of its time, because lines have no time of their own. Lines without a
/// frame, and models that are not seen, keep the last pose. Of two frames on a line, the first
/// stays. A longer gap than a minute becomes a minute.
void Bvh::do_frame(const Frame& /*frame*/, const Solution& solution) {
  if (lines_ == 0) {
    shown_ = solution.state;
    first_time_ = solution.time;
  }
  constexpr double kLongestGap = 60;  // seconds
  const double written = static_cast<double>(lines_) / frame_rate_;
  const double gap = solution.time - first_time_ - written;
  if (gap > kLongestGap) first_time_ += gap - kLongestGap;
  const std::int64_t line = std::llround((solution.time - first_time_) * frame_rate_);
  while (lines_ < line) write_line();
  for (std::size_t m = 0; m < files_.size(); ++m) {
    const Scene::Item& item = scene_->items()[m];
    const int size = item.model->dimension();
    if (pose_known(solution.models[m]))
      shown_.segment(item.offset, size) = solution.state.segment(item.offset, size);
  }
  if (lines_ == line) write_line();
}

void Bvh::write_line() {
  for (std::size_t m = 0; m < files_.size(); ++m) {
    const Scene::Item& item = scene_->items()[m];
    files_[m].add(bvh::pose_of(files_[m].joints(), *item.model, scene_->part(item, shown_)));
  }
  ++lines_;
}

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Bvh, "skeletons and their motion as Biovision hierarchies: <model>.bvh",
                 "")
