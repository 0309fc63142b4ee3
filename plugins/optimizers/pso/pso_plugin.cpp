#include <memory>

#include "hypotrack/plugin/plugin.hpp"
#include "pso.hpp"
#include "pso_cuda.hpp"

namespace {

/// The swarm where its costs are: in GPU memory for a scene evaluated there.
class PsoPlugin final : public hypotrack::Pso {
 public:
  using Params = hypotrack::PsoParams;
  PsoPlugin(const Params& params, hypotrack::PluginContext& context)
      : Pso(params, context.config().where()), params_(params), where_(context.config().where()) {}

  hypotrack::OptimizerResult minimize(hypotrack::CostFunction& cost,
                                      const hypotrack::SearchRegion& region,
                                      const hypotrack::Budget& budget,
                                      std::uint64_t seed) override {
    // Whoever watches a search sees the batches of a swarm on the host: the same search, up to
    // rounding.
    if (cost.is_watched() || !cost.device()) return Pso::minimize(cost, region, budget, seed);
    if (!on_gpu_) on_gpu_ = std::make_unique<hypotrack::PsoCuda>(params_, where_);
    return on_gpu_->minimize(cost, region, budget, seed);
  }

 private:
  Params params_;
  std::string where_;
  std::unique_ptr<hypotrack::PsoCuda> on_gpu_;
};

}  // namespace

HYPOTRACK_PLUGIN(PsoPlugin,
                 "particle swarm with constriction (Clerc and Kennedy 2002), the paper's optimizer",
                 "batches seeded")
