#include <fmt/format.h>

#include "hypotrack/api/pose.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

Eigen::VectorXd state_of_frame(const std::filesystem::path& file, const Scene& scene, int frame) {
  const std::vector<StateRow> rows = read_states(file, scene);
  for (const StateRow& row : rows)
    if (row.frame == frame) return row.state;
  if (rows.empty())
    throw DataError(fmt::format("{}: has no rows; expected one to start from", file.string()));
  throw DataError(fmt::format("{}: has no frame {} to start from; it has {} to {}", file.string(),
                              frame, rows.front().frame, rows.back().frame));
}

class File final : public Starter {
 public:
  struct Params {
    std::filesystem::path file;
    int frame = 0;
    void visit(ParamVisitor& v) {
      v("file", file,
        {.help = "a pose (YAML, written like init.pose) or a state table (CSV, a track.csv for "
                 "example)",
         .required = true});
      v("frame", frame, {.help = "which frame of the table", .min = 0});
    }
  };
  explicit File(const Params& params) : params_(params) {}

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    const Scene& scene = context.scene;
    const std::string suffix = params_.file.extension().string();
    const Eigen::VectorXd state =
        suffix == ".yaml" || suffix == ".yml"
            ? read_pose(ConfigNode::load(params_.file), scene, scene.rest_state(), context.cameras)
            : state_of_frame(params_.file, scene, params_.frame);
    scene.check(state, params_.file.string());
    return state;
  }

  Params params_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::File, "a pose in a YAML file, or a row of a state table", "")
