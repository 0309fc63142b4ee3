#include "hypotrack/plugin/plugin.hpp"
#include "pipeline.hpp"

namespace {

using hypotrack::ParamVisitor;

struct StageParams {
  hypotrack::ConfigNode optimizer;
  double share = 1;
  double spread = 1;
  bool fallback = false;
  hypotrack::Moves moves = hypotrack::Moves::all;
  hypotrack::StageStart from = hypotrack::StageStart::best;
  void visit(ParamVisitor& v) {
    v("optimizer", optimizer,
      {.help = "the stage's optimizer: {type: ..., its parameters}", .required = true});
    v("share", share,
      {.help = "of the budget, in proportion to the shares of the other stages",
       .min = 1e-6,
       .max = 1e6});
    v("spread", spread,
      {.help = "factor of the search region's spread in this stage; below 1 it looks closer to the "
               "best so far",
       .min = 1e-3,
       .max = 1e3});
    v("fallback", fallback,
      {.help = "skip this stage if the cost is already within the range of recent frames; later "
               "stages get its budget"});
    v("moves", moves,
      {.help = "move all, only the poses of models, or only their limbs; the rest stays as earlier "
               "stages left it"});
    v("from", from,
      {.help = "begin at the best so far, or at the start of the whole search, if earlier stages "
               "may have gone the wrong way; the better answer stays"});
  }
};

struct PipelineParams {
  std::vector<StageParams> stages;
  int evaluations = 1024;
  void visit(ParamVisitor& v) {
    v("stages", stages,
      {.help = "optimizers that take turns, each from the best point of those before it",
       .required = true});
    v("evaluations", evaluations,
      {.help = "evaluations of all stages where the scene names no budget",
       .min = 1,
       .max = 1 << 30});
  }
};

std::vector<hypotrack::PipelineStage> make_stages(const PipelineParams& params,
                                                  hypotrack::PluginContext& context) {
  std::vector<hypotrack::PipelineStage> stages;
  for (const StageParams& stage : params.stages) {
    auto optimizer = context.make<hypotrack::Optimizer>(stage.optimizer);
    stages.push_back({stage.optimizer.get("type").scalar(), std::move(optimizer), stage.share,
                      stage.spread, stage.fallback, stage.moves, stage.from});
  }
  return stages;
}

class PipelinePlugin final : public hypotrack::Pipeline {
 public:
  using Params = PipelineParams;
  PipelinePlugin(const Params& params, hypotrack::PluginContext& context)
      : Pipeline(make_stages(params, context), params.evaluations, context.config().where()) {}
};

}  // namespace

HYPOTRACK_PLUGIN(PipelinePlugin,
                 "optimizers that take turns, each from the best point of those before it",
                 "batches seeded")
