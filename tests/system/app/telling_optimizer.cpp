// A search that evaluates its start and the previous answer, and tells which was better.
#include "hypotrack/plugin/plugin.hpp"

namespace {

class Telling : public hypotrack::Optimizer {
 public:
  struct Params {
    void visit(hypotrack::ParamVisitor&) {}
  };
  Telling(const Params&, hypotrack::PluginContext& context) : log_(context.log()) {}

  std::int64_t default_evaluations() const override { return 2; }
  hypotrack::OptimizerResult minimize(hypotrack::CostFunction& cost,
                                      const hypotrack::SearchRegion& region,
                                      const hypotrack::Budget&, std::uint64_t) override {
    Eigen::MatrixXd points = region.start;
    if (region.previous.size() > 0) {
      points.conservativeResize(Eigen::NoChange, 2);
      points.col(1) = region.previous.cwiseMax(region.lower).cwiseMin(region.upper);
      // Without a motion model the search starts at the previous answer.
      log_.note((points.col(1) - points.col(0)).norm() < 1e-9 ? "starts at the previous answer"
                                                              : "starts elsewhere");
      if (!(region.seconds_since_previous > 0)) log_.warning("no time has passed");
    }
    Eigen::VectorXd costs(points.cols());
    cost.evaluate(points, costs);
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    return {points.col(best), lowest, points.cols()};
  }

 private:
  hypotrack::PluginLog log_;
};

}  // namespace

HYPOTRACK_PLUGIN(Telling, "tells whether it starts at the previous answer", "")
