// An output without files, which adds columns to track.csv.
#include <cmath>

#include "hypotrack/plugin/plugin.hpp"

namespace {

class Telling : public hypotrack::Output {
 public:
  struct Params {
    std::string column = "depth_m";
    bool draws = false;
    void visit(hypotrack::ParamVisitor& v) {
      v("column", column, {.help = "name of the first column"});
      v("draws", draws, {.help = "takes the renderer"});
    }
  };
  Telling(const Params& params, hypotrack::PluginContext& context)
      : params_(params), log_(context.log()) {}

 private:
  std::vector<std::string> do_file_names() const override { return {}; }
  void do_begin(hypotrack::OutputContext& run) override {
    if (params_.draws) run.renderer();
  }
  std::vector<std::string> do_columns() const override { return {params_.column, "odd"}; }
  void do_values(const hypotrack::Frame& frame, const hypotrack::Solution& solution,
                 std::span<double> values) override {
    values[0] = solution.state[2];
    if (frame.index % 2 == 1) values[1] = frame.index;
  }
  void do_frame(const hypotrack::Frame& frame, const hypotrack::Solution&) override {
    if (frame.index == 3) log_.note("sees a frame");
  }
  void do_finish(bool) override { log_.note("ends"); }

  Params params_;
  hypotrack::PluginLog log_;
};

}  // namespace

HYPOTRACK_PLUGIN(Telling, "adds columns to track.csv", "")
