// A plugin that makes another one from a nested map.
#include "sample_optimizer.hpp"

namespace {

struct Params {
  hypotrack::ConfigNode inner;
  double factor = 2;

  void visit(hypotrack::ParamVisitor& v) {
    v("inner", inner, {.help = "the optimizer to wrap", .required = true});
    v("factor", factor, {.help = "times as many evaluations"});
  }
};

class Wrapper : public hypotrack::test::OptimizerOfSize {
 public:
  using Params = ::Params;
  Wrapper(const Params& params, hypotrack::PluginContext& context)
      : OptimizerOfSize(static_cast<std::int64_t>(
            params.factor *
            static_cast<double>(
                context.make<hypotrack::Optimizer>(params.inner)->default_evaluations()))) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Wrapper, "wraps another optimizer", "")
